// The 3D view: a query alone, or beside one result after the other; in their colours, or by where they differ.

import { render } from "../vendor/lit-html.js";
import { Problem, path, read } from "../shared/api.js";
import { Latest } from "../shared/latest.js";
import { drawn } from "./drawn.js";

const calm = matchMedia("(prefers-reduced-motion: reduce)");

/**
 * Open the view over the page.
 *
 * @param {object} options
 * @param {{parts: string[], name: string}} options.query - `parts` of its path in the interface
 * @param {object[]} options.results - of the ranked answer; empty to see the query alone
 * @param {number} options.place - in the results, to begin with
 * @param {{method?: string, weights?: string}} options.parameters - by which they were ranked
 * @param {(id: string) => string} options.address - of the page of what is similar to a shape
 * @param {AbortSignal} options.signal - closes it
 * @returns {{update: (results: object[]) => void}} `update` where more is known about the same results
 */
export function openViewer(options) {
  const viewer = new Viewer(options);
  viewer.open();
  return viewer;
}

class Viewer {
  constructor(options) {
    Object.assign(this, options);
    this.closing = new AbortController();
    this.latest = new Latest(this.closing.signal);
    this.mode = "colours"; // or "why"
    this.turning = !calm.matches;
    this.shown = new Map(); // address → mesh on the stage
    this.explained = undefined; // the service's explanation of this pair, in mode "why"
    this.problem = undefined; // what went wrong, in words
    this.blind = false; // without WebGL
  }

  async open() {
    this.element = document.createElement("dialog");
    this.element.className = "viewer";
    this.element.setAttribute("aria-labelledby", "viewer-title");
    this.element.addEventListener("close", () => this.end(), { once: true });
    this.signal.addEventListener("abort", () => this.element.close(), { signal: this.closing.signal });
    document.body.append(this.element);
    this.draw();
    this.element.showModal(); // thumbnails are there at once; the models take their places
    await this.raise();
  }

  async raise() {
    const [{ Stage }, models] = await Promise.all([import("./stage.js"), import("./model.js")]);
    if (this.closing.signal.aborted) return;
    this.loadModel = models.loadModel;
    this.stage = Stage.on(this.element.querySelector("canvas"), () => this.turning && this.spin(false));
    this.blind = !this.stage;
    this.stage?.spin(this.turning);
    this.draw();
    await this.show();
  }

  get result() {
    return this.results[this.place];
  }

  update(results) {
    if (this.closing.signal.aborted || !this.result) return;
    this.results = results;
    this.draw();
  }

  go(place) {
    if (!this.results[place]) return;
    this.place = place;
    this.explained = undefined;
    this.draw();
    this.show();
  }

  look(mode) {
    this.mode = mode;
    this.draw();
    this.show();
  }

  spin(on) {
    this.turning = on;
    this.stage?.spin(on);
    this.draw();
  }

  async show() {
    this.problem = undefined;
    await this.bring();
  }

  /** Bring onto the stage what is asked for. */
  async bring() {
    if (!this.stage) return;
    try {
      await this.latest.run((signal) => this.load(signal));
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      await this.refuse(error);
    }
  }

  /** What cannot be explained is shown in its colours; what cannot be loaded leaves its thumbnail. */
  async refuse(problem) {
    this.problem = problem;
    if (this.mode === "why") {
      this.mode = "colours";
      await this.bring();
    } else {
      this.shown = new Map();
      this.stage.show([]);
    }
    this.draw();
  }

  async load(signal) {
    const why = this.mode === "why";
    const explaining = why ? read(path(this.why(), this.parameters), { signal }) : undefined;
    const addresses = why ? this.whyModels() : this.models();
    const loading = addresses.map((address) => this.shown.get(address) ?? this.loadModel(address, signal));
    const [explained, ...meshes] = await Promise.all([explaining, ...loading]);
    if (signal.aborted) return;
    this.explained = explained;
    this.shown = new Map(addresses.map((address, place) => [address, meshes[place]]));
    this.draw();
    const places = this.element.querySelectorAll(".place");
    this.stage.show(meshes.map((mesh, place) => ({ mesh, place: places[place] })));
  }

  why() {
    return [...this.query.parts, "why", this.result.shape.id];
  }

  whyModels() {
    return ["query.glb", "result.glb"].map((file) => path([...this.why(), file], this.parameters));
  }

  models() {
    const shapes = this.result ? [["shapes", this.result.shape.id]] : [];
    return [this.query.parts, ...shapes].map((parts) => path([...parts, "preview.glb"]));
  }

  draw() {
    render(drawn(this), this.element);
  }

  close() {
    this.element.close();
  }

  end() {
    this.closing.abort();
    this.stage?.dispose();
    this.element.remove();
  }
}
