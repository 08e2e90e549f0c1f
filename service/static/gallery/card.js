// One shape as a card: a picture, its name, and a note.

import { html } from "../vendor/lit-html.js";
import { picture } from "../shared/picture.js";
import { STATES, count } from "../shared/words.js";

export const CARD_WIDTH = "(max-width: 30rem) calc(50vw - 2.5rem), 9.5rem"; // of its picture, see styles/base.css

/** What a card says below the name. */
export function noteOf(shape) {
  if (shape.status === "ready") return `${count(shape.mesh.faces)} faces`;
  return shape.status === "failed" ? html`failed · <code>${shape.error.code}</code>` : "no picture yet";
}

/** Draw a shape as a card that leads to what is similar to it, or to its details where it is not ready. */
export function card(shape, { note = noteOf(shape), eager = false } = {}) {
  const address = `#/shapes/${encodeURIComponent(shape.id)}${shape.status === "ready" ? "" : "/details"}`;
  return html`<li class="card">
    <a href=${address} title=${shape.name}>
      <span class="frame">${sight(shape, eager)}</span>
      <span class="name">${shape.name}</span>
      <small>${note}</small>
    </a>
  </li>`;
}

function sight({ id, status, error }, eager) {
  if (status === "ready") return picture(`/v1/shapes/${encodeURIComponent(id)}`, CARD_WIDTH, eager);
  return html`<span class="blank ${status}"><span>${status === "failed" ? error.detail : STATES[status]}</span></span>`;
}
