// One group: its shapes side by side, what speaks for it, and what to decide.

import { html, nothing } from "../vendor/lit-html.js";
import { evidenceOf } from "../shared/evidence.js";
import { RELATIONS, many } from "../shared/words.js";
import { copy } from "./copy.js";
import { GROUPS } from "./kinds.js";

const SHOWN = 20; // pairs whose evidence is told

/**
 * Draw what is left of a group, and the notes on what was decided in it.
 *
 * @param {object} group - as the service gave it
 * @param {object[]} left - of `leftOf`
 * @param {object[]} notes - of `Decisions`
 * @param {{apart: Function, misfit: Function, remove: Function, undo: Function}} on - what the buttons do
 */
export function groupView(group, left, notes, on) {
  const wide = left.some(({ shapes }) => shapes.length > 2);
  return html`<div class="group ${wide ? "wide" : ""}">
    ${left.map((part, place) => partView(group, part, `group-${group.id}-${place}`, on))}
    ${notes.map((note) => noteView(note, on))}
  </div>`;
}

function partView(group, part, id, on) {
  const pair = part.shapes.length === 2;
  const actions = (shape) => (pair ? nothing : html`<button @click=${() => on.misfit(group, part, shape)}>Does not belong here<span class="unseen"> (${shape.name})</span></button>`);
  return html`<article aria-labelledby=${id}>
    <h2 id=${id} tabindex="-1">${many(part.shapes.length, "shape")}: ${GROUPS[part.relation]}</h2>
    ${among(part.evidence)}
    <ul class="copies">${part.shapes.map((shape) => copy(shape, part.shapes, html`${actions(shape)}
      <button class="quiet" @click=${() => on.remove(group, shape)}>Remove…<span class="unseen"> (${shape.name})</span></button>`))}</ul>
    ${pair ? html`<p><button @click=${() => on.apart(group, part)}>Not a duplicate</button></p>` : nothing}
    ${evidence(part)}
  </article>`;
}

/** Which relations join them, where there are several. */
function among(pairs) {
  const counted = Map.groupBy(pairs, ({ relation }) => relation.name);
  if (counted.size < 2) return nothing;
  const told = [...counted].map(([name, of]) => `${RELATIONS[name]} (${many(of.length, "pair")})`);
  return html`<p class="soft">Among them: ${told.join("; ")}</p>`;
}

function evidence({ shapes, evidence: pairs }) {
  const names = new Map(shapes.map(({ id, name }) => [id, name]));
  const rest = pairs.length - SHOWN;
  return html`<details>
    <summary>Why ${shapes.length === 2 ? "the two are" : "these are"} together</summary>
    ${pairs.slice(0, SHOWN).map(({ one, other, relation }) => html`
      <p class="between">“${names.get(one)}” and “${names.get(other)}”: <strong>${RELATIONS[relation.name]}</strong></p>
      <ul class="reasons">${evidenceOf(relation).map((sentence) => html`<li>${sentence}</li>`)}</ul>`)}
    ${rest > 0 ? html`<p class="soft">And ${many(rest, "more pair")}.</p>` : nothing}
  </details>`;
}

function noteView(note, on) {
  const undo = note.pairs.length ? html`<button @click=${() => on.undo(note)}>Undo</button>` : nothing;
  return html`<p class="decision row" id="decision-${note.number}" tabindex="-1">
    ${note.problem ? html`<span role="alert">${note.problem.message} <small><code>${note.problem.code}</code></small></span>` : html`<span>${note.text}</span>`} ${undo}
  </p>`;
}
