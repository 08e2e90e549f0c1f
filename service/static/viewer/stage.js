// One canvas with one or two models side by side, seen by one camera: what turns one turns the other.

import { OrbitControls, PerspectiveCamera, Scene, WebGLRenderer } from "../vendor/three.js";
import { discard } from "./model.js";

const AZIMUTH = 35, ELEVATION = 20; // degrees, as in the thumbnails
const SIGHT = 30; // degrees from the lower to the upper edge
const FAR = 1.03 / Math.sin((SIGHT / 2) * (Math.PI / 180)); // from here a unit sphere just fits
const STEP = Math.PI / 24; // turned by one key press
const ZOOM = 0.85; // one step nearer
const PACE = 1.5; // of turning by itself; 1 is a turn a minute

export class Stage {
  #models = [];
  #frame; // asked for
  #last = 0; // time of the picture before

  /** Prepare a canvas; undefined where the browser has no WebGL. `onHeld` hears that somebody takes hold of the models. */
  static on(canvas, onHeld) {
    const context = canvas.getContext("webgl2", { alpha: true, antialias: true });
    return context ? new Stage(canvas, context, onHeld) : undefined;
  }

  constructor(canvas, context, onHeld) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, context, alpha: true });
    this.renderer.setScissorTest(true);
    this.camera = new PerspectiveCamera(SIGHT, 1, 0.1, 50);
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, { enablePan: false, minDistance: 1.2, maxDistance: 3 * FAR, autoRotateSpeed: PACE });
    this.controls.addEventListener("change", () => this.#ask());
    this.controls.addEventListener("start", onHeld);
    this.resizing = new ResizeObserver(() => this.#ask());
    this.resizing.observe(canvas);
    this.#stand();
  }

  #stand() {
    const [azimuth, elevation] = [AZIMUTH, ELEVATION].map((angle) => (angle * Math.PI) / 180);
    const level = FAR * Math.cos(elevation);
    this.camera.position.set(level * Math.sin(azimuth), FAR * Math.sin(elevation), level * Math.cos(azimuth));
    this.controls.update();
  }

  /**
   * Show models, each in its place on the page; the camera stays where it is.
   *
   * @param {Array<{mesh: object, place: HTMLElement}>} models
   */
  show(models) {
    const kept = new Set(models.map(({ mesh }) => mesh));
    for (const { mesh } of this.#models) if (!kept.has(mesh)) discard(mesh);
    this.#models = models.map(({ mesh, place }) => ({ mesh, place, scene: new Scene().add(mesh) }));
    this.#ask();
  }

  turn(right, up) {
    if (right) this.controls.rotateLeft(right * STEP);
    if (up) this.controls.rotateUp(up * STEP);
  }

  zoom(steps) {
    this.controls.dollyIn(ZOOM ** steps);
  }

  /** Turn by itself, or stop. */
  spin(on) {
    this.controls.autoRotate = on;
    this.#ask();
  }

  /** Ask for one picture, however often it is asked for; while it turns, for one after the other. */
  #ask() {
    this.#frame ??= requestAnimationFrame((time) => {
      if (this.controls.autoRotate) this.controls.update(Math.min((time - this.#last) / 1000, 0.1));
      this.#last = time;
      this.#frame = undefined;
      this.#draw();
      if (this.controls.autoRotate) this.#ask();
    });
  }

  #draw() {
    const frame = this.canvas.getBoundingClientRect();
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(frame.width, frame.height, false);
    for (const { scene, place } of this.#models) this.#drawIn(place.getBoundingClientRect(), frame, scene);
  }

  #drawIn(place, frame, scene) {
    const corner = [place.left - frame.left, frame.bottom - place.bottom, place.width, place.height];
    this.renderer.setViewport(...corner);
    this.renderer.setScissor(...corner);
    this.camera.aspect = place.width / place.height;
    this.camera.zoom = Math.min(this.camera.aspect, 1); // what fits the height fits a narrow width, too
    this.camera.updateProjectionMatrix();
    this.renderer.render(scene, this.camera);
  }

  /** Give everything back: browsers have few contexts. */
  dispose() {
    cancelAnimationFrame(this.#frame);
    this.resizing.disconnect();
    this.controls.dispose();
    for (const { mesh } of this.#models) discard(mesh);
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
