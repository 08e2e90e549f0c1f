// How far the look is, and what to do next.

import { html, nothing } from "../vendor/lit-html.js";
import { RELATIONS, count, many } from "../shared/words.js";

/**
 * Say how far it is.
 *
 * @param {import("./look.js").Look} look
 * @param {number?} total - shapes that can be looked at; null where not known
 */
export function reached({ looked, ended, running }, total) {
  if (ended) return looked === 1 ? "Looked at the one shape that there is." : `Looked at all ${count(looked)} shapes.`;
  const of = total === null ? many(looked, "shape") : `${count(Math.min(looked, total))} of ${many(total, "shape")}`;
  return running ? `Looking: ${of} so far…` : `Looked at ${of}.`;
}

/** Draw it, with the button to go on or to stop. */
export function progressView(look, total, on) {
  if (look.ended && !look.looked) return nothing; // nothing is said of an empty library
  const problem = look.problem && html`<p role="alert">${look.problem.message} <small><code>${look.problem.code}</code></small></p>`;
  return html`<div class="looking">
    ${problem ?? nothing}
    <p>${reached(look, total)}</p>
    ${look.running ? html`<progress aria-label="Shapes looked at" max=${Math.max(total ?? 0, look.looked, 1)} value=${look.looked}></progress>
      <button @click=${on.stop}>Stop</button>` : nothing}
    ${!look.running && !look.ended ? html`<button class="strong" @click=${on.further}>Look further</button>` : nothing}
  </div>`;
}

/** What stands where no group does. */
export function emptyView({ looked, ended, running, kinds }, found) {
  if (running || !ended || found) return nothing;
  if (!looked) {
    return html`<div class="empty"><h2>There is nothing to compare yet</h2>
      <p>The library holds no shape that is ready. Drop meshes anywhere on this page to add them; <a href="#/jobs">Jobs</a> shows what is waiting.</p></div>`;
  }
  return html`<div class="empty"><h2>No duplicates were found</h2>
    <p>Each shape was compared with those nearest to it, for: ${kinds.map((kind) => RELATIONS[kind]).join("; ")}.
      Parts of shapes are not looked for here: what is similar to a shape tells them.</p></div>`;
}
