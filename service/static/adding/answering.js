// The answer to a question by a file: its page opens, unless somebody has gone on to another meanwhile.

import { say } from "../shared/said.js";
import { change } from "./uploads.js";

const asked = new WeakMap(); // where the page was

export const remember = (upload) => asked.set(upload, location.hash);

export const addressOf = (upload) => `#/queries/${encodeURIComponent(upload.query)}`;

export function answered(upload, { query, results }) {
  change(upload, { state: "answered", query: query?.id ?? null, results });
  if (upload.query !== null && asked.get(upload) === location.hash) location.hash = addressOf(upload);
  else say(`What is similar to ${upload.name} is found.`);
}
