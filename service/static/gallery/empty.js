// What stands in the place of cards, or above them, where there is little to see.

import { html } from "../vendor/lit-html.js";
import { STATES, count } from "../shared/words.js";
import { isFiltered } from "./filters.js";

/** An empty shelf: a library to begin, or filters that nothing passes. */
export function empty(filters, clear) {
  if (isFiltered(filters)) {
    return html`<section class="empty"><h2>No shape matches</h2>
      <p>Nothing in the library has all that is asked for: ${asked(filters)}.</p>
      <p><button class="strong" @click=${clear}>Clear the filters</button></p></section>`;
  }
  return html`<section class="empty"><h2>Nothing is here yet</h2>
    <p>Drop a mesh anywhere on this page, or a whole folder of them: a .ply, an .obj with its .mtl and images, or a zip.
      Its picture appears here within seconds, and every shape that you add can be compared with all others.</p>
    <p>Many at once go in by a command where the service runs:</p>
    <p><code>faience index scans/</code></p></section>`;
}

function asked({ q, tags, status }) {
  const parts = [q && `“${q}” in its name or metadata`, ...tags.map((tag) => `the tag “${tag}”`), status && `the state “${STATES[status]}”`];
  return parts.filter(Boolean).join(", ");
}

/** A line for a library without a picture so far. */
export function beginning({ total, ready, queued, processing }) {
  const coming = queued + processing;
  if (ready || !coming) return "";
  const who = coming < total ? `${count(coming)} of ${count(total)} shapes` : total === 1 ? "The shape" : `All ${count(total)} shapes`;
  return html`<p class="notice">${who} ${coming === 1 ? "is" : "are"} still being described. Pictures appear here as they are ready; there is nothing to do.</p>`;
}
