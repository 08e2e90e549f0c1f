// One shape of a group as a card, with what tells it from the others.

import { html } from "../vendor/lit-html.js";
import { portrait } from "../shared/portrait.js";
import { COLOURS, count, many, size, when } from "../shared/words.js";

const WIDTH = "(max-width: 30rem) 40vw, 11rem"; // of its picture, see styles/duplicates.css

/** What a curator compares: [what, how it is]. */
export function factsOf(shape) {
  const bytes = shape.files.reduce((sum, file) => sum + file.size, 0);
  return [
    ["Faces", shape.mesh ? count(shape.mesh.faces) : "not known"],
    ["Colours", shape.mesh ? COLOURS[shape.mesh.colour] : "not known"],
    ["Files", shape.files.length === 1 ? size(bytes) : `${size(bytes)} in ${many(shape.files.length, "file")}`],
    ["Added", when(shape.created_at)],
  ];
}

/** Draw it beside the others; what differs among them stands out. */
export function copy(shape, others, actions) {
  const all = others.map(factsOf);
  const differs = (place) => new Set(all.map((facts) => facts[place][1])).size > 1;
  return html`<li class="copy">
    <a href="#/shapes/${encodeURIComponent(shape.id)}/details" title=${shape.name}>
      ${portrait(shape, WIDTH)}
      <span class="name">${shape.name}</span>
    </a>
    <dl>${factsOf(shape).map(([what, how], place) => html`<div class=${differs(place) ? "differs" : ""}><dt>${what}</dt><dd>${how}</dd></div>`)}</dl>
    <div class="row">${actions}</div>
  </li>`;
}
