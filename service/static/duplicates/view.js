// Duplicates: groups of shapes that are the same, found a page at a time. Nothing is removed by itself.

import { html, render, repeat } from "../vendor/lit-html.js";
import { path, read } from "../shared/api.js";
import { listen } from "../shared/live.js";
import { RELATIONS, capital } from "../shared/words.js";
import { Actions } from "./actions.js";
import { Decisions } from "./decisions.js";
import { Dismissed, dismissedView } from "./dismissed.js";
import { groupView } from "./group.js";
import { leftOf } from "./groups.js";
import { KINDS, kindsOf } from "./kinds.js";
import { Look } from "./look.js";
import { emptyView, progressView } from "./progress.js";

export async function showDuplicates({ root, parameters, signal }) {
  document.title = "Duplicates · Faience";
  const kinds = kindsOf(parameters.query);
  const { ready: total } = await read(path(["counts"]), { signal });
  const state = { total, kinds, look: new Look(kinds), decisions: new Decisions(), dismissed: new Dismissed(), anew: null };
  const draw = () => render(page(state, actions), root);
  const actions = new Actions({ state, draw, root, signal });
  listen((change) => heard(state, change) && draw(), signal);
  await actions.further();
  const { problem, groups } = state.look;
  if (problem && !groups.length) throw problem;
}

/** Keep up with what happens elsewhere; tell whether it concerns what is shown. */
function heard({ look, decisions }, { shape, removed }) {
  if (removed) decisions.removed.add(removed);
  for (const group of look.groups) group.shapes = group.shapes.map((old) => (old.id === shape?.id ? shape : old));
  return look.groups.some((group) => group.shapes.some(({ id }) => id === (removed ?? shape.id)));
}

function page(state, actions) {
  const { look, decisions, dismissed, total, anew } = state;
  const shown = look.groups.map((group) => [group, leftOf(group, decisions.dismissed, decisions.removed), decisions.notesOf(group.id)])
    .filter(([, left, notes]) => left.length || notes.length);
  return html`<h1>Duplicates</h1>
    <p class="soft">Shapes that are the same, but for their files, colours or poses. Nothing is removed by itself: you decide, group by group.</p>
    ${kindsView(state, actions)}
    <div class="groups">${repeat(shown, ([group]) => group.id, ([group, left, notes]) => groupView(group, left, notes, actions))}</div>
    ${state.kinds.length ? html`${emptyView(look, shown.length)} ${progressView(look, total, actions)}` : html`<p role="alert">Choose at least one kind of duplicate.</p>`}
    ${dismissedView(dismissed, anew, actions)}`;
}

function kindsView({ kinds }, actions) {
  return html`<fieldset class="kinds row">
    <legend>Look for</legend>
    ${KINDS.map((kind) => html`<label><input type="checkbox" .checked=${kinds.includes(kind)} @change=${(event) => actions.choose(kind, event.target.checked)}> ${capital(RELATIONS[kind])}</label>`)}
  </fieldset>`;
}
