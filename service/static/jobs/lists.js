// The lists of shapes by state, kept in step with what is heard. Newest first, as the service lists them.

export const STATUSES = ["processing", "failed", "queued"]; // as they are shown: what failed needs somebody

/**
 * Put a shape into the list that it belongs to now, and out of the others.
 *
 * @param {Record<string, {items: object[], cursor: string?}>} lists - by status, as far as they were read: `cursor` is
 *   null at the end
 * @param {object} shape - as it is now
 */
export function moved(lists, shape) {
  const without = gone(lists, shape.id);
  const list = without[shape.status];
  return list ? { ...without, [shape.status]: { ...list, items: placed(list, shape) } } : without;
}

/** Take a shape out of all lists. */
export function gone(lists, id) {
  return Object.fromEntries(Object.entries(lists).map(([status, list]) =>
    [status, list.items.some((shape) => shape.id === id) ? { ...list, items: list.items.filter((shape) => shape.id !== id) } : list]));
}

/** Where a list was not read to its end, older shapes than its last come with the next page. */
function placed({ items, cursor }, shape) {
  const place = items.findIndex((other) => other.created_at < shape.created_at);
  if (place >= 0) return items.toSpliced(place, 0, shape);
  return cursor === null ? [...items, shape] : items;
}

/** Which lists cannot be right, by the numbers of the queue: something was not heard. */
export function doubtful(lists, queue) {
  return STATUSES.filter((status) => {
    const { items, cursor } = lists[status];
    return cursor === null ? items.length !== queue[status] : items.length > queue[status];
  });
}
