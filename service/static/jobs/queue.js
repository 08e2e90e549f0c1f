// The queue's numbers, asked for every other second while somebody looks.

import { Problem, path, read } from "../shared/api.js";

const EVERY = 2000; // milliseconds

/**
 * Tell of the queue until the signal.
 *
 * @param {(heard: {queue?: object, problem?: Problem}) => void} told
 * @param {AbortSignal} signal
 */
export function watchQueue(told, signal) {
  let asking = false;
  const ask = async () => {
    if (asking || document.hidden) return;
    asking = true;
    told(await answered(signal));
    asking = false;
  };
  const timer = setInterval(ask, EVERY);
  document.addEventListener("visibilitychange", ask, { signal });
  signal.addEventListener("abort", () => clearInterval(timer));
}

export const readQueue = (signal) => read(path(["queue"]), { signal });

async function answered(signal) {
  try {
    return { queue: await readQueue(signal) };
  } catch (error) {
    if (error instanceof Problem || error.name === "AbortError") return { problem: error };
    throw error;
  }
}
