// The picture of a shape, or what stands in its place until there is one.

import { html } from "../vendor/lit-html.js";
import { picture } from "./picture.js";
import { STATES } from "./words.js";

export const portrait = (shape, sizes) => html`<span class="frame">${shape.status === "ready"
  ? picture(`/v1/shapes/${encodeURIComponent(shape.id)}`, sizes)
  : html`<span class="blank ${shape.status}">${STATES[shape.status]}</span>`}</span>`;
