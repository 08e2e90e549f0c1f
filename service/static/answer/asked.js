// How to compare, as the address says it: a method by its name, or a place on the dial.

export const MIDDLE = 50; // of the dial, 0 (geometry) … 100 (colour): the default method

/**
 * Read what an address asks for; what is no number counts as the middle.
 *
 * @param {URLSearchParams} query
 * @returns {{method: string, colour: number}} `method` is empty where the dial decides
 */
export function askedOf(query) {
  const colour = Number.parseFloat(query.get("colour") ?? MIDDLE);
  return { method: query.get("method") ?? "", colour: Number.isNaN(colour) ? MIDDLE : Math.min(Math.max(colour, 0), 100) };
}

/** Write it into an address; the default is not mentioned. */
export function inAddress({ method, colour }) {
  if (method) return `?${new URLSearchParams({ method })}`;
  return colour === MIDDLE ? "" : `?${new URLSearchParams({ colour })}`;
}

export const isDefault = ({ method, colour }) => !method && colour === MIDDLE;
