// The library as pictures, newest first.

import { html, render } from "../vendor/lit-html.js";
import { path, read } from "../shared/api.js";
import { say } from "../shared/said.js";
import { many } from "../shared/words.js";
import { readCounts, sentence } from "./counting.js";
import { beginning, empty } from "./empty.js";
import { ending, watchEnd } from "./ending.js";
import { addressOf, filtersOf, isFiltered } from "./filters.js";
import { keep, shelfWith } from "./kept.js";
import { sheets } from "./sheets.js";
import { soon } from "./soon.js";
import { toolbar } from "./toolbar.js";

const TAGS = 12; // shown as chips
const COUNT_EVERY = 2000; // milliseconds at least, while shapes change
const TOP = 8; // pixels; scrolled less than this is at the top

export async function showGallery({ root, parameters, signal }) {
  document.title = "Faience";
  await new Gallery(root, signal).open(filtersOf(parameters.query));
}

class Gallery {
  known = { tags: { items: [], next_cursor: null } }; // what the service counted
  typing = false; // words are being typed: their address takes the place of the one before

  constructor(root, signal) {
    Object.assign(this, { root, signal });
    this.countSoon = soon(() => this.count(), COUNT_EVERY, signal);
    this.lookAtEnd = watchEnd(root, () => this.shelf.problem || this.shelf.more(), signal);
    window.addEventListener("scroll", () => this.scrolled(), { signal, passive: true });
    signal.addEventListener("abort", () => (this.shelf.changed = () => {}));
  }

  /** Show a shelf; what the service refuses at first is for the whole page to explain. */
  async open(filters) {
    this.filters = filters;
    const shelf = shelfWith(filters);
    const { y } = shelf;
    this.take(shelf);
    this.countSoon();
    await filled(shelf);
    if (this.signal.aborted) return;
    if (shelf.problem && !shelf.items.length) throw shelf.problem;
    keep(shelf);
    if (y) scrollTo(0, y);
  }

  take(shelf) {
    if (this.shelf) this.shelf.changed = () => {};
    this.shelf = shelf;
    this.known = shelf.known ?? this.known; // who comes back finds the same lines above the cards
    shelf.changed = (heard) => {
      if (heard) this.countSoon();
      this.drawSoon();
    };
    this.draw();
  }

  /** Look at something else: the address says so, and what is being typed into stays. */
  async change(part, typed = false) {
    const filters = { ...this.filters, ...part };
    const address = addressOf(filters);
    const still = typed && this.typing;
    this.typing = typed;
    if (address === addressOf(this.filters)) return;
    history[still ? "replaceState" : "pushState"](null, "", address);
    this.filters = filters;
    this.draw();
    const shelf = shelfWith(filters);
    await Promise.all([this.count(), filled(shelf)]);
    if (this.signal.aborted || this.filters !== filters) return; // something else was wanted meanwhile
    keep(shelf);
    this.take(shelf);
    if (this.known.counts) say(sentence(this.known.counts, filters));
  }

  clear() {
    this.change({ q: "", tags: [], status: "" });
    const words = this.root.querySelector("[type=search]");
    words.value = "";
    words.focus();
  }

  async more() {
    const { length } = this.shelf.items;
    await this.shelf.more();
    this.draw();
    this.shelf.element.querySelectorAll(".card > a")[length]?.focus({ preventScroll: true });
  }

  showArrived() {
    this.shelf.show();
    this.draw();
    scrollTo(0, 0);
    this.shelf.element.querySelector(".card > a")?.focus({ preventScroll: true });
  }

  scrolled() {
    this.shelf.y = scrollY;
    if (scrollY < TOP && this.shelf.arrived.length) this.drawSoon();
  }

  /** Count anew; a library whose counts do not come is shown without them. */
  async count() {
    const { filters, signal } = this;
    const reading = [readCounts(filters, signal), read(path(["tags"], { limit: TAGS }), { signal })];
    const [counts, tags] = await Promise.allSettled(reading);
    if (signal.aborted || this.filters !== filters) return;
    this.known = { counts: counts.value ?? this.known.counts, tags: tags.value ?? this.known.tags };
    if (this.shelf.filters === filters) this.shelf.known = this.known;
    this.drawSoon();
  }

  drawSoon() {
    this.drawing ??= requestAnimationFrame(() => {
      this.drawing = undefined;
      if (!this.signal.aborted && !(this.shelf.problem && !this.shelf.items.length)) this.draw();
    });
  }

  draw() {
    const { shelf, filters, known } = this;
    if (shelf.arrived.length && shelf.y < TOP) shelf.show();
    render(sheets(shelf.items), shelf.element);
    const bare = shelf.done && !shelf.items.length; // the shelf's own filters: another one may be on its way
    const begun = shelf.items.length || isFiltered(shelf.filters);
    render(html`<div class="title"><h1>Library</h1><p class="soft">${known.counts && !(bare && !begun) ? sentence(known.counts, filters) : ""}</p></div>
      ${begun ? toolbar(filters, known, (part, typed) => this.change(part, typed)) : ""}
      ${known.counts ? beginning(known.counts.all) : ""} ${this.news()}
      ${bare ? empty(shelf.filters, () => this.clear()) : ""}
      ${shelf.element} ${ending(shelf, () => this.more())}`, this.root);
    this.lookAtEnd();
  }

  news() {
    const { length } = this.shelf.arrived;
    if (length && !this.told) say(`${many(length, "new shape")}`);
    this.told = length > 0;
    return length ? html`<p class="news"><button class="strong" @click=${() => this.showArrived()}>${many(length, "new shape")} – show</button></p>` : "";
  }
}

/** Wait for the first page of a shelf that has none. */
const filled = (shelf) => (shelf.items.length || shelf.done ? undefined : shelf.more());
