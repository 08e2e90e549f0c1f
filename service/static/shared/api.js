// Calls of the service's interface. What it refuses arrives as a Problem, in its own words.

import { heldKey } from "./key.js";

/** What the service refused: `code` is stable, the message is for people. */
export class Problem extends Error {
  constructor(status, { code = "unreachable", detail, title } = {}) {
    super(detail || title || "The service does not answer.");
    this.status = status; // of HTTP; 0 where no answer came
    this.code = code;
  }
}

/** Headers that every request carries. */
export function headers() {
  const key = heldKey();
  return key ? { Authorization: `Bearer ${key}` } : {};
}

/** Read the problem out of an answer's text; proxies in between answer with other things. */
export function problemOf(status, text) {
  try {
    return new Problem(status, JSON.parse(text));
  } catch {
    return new Problem(status, { code: "unknown", detail: `The answer was ${status}, without a reason.` });
  }
}

/** Send a request; return the answer where it is 2xx, raise a Problem otherwise. */
export async function request(path, { method = "GET", signal, json } = {}) {
  const body = json === undefined ? undefined : JSON.stringify(json);
  const kind = body === undefined ? {} : { "Content-Type": "application/json" };
  let answer;
  try {
    answer = await fetch(path, { method, signal, body, headers: { ...headers(), ...kind } });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Problem(0, { detail: "The service does not answer. Is it running, and is this machine connected to it?" });
  }
  if (!answer.ok) throw problemOf(answer.status, await answer.text());
  return answer;
}

/** Read JSON. */
export async function read(path, options) {
  return (await request(path, options)).json();
}

/** Write a path of the interface: each part is escaped; parameters that are undefined or empty are left out. */
export function path(parts, parameters = {}) {
  const kept = Object.entries(parameters).flatMap(([name, value]) =>
    [value].flat().filter((one) => one !== undefined && one !== null && one !== "").map((one) => [name, one]));
  const query = new URLSearchParams(kept).toString();
  return `/v1/${parts.map(encodeURIComponent).join("/")}${query && `?${query}`}`;
}
