// Work that many things ask for, done now and then.

/**
 * Return a function that does `work` at once, and again `pause` milliseconds later where it was asked for meanwhile.
 *
 * @param {() => void} work
 * @param {number} pause
 * @param {AbortSignal} signal - ends it
 */
export function soon(work, pause, signal) {
  let timer, wanted;
  const act = () => {
    wanted = false;
    timer = setTimeout(() => {
      timer = undefined;
      if (wanted && !signal.aborted) act();
    }, pause);
    work();
  };
  return () => {
    wanted = true;
    if (timer === undefined && !signal.aborted) act();
  };
}
