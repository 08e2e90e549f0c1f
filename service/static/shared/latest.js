// What is asked again and again: only the latest counts.

/** Runs one thing at a time; a new one takes the place of the one before it. */
export class Latest {
  #signal;
  #patience;
  #ending = new AbortController();
  #running = Promise.resolve();
  #asked;

  /**
   * @param {AbortSignal} signal - ends everything
   * @param {number} patience - milliseconds that the one before gets to finish: without any, nothing at all would come
   *   about while somebody asks faster than there are answers
   */
  constructor(signal, patience = 0) {
    this.#signal = signal;
    this.#patience = patience;
  }

  /**
   * Run something that takes a signal, unless something newer is asked meanwhile. What fails raises, if it was not ended.
   *
   * @param {(signal: AbortSignal) => Promise<void>} work
   * @returns {Promise<boolean>} whether it came to its end
   */
  async run(work) {
    this.#asked = work;
    await Promise.race([this.#running, new Promise((done) => setTimeout(done, this.#patience))]);
    if (this.#asked !== work) return false;
    this.end();
    const signal = AbortSignal.any([this.#signal, this.#ending.signal]);
    const running = work(signal);
    this.#running = running.catch(() => {});
    try {
      await running;
      return true;
    } catch (error) {
      if (!signal.aborted) throw error;
      return false;
    }
  }

  /** End what runs. */
  end() {
    this.#ending.abort();
    this.#ending = new AbortController();
  }
}
