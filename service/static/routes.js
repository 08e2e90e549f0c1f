// Which view an address belongs to: #/path?parameters. Views that few open are loaded when they are.

import { showGallery } from "./gallery/view.js";

const ROUTES = [
  [/^\/$/, "#/", showGallery],
  [/^\/duplicates$/, "#/duplicates", async (context) => (await import("./duplicates/view.js")).showDuplicates(context)],
  [/^\/jobs$/, "#/jobs", async (context) => (await import("./jobs/view.js")).showJobs(context)],
  [/^\/shapes\/([^/]+)$/, "#/", async (context) => (await import("./answer/view.js")).showAnswer({ ...context, kind: "shapes" })],
  [/^\/queries\/([^/]+)$/, "#/", async (context) => (await import("./answer/view.js")).showAnswer({ ...context, kind: "queries" })],
  [/^\/shapes\/([^/]+)\/details$/, "#/", async (context) => (await import("./shape/view.js")).showShape(context)],
];

/**
 * Find the view of an address.
 *
 * @param {string} hash - as in `location.hash`
 * @returns {{view: Function, parameters: {id?: string, query: URLSearchParams}, section: string}} `section` is the link
 *   of the page's header that it belongs to; an address that nobody knows leads to the library
 */
export function routeOf(hash) {
  const [path, query = ""] = (hash.slice(1) || "/").split("?", 2);
  for (const [pattern, section, view] of ROUTES) {
    const found = path.match(pattern);
    if (found) return { view, section, parameters: { id: decoded(found[1]), query: new URLSearchParams(query) } };
  }
  return { view: showGallery, section: "#/", parameters: { query: new URLSearchParams() } };
}

function decoded(text) {
  try {
    return text === undefined ? undefined : decodeURIComponent(text);
  } catch {
    return text; // a lone % is no code
  }
}
