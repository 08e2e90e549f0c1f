// One shape as a card: a picture, its name, and a note.

import { html } from "../vendor/lit-html.js";
import { picture } from "../shared/picture.js";
import { STATES, count } from "../shared/words.js";

export const CARD_WIDTH = "(max-width: 30rem) 42vw, 9.5rem"; // of its picture, see styles/base.css

/** What a card says below the name. */
export function noteOf(shape) {
  if (shape.status !== "ready") return STATES[shape.status];
  return `${count(shape.mesh.faces)} faces`;
}

/** Draw a shape as a card that leads to what is similar to it. */
export function card(shape, { note = noteOf(shape), eager = false } = {}) {
  const ready = shape.status === "ready";
  return html`<li class="card">
    <a href="#/shapes/${encodeURIComponent(shape.id)}">
      <span class="frame">${ready ? picture(`/v1/shapes/${encodeURIComponent(shape.id)}`, CARD_WIDTH, eager) : html`<span class="blank ${shape.status}">${STATES[shape.status]}</span>`}</span>
      <span class="name">${shape.name}</span>
      <small>${note}</small>
    </a>
  </li>`;
}
