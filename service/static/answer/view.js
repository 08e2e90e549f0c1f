// What is similar to a shape of the library, or to a mesh that was only shown: the query, and the others by rank.

import { html, render } from "../vendor/lit-html.js";
import { Problem, path, read } from "../shared/api.js";
import { listen } from "../shared/live.js";
import { say } from "../shared/said.js";
import { askedOf, inAddress, isDefault } from "./asked.js";
import { controls } from "./controls.js";
import { parametersOf, wordsFor } from "./dial.js";
import { Latest } from "../shared/latest.js";
import { moving } from "./moving.js";
import { methodTitle } from "./names.js";
import { results } from "./results.js";
import { forgotten, removed, subject, unready } from "./subject.js";

const STEPS = [24, 96, 384, 1000]; // results shown, more by more; the service gives no more than the last
const PATIENCE = 250; // milliseconds that an answer may take, until a newer question ends it

/** Show `#/shapes/ID` or `#/queries/ID`; `kind` is which of the two. */
export async function showAnswer({ root, parameters, signal, kind }) {
  await new Answer({ root, signal, kind, id: parameters.id, asked: askedOf(parameters.query) }).start();
}

class Answer {
  constructor({ root, signal, kind, id, asked }) {
    Object.assign(this, { root, signal, kind, id, asked });
    this.parts = [kind, id];
    this.base = path(this.parts);
    this.ranking = new Latest(signal, PATIENCE);
    this.relating = new Latest(signal);
    this.limit = STEPS[0];
    this.ranked = undefined; // the service's answer
    this.refusal = undefined; // why there is none
  }

  async start() {
    if (this.kind === "shapes") listen((change) => this.hear(change), this.signal, { onOpen: () => this.catchUp() });
    try {
      [this.query, { items: this.methods }] = await Promise.all([this.readQuery(), read("/v1/methods", { signal: this.signal })]);
    } catch (error) {
      if (error.code !== "query_not_found") throw error;
      return this.forget();
    }
    document.title = `${this.query.name} · Faience`;
    this.draw();
    if (this.isReady()) await this.ask();
  }

  readQuery() {
    return read(this.base, { signal: this.signal });
  }

  isReady() {
    return this.kind === "queries" || this.query.status === "ready";
  }

  /** Follow the query while it is described, renamed or removed. */
  hear({ shape, removed: gone }) {
    if (gone === this.id) render(removed(), this.root);
    if (shape?.id !== this.id || !this.query) return;
    const waited = !this.isReady();
    this.query = shape;
    this.draw();
    if (waited && this.isReady()) this.ask();
  }

  /** What changed before the stream began is not told. */
  async catchUp() {
    if (!this.query || this.isReady()) return;
    this.hear({ shape: await this.readQuery() });
  }

  forget() {
    document.title = "Faience";
    render(forgotten(), this.root);
  }

  /** Rank as asked now. The relations take longer: they follow. */
  async ask() {
    this.relating.end();
    try {
      const ranked = await this.ranking.run(async (signal) => this.show(await this.rank({}, signal)));
      if (ranked && isDefault(this.asked)) await this.relating.run(async (signal) => this.show(await this.rank({ relations: true }, signal)));
    } catch (error) {
      this.refuse(error);
    }
  }

  rank(settings, signal) {
    return read(path([...this.parts, "similar"], { ...parametersOf(this.asked, this.methods), limit: this.limit, ...settings }), { signal });
  }

  show(ranked) {
    this.ranked = ranked;
    this.refusal = undefined;
    moving(() => this.root.querySelector(".results"), () => this.draw());
    this.viewer?.update(ranked.results);
    const [nearest] = ranked.results;
    if (nearest) say(`${this.comparison()}: nearest is ${nearest.shape.name}.`);
  }

  refuse(error) {
    if (error.code === "query_not_found") return this.forget();
    if (!(error instanceof Problem)) throw error;
    this.refusal = error;
    this.draw();
  }

  /** Compare in another way from now on; the address tells which, without a step in the history for each. */
  compare(asked) {
    this.asked = { ...this.asked, ...asked };
    history.replaceState(history.state, "", `#/${this.parts.map(encodeURIComponent).join("/")}${inAddress(this.asked)}`);
    this.draw();
    this.ask();
  }

  comparison() {
    const method = this.methods.find(({ name }) => name === this.asked.method);
    return method ? methodTitle(method) : wordsFor(this.asked.colour);
  }

  more() {
    this.limit = STEPS.find((step) => step > this.limit);
    this.ask();
  }

  hasMore() {
    return this.ranked.results.length >= this.limit && this.limit < STEPS.at(-1);
  }

  /** Open the 3D view: of the query alone, or beside the result at a place of the list. */
  async look(place) {
    const { openViewer } = await import("../viewer/dialog.js");
    this.viewer = openViewer({
      query: { parts: this.parts, name: this.query.name },
      results: place === undefined ? [] : this.ranked.results,
      place: place ?? 0,
      parameters: parametersOf(this.asked, this.methods),
      address: (id) => this.addressOf(id),
      signal: this.signal,
    });
  }

  addressOf(id) {
    return `#/shapes/${encodeURIComponent(id)}${inAddress(this.asked)}`;
  }

  draw() {
    if (this.signal.aborted) return;
    render(html`<div class="answer">${subject(this)}
      <section class="ranked" aria-label="Similar shapes">${this.isReady() ? html`${controls(this)}${results(this)}` : unready(this.query)}</section>
    </div>`, this.root);
  }
}
