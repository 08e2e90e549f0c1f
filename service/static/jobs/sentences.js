// The queue in words.

import { count, many } from "../shared/words.js";

/** A span of time as people guess it: "about 3 minutes". */
export function about(seconds) {
  if (seconds < 45) return "less than a minute";
  if (seconds < 5400) return `about ${many(Math.max(1, Math.round(seconds / 60)), "minute")}`;
  return seconds < 172800 ? `about ${many(Math.round(seconds / 3600), "hour")}` : `about ${many(Math.round(seconds / 86400), "day")}`;
}

/** What there is to do, and until when: "2 running, 118 waiting; about 3 minutes left." */
export function workOf(queue) {
  if (!queue.queued && !queue.processing) return "Nothing is waiting.";
  const left = queue.expected_seconds === null ? "how long it takes is not known yet" : `${about(queue.expected_seconds)} left`;
  return `${count(queue.processing)} running, ${count(queue.queued)} waiting; ${left}.`;
}

/** How far a new version is with all shapes, where one is: "12 of 40 shapes are described anew …" */
export function renewalOf({ renewal }) {
  if (!renewal) return null;
  const lost = renewal.failed ? ` ${many(renewal.failed, "shape")} could not be, and will be listed as failed.` : "";
  return `${count(renewal.done)} of ${many(renewal.total, "shape")} are described anew for a new version; ` +
    `searches answer from the earlier descriptions until all are.${lost}`;
}

/** How fast it goes: "41 finished in the last minute, 1,200 in the last hour; 1.7 seconds each." */
export function speedOf({ finished, median_seconds: seconds }) {
  if (!finished.last_hour) return "Nothing was finished in the last hour.";
  const each = seconds === null ? "" : `; ${seconds.toLocaleString("en-GB", { maximumSignificantDigits: 2 })} seconds each`;
  return `${count(finished.last_minute)} finished in the last minute, ${count(finished.last_hour)} in the last hour${each}.`;
}

/** Why nothing moves, where that is so. */
export function stallOf({ queued, workers, finished, oldest_queued_at: oldest }, now = Date.now()) {
  const patience = 60_000; // milliseconds; a worker that starts needs some seconds
  if (!queued || workers.length || finished.last_minute || now - new Date(oldest) < patience) return null;
  return "No worker takes what is waiting. Is one running? The service starts its own unless it was told to have none; " +
    "more are started with “faience worker”. A full disk holds them up, too.";
}
