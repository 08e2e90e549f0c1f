// One look through the library, a page at a time: the service compares some fifty shapes a page.

import { path, read } from "../shared/api.js";

const GROUPS = 10; // of a page, about

/** What was found so far, and how far it is. */
export class Look {
  groups = [];
  looked = 0; // shapes
  running = false;
  ended = false;
  problem = null; // why it stands still
  #cursor = undefined;
  #stopping = new AbortController();

  constructor(kinds) {
    this.kinds = kinds;
  }

  /** Go on until a page holds a group, or to the end; `told` hears of every page. */
  async further(told, signal) {
    this.#stopping = new AbortController();
    Object.assign(this, { running: true, problem: null });
    try {
      const until = AbortSignal.any([signal, this.#stopping.signal]);
      while (!(await this.#page(until)) && !this.ended) told();
    } catch (error) {
      if (error.name !== "AbortError") this.problem = error;
    }
    this.running = false;
  }

  stop() {
    this.#stopping.abort();
  }

  /** Ask for one page; tell whether it brought a group. */
  async #page(signal) {
    const asked = { limit: GROUPS, cursor: this.#cursor, relation: this.kinds };
    const page = await read(path(["duplicates"], asked), { signal });
    const known = new Set(this.groups.map(({ id }) => id));
    const found = page.items.filter(({ id }) => !known.has(id));
    this.groups.push(...found);
    this.looked += page.looked;
    this.#cursor = page.next_cursor;
    this.ended = page.next_cursor === null;
    return found.length > 0;
  }
}
