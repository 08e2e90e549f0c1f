// The last shelf that was looked at: who comes back from a shape finds it as it was, and up to date.

import { rememberLibrary } from "../shared/place.js";
import { Shelf } from "./shelf.js";

let kept;
let leaving;

/** Return the shelf with these filters, the kept one where it is that. */
export function shelfWith(filters) {
  const made = new Shelf(filters);
  return kept?.address === made.address ? kept : made;
}

/** Keep a shelf in place of the one before; from now on it hears what changes. */
export async function keep(shelf) {
  rememberLibrary(shelf.address);
  if (kept === shelf) return;
  leaving?.abort();
  leaving = new AbortController();
  kept = shelf;
  const { signal } = leaving;
  const { listen } = await import("../shared/live.js"); // not needed for the first view
  const onOpen = () => shelf.catchUp().catch(() => {}); // the stream opens again, and so does this
  if (!signal.aborted) listen((change) => shelf.hear(change), signal, { onOpen });
}
