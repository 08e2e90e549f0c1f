// Everything about one shape, beside an answer or on a page of its own. It keeps itself up to date.

import { html, render } from "../vendor/lit-html.js";
import { Problem } from "../shared/api.js";
import { listen } from "../shared/live.js";
import { picture } from "../shared/picture.js";
import { say } from "../shared/said.js";
import { STATES, moment } from "../shared/words.js";
import { meshFacts, metadataRows } from "./facts.js";
import { files } from "./files.js";
import { heading } from "./heading.js";
import { naming } from "./naming.js";
import { removing } from "./removing.js";
import { state } from "./state.js";
import { tagging } from "./tagging.js";

/**
 * Draw the details of a shape as the interface gives it.
 *
 * @param {object} shape
 * @param {{whole?: boolean}} [options] - `whole` where it is the whole page: its name is the page's heading. Whoever
 *   shows it hears of changes by shared/live.js, or by the event `changed` whose `detail` is the shape.
 */
export const details = (shape, { whole = false } = {}) =>
  html`<shape-details .whole=${whole} .shape=${shape}></shape-details>`;

class ShapeDetails extends HTMLElement {
  whole = false;
  renaming = false;
  busy = false;
  problem = null;
  #shape;

  get shape() {
    return this.#shape;
  }

  set shape(shape) {
    if (shape.id !== this.#shape?.id) Object.assign(this, { renaming: false, problem: null, gone: false });
    this.#shape = shape;
    this.draw();
  }

  connectedCallback() {
    this.classList.toggle("whole", this.whole);
    this.leaving = new AbortController();
    listen((change) => this.hear(change), this.leaving.signal);
  }

  disconnectedCallback() {
    this.leaving.abort();
  }

  hear({ shape, removed }) {
    if (removed === this.shape.id) this.gone = true;
    if (shape?.id === this.shape.id) this.shape = shape;
    else if (this.gone) this.draw();
  }

  rename(renaming) {
    Object.assign(this, { renaming, renamed: !renaming, problem: null });
    this.draw();
  }

  /** Change the shape by `work`, which returns it; say so. Returns whether it was done. */
  async write(work, said) {
    const done = await this.attempt(async () => (this.shape = await work()));
    if (done) {
      say(said);
      this.dispatchEvent(new CustomEvent("changed", { detail: this.shape, bubbles: true }));
    }
    return done;
  }

  /** Do something that the service may refuse; show its words where it does. Returns whether it was done. */
  async attempt(work) {
    Object.assign(this, { busy: true, problem: null });
    this.draw();
    try {
      await work();
      return true;
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      this.problem = error;
      return false;
    } finally {
      this.busy = false;
      this.draw();
    }
  }

  draw() {
    render(this.gone ? html`<p role="alert">“${this.shape.name}” was removed from the library.</p>` : this.parts(), this);
  }

  parts() {
    const { shape } = this;
    return html`<div class="sight">${sight(shape)}</div>
      <div class="about">
        ${naming(this)}
        <p class="soft">Added <time datetime=${shape.created_at}>${moment(shape.created_at)}</time></p>
        ${this.problem && html`<p role="alert" class="refusal">${this.problem.message} <small>code <code>${this.problem.code}</code></small></p>`}
        ${state(this)} ${tagging(this)} ${shape.mesh ? mesh(this) : ""} ${metadata(this)} ${files(this)}
        <p>${removing(this)}</p>
      </div>`;
  }
}
customElements.define("shape-details", ShapeDetails);

function sight({ id, status }) {
  if (status === "ready") return picture(`/v1/shapes/${encodeURIComponent(id)}`, "16rem", true);
  return html`<span class="blank ${status}">${STATES[status]}</span>`;
}

function mesh(panel) {
  const { mesh: found } = panel.shape;
  const odd = html`${heading(panel, "What was odd")}<ul>${found.warnings.map((one) => html`<li>${one}</li>`)}</ul>`;
  return html`${heading(panel, "Mesh")}${table(meshFacts(found))}${found.warnings.length ? odd : ""}`;
}

function metadata(panel) {
  const rows = metadataRows(panel.shape.metadata);
  return rows.length ? html`${heading(panel, "Metadata")}${table(rows)}` : "";
}

const table = (rows) => html`<table class="facts">${rows.map(([name, value]) => html`<tr><th scope="row">${name}</th><td>${value}</td></tr>`)}</table>`;
