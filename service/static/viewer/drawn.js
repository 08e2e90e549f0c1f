// What the 3D view consists of: two places for models under one canvas, what can be done, what is told.

import { html } from "../vendor/lit-html.js";
import { path } from "../shared/api.js";
import { short } from "../shared/measures.js";
import { picture } from "../shared/picture.js";
import { evidence, relationName } from "../shared/relation.js";
import { capital } from "../shared/words.js";
import { pressed } from "./keys.js";
import { explanation } from "./why.js";

const SIZES = "(max-width: 50rem) 80vw, 16rem"; // of a thumbnail, until its model is there
const HELP = "Drag or use the arrow keys to turn, wheel or + and − to zoom.";

/** Draw the whole view. */
export function drawn(viewer) {
  const { query, result, results } = viewer;
  return html`<div class="inside" @keydown=${(event) => pressed(event, viewer)}>
    <div class="head">
      <h2 id="viewer-title" aria-live="polite">${result ? `Compared with result ${result.rank} of ${results.length}` : query.name}</h2>
      ${result ? steps(viewer) : ""}
      <button @click=${() => viewer.close()}>Close</button>
    </div>
    <div class="stage">
      ${half(viewer, query.parts, html`<strong>${query.name}</strong><small>The query</small>`)}
      ${result ? half(viewer, ["shapes", result.shape.id], beside(viewer)) : ""}
      <canvas tabindex="0" role="img" ?hidden=${viewer.blind} aria-label="${named(viewer)} ${HELP}"></canvas>
    </div>
    <div class="foot ${result ? "pair" : ""}">${tools(viewer)}<div class="told" tabindex=${result ? 0 : -1} role="region" aria-label="What is seen">${told(viewer)}</div></div>
  </div>`;
}

const named = ({ query, result }) => (result ? `${query.name}, and ${result.shape.name}, in 3D.` : `${query.name} in 3D.`);

const steps = (viewer) => html`<span class="row">
  ${step(viewer, viewer.place - 1, "Previous result", "‹", "Page Up")}${step(viewer, viewer.place + 1, "Next result", "›", "Page Down")}</span>`;

/** At an end the button stays where the focus is. */
const step = (viewer, place, name, sign, key) => html`<button aria-label=${name} title=${key} aria-disabled=${!viewer.results[place]}
  @click=${() => viewer.go(place)}>${sign}</button>`;

const half = (viewer, parts, caption) => html`<figure class="half">
  <figcaption>${caption}</figcaption>
  <div class="place ${viewer.shown.size ? "taken" : ""}">${picture(path(parts), SIZES, true)}</div>
</figure>`;

const beside = ({ result, address }) => html`<strong>${result.rank}. ${result.shape.name}</strong>
  <small>Distance ${short(result.distance)}${result.relation ? `, ${relationName(result.relation)}` : ""} ·
    <a href=${address(result.shape.id)}>Similar to this</a></small>`;

function tools(viewer) {
  const mode = (name, title) => html`<button aria-pressed=${viewer.mode === name} @click=${() => viewer.look(name)}>${title}</button>`;
  if (viewer.blind) return "";
  return html`<div class="row">
    ${viewer.result ? html`<span class="switch" role="group" aria-label="What the surfaces show">${mode("colours", "Colours")}${mode("why", "Why they differ")}</span>` : ""}
    <button aria-pressed=${viewer.turning} @click=${() => viewer.spin(!viewer.turning)}>Turn</button>
    <button aria-label="Nearer" @click=${() => viewer.stage?.zoom(1)}>+</button>
    <button aria-label="Further away" @click=${() => viewer.stage?.zoom(-1)}>−</button>
  </div>`;
}

/** Say what is seen, or why it is not. */
function told({ blind, problem, mode, explained, result, parameters }) {
  if (blind) return html`<p role="alert">This browser shows no 3D (WebGL is off or missing), so these are the pictures alone.</p>`;
  if (problem) return html`<p role="alert">${problem.message} <small>(${problem.code})</small></p>`;
  if (mode === "why") return explained ? explanation(explained, !parameters.method) : html`<p class="soft">Comparing…</p>`;
  if (result?.relation) return html`<p><strong>${capital(relationName(result.relation))}</strong>, since:</p>${evidence(result.relation)}`;
  return html`<p class="soft">${HELP}</p>`;
}
