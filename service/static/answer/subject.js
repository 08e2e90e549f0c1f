// The query: its picture, its name, what is known about it; and what stands there while there is no answer.

import { html } from "../vendor/lit-html.js";
import { picture } from "../shared/picture.js";
import { details } from "../shape/details.js";
import { COLOURS, STATES, capital, count, when } from "../shared/words.js";

const SIZES = "(max-width: 50rem) 7rem, 16rem"; // of the picture, see styles/answer.css

/** Draw the query of an answer. */
export function subject(answer) {
  const { query, kind } = answer;
  return html`<section class="subject" aria-labelledby="query-name">
    ${answer.isReady()
      ? html`<button class="look frame" @click=${() => answer.look()} aria-label="Look at ${query.name} in 3D">${picture(answer.base, SIZES, true)}</button>`
      : html`<span class="frame"><span class="blank ${query.status}">${STATES[query.status]}</span></span>`}
    <div class="told">
      <p class="soft">Similar to</p>
      <h1 id="query-name">${query.name}</h1>
      ${query.mesh ? facts(query.mesh) : ""}
      ${kind === "queries"
        ? html`<p class="soft">Not in the library. It is remembered until ${when(query.expires_at)}.</p>`
        : html`<p class="soft">Added ${when(query.created_at)}</p>`}
    </div>
    ${kind === "shapes" ? html`<details class="more"><summary>Name, tags and files</summary>${details(query)}</details>` : ""}
  </section>`;
}

const facts = (mesh) => html`<dl class="facts">
    <div><dt>Faces</dt><dd>${count(mesh.faces)}</dd></div>
    <div><dt>Colours</dt><dd>${COLOURS[mesh.colour] ?? mesh.colour}</dd></div>
    ${mesh.components > 1 ? html`<div><dt>Pieces</dt><dd>${count(mesh.components)}</dd></div>` : ""}
  </dl>
  ${mesh.warnings.length ? html`<details class="mended"><summary>What was mended</summary>
    <ul>${mesh.warnings.map((warning) => html`<li>${capital(warning)}</li>`)}</ul></details>` : ""}`;

/** Say why there is no answer yet, or will be none. */
export const unready = ({ id, status, error }) => status === "failed"
  ? html`<h2>It could not be described</h2>
      <p role="alert">${error.detail} <small>(${error.code})</small></p>
      <p>It can be tried again: see <a href="#/shapes/${encodeURIComponent(id)}/details">its details</a>.</p>`
  : html`<h2>${status === "queued" ? "It waits for its turn" : "It is being described"}</h2>
      <p role="status">As soon as that is done, what is similar to it appears here.</p>
      <progress aria-label="Being described"></progress>`;

export const removed = () => html`<h1>This shape is gone</h1>
  <p role="alert">It was removed from the library.</p>
  <p><a href="#/">To the library</a></p>`;

export const forgotten = () => html`<h1>This search was forgotten</h1>
  <p role="alert">This search was forgotten after an hour; drop the mesh again.</p>
  <p><a href="#/">To the library</a></p>`;
