// Trying again what failed, one after another.

import { path, read, request } from "../shared/api.js";

const PAGE = 100;

/** Try one again; return it as it is then. */
export async function retry(id, signal) {
  return (await request(path(["shapes", id, "retry"]), { method: "POST", signal })).json();
}

/**
 * Try all again that failed until now, the newest first. Pages are in the order in which shapes were added, so that what
 * fails anew is not met twice.
 *
 * @param {(shape: object) => void} told - hears of each as it is queued
 */
export async function retryAll(told, signal) {
  let cursor;
  do {
    const page = await read(path(["shapes"], { status: "failed", limit: PAGE, cursor }), { signal });
    for (const { id } of page.items) await retried(id, told, signal);
    cursor = page.next_cursor;
  } while (cursor);
}

async function retried(id, told, signal) {
  try {
    told(await retry(id, signal));
  } catch (error) {
    if (!["not_failed", "not_found"].includes(error.code)) throw error; // somebody else saw to it
  }
}
