// Numbers, times and states as people say them.

export const count = (number) => number.toLocaleString("en-GB");

/** "1 shape", "2,000 shapes". */
export const many = (number, one, several = `${one}s`) => `${count(number)} ${number === 1 ? one : several}`;

/** Bytes as people say them: "3.2 MB". */
export function size(bytes) {
  if (bytes < 1e3) return many(bytes, "byte");
  const step = bytes >= 1e9 ? [1e9, "GB"] : bytes >= 1e6 ? [1e6, "MB"] : [1e3, "kB"];
  return `${(bytes / step[0]).toLocaleString("en-GB", { maximumFractionDigits: bytes >= 1e6 ? 1 : 0 })} ${step[1]}`;
}

/** Seconds as people say them: "12 s", "3 min", "2 h". */
export function duration(seconds) {
  if (seconds < 10) return `${seconds.toLocaleString("en-GB", { maximumFractionDigits: 1 })} s`;
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
}

/** A time as people write it: "3 March 2026 at 09:30", where they are. */
export const moment = (time) => new Date(time).toLocaleString("en-GB", { dateStyle: "long", timeStyle: "short" });

export const STATES = { queued: "waiting", processing: "being described", ready: "ready", failed: "failed" };

export const RELATIONS = {
  same_file: "same file",
  same_shape: "same shape, re-exported or remeshed",
  recoloured: "recoloured",
  re_posed: "re-posed",
  part_of: "part of",
  similar: "similar",
};

/** Where the colours of a mesh come from, as the service names it, for people. */
export const COLOURS = {
  texture: "from pictures",
  vertex: "at its points",
  face: "on its faces",
  material: "of its materials",
  none: "none",
};

/** A time as people write it: "29 Nov 2026, 05:32". */
export const when = (time) =>
  new Date(time).toLocaleString("en-GB", { day: "numeric", month: "short", year: "numeric", hour: "2-digit", minute: "2-digit" });

export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
