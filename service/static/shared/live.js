// Shapes that change state, as they do: one stream for the whole page, whoever listens.

import { EventSource } from "../vendor/eventsource.js";
import { headers } from "./api.js";

const listeners = new Set();
let stream;

/**
 * Hear of every shape that changes, until the signal.
 *
 * @param {(change: {shape?: object, removed?: string}) => void} listener
 * @param {AbortSignal} signal
 */
export function listen(listener, signal) {
  listeners.add(listener);
  stream ??= open();
  signal?.addEventListener("abort", () => listeners.delete(listener));
}

function open() {
  // the browser's own EventSource cannot send a key
  const made = new EventSource("/v1/events", {
    fetch: (address, init) => fetch(address, { ...init, headers: { ...init.headers, ...headers() } }),
  });
  made.addEventListener("shape", (event) => tell({ shape: JSON.parse(event.data) }));
  made.addEventListener("removed", (event) => tell({ removed: JSON.parse(event.data).id }));
  return made;
}

function tell(change) {
  for (const listener of [...listeners]) listener(change);
}
