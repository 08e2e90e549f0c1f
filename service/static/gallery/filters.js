// What of the library is looked at, as the address says it: #/?q=words&tag=vase&tag=red&status=failed.

import { folded, hasTag } from "../shared/tags.js";
import { STATES } from "../shared/words.js";

/** Read filters: `{q, tags, status}`, where `status` is "" for all states. */
export function filtersOf(query) {
  const status = query.get("status");
  return { q: query.get("q") ?? "", tags: query.getAll("tag"), status: status in STATES ? status : "" };
}

/** Write filters as an address within the page. */
export function addressOf({ q, tags, status }) {
  const pairs = [["q", q], ...tags.map((tag) => ["tag", tag]), ["status", status]];
  const query = new URLSearchParams(pairs.filter(([, value]) => value)).toString();
  return query ? `#/?${query}` : "#/";
}

/** The same filters as the interface's parameters. */
export const parametersOf = ({ q, tags, status }) => ({ q, tag: tags, status });

export const isFiltered = ({ q, tags, status }) => Boolean(q || tags.length || status);

/** Whether a shape passes, judged as the service does: the words as one text, in the name or in metadata's values. */
export function passes(shape, { q, tags, status }) {
  if (status && shape.status !== status) return false;
  if (!tags.every((tag) => hasTag(shape, tag))) return false;
  return !q || folded([shape.name, ...textsOf(shape.metadata)].join("\n")).includes(folded(q));
}

function textsOf(value) {
  if (value === null) return [];
  return typeof value === "object" ? Object.values(value).flatMap(textsOf) : [String(value)];
}
