// What is asked again and again: only the latest counts.

/** Runs one thing at a time; a new one ends the one before it. */
export class Latest {
  #running = new AbortController();
  #signal;

  /** @param {AbortSignal} signal - ends everything */
  constructor(signal) {
    this.#signal = signal;
  }

  /**
   * Run something that takes a signal. What is ended says nothing; what fails raises.
   *
   * @param {(signal: AbortSignal) => Promise<void>} work
   */
  async run(work) {
    this.#running.abort();
    this.#running = new AbortController();
    const signal = AbortSignal.any([this.#signal, this.#running.signal]);
    try {
      await work(signal);
    } catch (error) {
      if (!signal.aborted) throw error;
    }
  }
}
