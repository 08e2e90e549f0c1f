// How many shapes there are, in all and under the filters, and the sentence that says so.

import { path, read } from "../shared/api.js";
import { STATES, count, many } from "../shared/words.js";

/** Read the counts: `{all, found}`, each with `total` and a number for each state; `found` is under the filters. */
export async function readCounts({ q, tags }, signal) {
  const all = read(path(["counts"]), { signal });
  const found = q || tags.length ? read(path(["counts"], { q, tag: tags }), { signal }) : all;
  const [every, some] = await Promise.all([all, found]);
  return { all: every, found: some };
}

/** "2,000 shapes, 3 waiting, 1 failed", or "37 of 2,000 shapes match". */
export function sentence({ all, found }, { q, tags, status }) {
  if (!all.total) return "No shapes yet";
  if (!q && !tags.length && !status) return [many(all.total, "shape"), ...splits(all)].join(", ");
  const matching = status ? found[status] : found.total;
  return `${matching ? count(matching) : "None"} of ${many(all.total, "shape")} ${matching > 1 ? "match" : "matches"}`;
}

const splits = (counts) =>
  ["processing", "queued", "failed"].filter((state) => counts[state]).map((state) => `${count(counts[state])} ${STATES[state]}`);
