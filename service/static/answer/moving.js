// Cards that change places glide there, so that the eye can follow which went where.

const GLIDE = { duration: 260, easing: "cubic-bezier(.2, .7, .2, 1)" };
const calm = matchMedia("(prefers-reduced-motion: reduce)");

/**
 * Change a list; let its items glide from their old places to their new ones.
 *
 * @param {() => HTMLElement | null} list - finds the list, before and after
 * @param {() => void} change - draws anew; items that stay keep their elements
 */
export function moving(list, change) {
  const before = calm.matches ? new Map() : placesOf(list()); // as seen, also in the middle of a move
  for (const item of before.keys()) item.getAnimations().forEach((running) => running.cancel());
  change();
  if (before.size === 0) return;
  for (const [item, place] of placesOf(list())) glide(item, before.get(item), place);
}

const placesOf = (list) => new Map(Array.from(list?.children ?? [], (item) => [item, item.getBoundingClientRect()]));

function glide(item, from, to) {
  if (Math.min(from?.top ?? to.top, to.top) > innerHeight) return; // nobody sees it
  if (!from) item.animate({ opacity: [0, 1] }, GLIDE);
  else if (from.left !== to.left || from.top !== to.top)
    item.animate({ transform: [`translate(${from.left - to.left}px, ${from.top - to.top}px)`, "none"] }, GLIDE);
}
