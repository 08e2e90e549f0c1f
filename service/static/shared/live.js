// Shapes that change state, as they do: one stream for the whole page, whoever listens.

import { EventSource } from "../vendor/eventsource.js";
import { headers } from "./api.js";

const AGAIN = 5000; // milliseconds, after a service that was there refused the stream
const listeners = new Set();
const openings = new Set();
let stream;

/**
 * Hear of every shape that changes, until the signal.
 *
 * @param {(change: {shape?: object, removed?: string}) => void} listener
 * @param {AbortSignal} [signal]
 * @param {{onOpen?: () => void}} [more] - `onOpen` hears that the stream has begun, also anew: what changed before is
 *   not told
 */
export function listen(listener, signal, { onOpen } = {}) {
  listeners.add(listener);
  if (onOpen) openings.add(onOpen);
  stream ??= open();
  signal?.addEventListener("abort", () => {
    listeners.delete(listener);
    openings.delete(onOpen);
  });
}

function open() {
  // the browser's own EventSource cannot send a key
  const made = new EventSource("/v1/events", {
    fetch: (address, init) => fetch(address, { ...init, headers: { ...init.headers, ...headers() } }),
  });
  made.addEventListener("shape", (event) => tell({ shape: JSON.parse(event.data) }));
  made.addEventListener("open", () => [...openings].forEach((opening) => opening()));
  made.addEventListener("error", ({ code }) => made.readyState === EventSource.CLOSED && closed(code));
  made.addEventListener("removed", (event) => tell({ removed: JSON.parse(event.data).id }));
  return made;
}

/** It comes back by itself after a broken connection, but not after a refusal. */
function closed(status) {
  stream = undefined; // whoever listens next opens it, perhaps with a key
  if (status >= 500) setTimeout(() => (stream ??= open()), AGAIN);
}

function tell(change) {
  for (const listener of [...listeners]) listener(change);
}
