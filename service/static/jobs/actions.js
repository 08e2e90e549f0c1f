// What the buttons of the page of jobs do.

import { Problem } from "../shared/api.js";
import { say } from "../shared/said.js";
import { moved } from "./lists.js";
import { retry, retryAll } from "./retrying.js";

export class Actions {
  #stopping = new AbortController();

  constructor({ state, draw, readList, root, signal }) {
    Object.assign(this, { state, draw, readList, root, signal });
  }

  more = (status) => this.readList(status, this.state.lists[status].cursor);

  retry = async (shape) => {
    const { state } = this;
    try {
      this.#queued(await retry(shape.id, this.signal));
      state.refused = null;
      say(`${shape.name} is tried again.`);
      this.root.querySelector("#jobs").focus(); // the button goes away with its row
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      state.refused = { id: shape.id, problem: error };
    }
    this.draw();
  };

  retryAll = async () => {
    const { state } = this;
    this.#stopping = new AbortController();
    state.retrying = { done: 0, of: state.queue.failed, problem: null };
    this.draw();
    try {
      await retryAll((shape) => this.#counted(shape), AbortSignal.any([this.signal, this.#stopping.signal]));
      state.retrying = null;
    } catch (error) {
      if (!(error instanceof Problem) && error.name !== "AbortError") throw error;
      state.retrying = error instanceof Problem ? { ...state.retrying, problem: error } : null;
    }
    this.draw();
    say("What failed was queued again.");
  };

  stop = () => this.#stopping.abort();

  #counted(shape) {
    this.state.retrying.done += 1;
    this.#queued(shape);
  }

  #queued(shape) {
    this.state.lists = moved(this.state.lists, shape);
    this.draw();
  }
}
