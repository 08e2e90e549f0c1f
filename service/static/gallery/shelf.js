// The shapes under one set of filters, newest first, as far as they were asked for; kept true while the library changes.

import { path, read } from "../shared/api.js";
import { addressOf, isFiltered, parametersOf, passes } from "./filters.js";

const PAGE = 60; // shapes asked for at once
const MOST = 500; // of one page, by the service

export class Shelf {
  items = []; // another array after each change: what draws them compares
  arrived = []; // shapes that belong here and are not shown yet
  newest = ""; // time of the newest shape so far
  cursor = null;
  done = false; // all pages are here
  problem = null; // of the page that was asked for last
  loading = null; // a promise, while a page is on its way
  element = document.createElement("div"); // holds the cards, also while another view is shown
  y = 0; // pixels that it was scrolled
  known = null; // what the service counted last, while this was shown
  changed = () => {}; // whoever shows it hears of pages, and with `true` of changes in the library

  constructor(filters) {
    this.filters = filters;
    this.address = addressOf(filters);
  }

  /** Ask for the next page; what the service refuses is in `problem` afterwards, and may be asked for again. */
  more() {
    if (this.done || this.loading) return this.loading;
    this.problem = null;
    this.loading = this.#load().finally(() => {
      this.loading = null;
      this.changed();
    });
    this.changed();
    return this.loading;
  }

  async #load() {
    try {
      const page = await read(path(["shapes"], { limit: PAGE, cursor: this.cursor, ...parametersOf(this.filters) }));
      const known = new Set([...this.items, ...this.arrived].map(({ id }) => id));
      this.items = [...this.items, ...page.items.filter(({ id }) => !known.has(id))];
      this.cursor = page.next_cursor;
      this.done = page.next_cursor === null;
      for (const { created_at: time } of page.items) if (time > this.newest) this.newest = time;
    } catch (error) {
      this.problem = error;
    }
  }

  /** Hear of a change in the library. */
  hear({ shape, removed }) {
    const id = removed ?? shape.id;
    const is = (one) => one.id === id;
    if (removed || !passes(shape, this.filters)) this.#map((list) => list.filter((one) => !is(one)));
    else if (this.items.some(is) || this.arrived.some(is)) this.#map((list) => list.map((one) => (is(one) ? shape : one)));
    else this.#welcome(shape);
    this.changed(true);
  }

  #map(change) {
    this.items = change(this.items);
    this.arrived = change(this.arrived);
  }

  /** A shape that is not here is new, or came under the filters by its change, or its page was not asked for yet. */
  #welcome(shape) {
    const last = this.done ? "" : this.items.at(-1)?.created_at;
    const came = isFiltered(this.filters) && shape.created_at > last;
    if (shape.created_at > this.newest || came) this.arrived = [...this.arrived, shape];
    if (shape.created_at > this.newest) this.newest = shape.created_at;
  }

  /** Put what arrived among what is shown, each before the first that is older. */
  show() {
    const items = [...this.items];
    for (const shape of this.arrived) {
      const place = items.findIndex((one) => one.created_at < shape.created_at);
      items.splice(place < 0 ? items.length : place, 0, shape);
    }
    Object.assign(this, { items, arrived: [] });
  }

  /** Hear of all that may have changed while nobody told. */
  async catchUp() {
    const limit = Math.min(MOST, Math.max(PAGE, this.items.length));
    const { items, next_cursor: next } = await read(path(["shapes"], { limit, ...parametersOf(this.filters) }));
    const there = new Set(items.map(({ id }) => id));
    const end = next === null ? this.items.length : this.items.findLastIndex(({ id }) => there.has(id));
    for (const { id } of this.items.slice(0, end)) if (!there.has(id)) this.hear({ removed: id });
    for (const shape of items) this.hear({ shape });
  }
}
