// The cards of a shelf, in sheets: a change draws one sheet anew, however many shapes there are.

import { guard, html, repeat } from "../vendor/lit-html.js";
import { card } from "./card.js";

const SHEET = 840; // cards; 1 to 8 columns divide it, so that no sheet ends in the middle of a row
const FIRST = 12; // cards whose pictures are wanted at once

export function sheets(items) {
  const starts = Array.from({ length: Math.ceil(items.length / SHEET) }, (_, number) => number * SHEET);
  return starts.map((start) => {
    const held = items.slice(start, start + SHEET);
    return guard(held, () => html`<ul class="cards" aria-label="Shapes">${repeat(held, ({ id }) => id, (shape, place) => card(shape, { eager: start + place < FIRST }))}</ul>`);
  });
}
