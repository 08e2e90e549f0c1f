// The end of the shelf: more comes as it is scrolled near, or by a button.

import { html } from "../vendor/lit-html.js";
import { many } from "../shared/words.js";

const NEAR = "1200px 0px"; // from the end to where more is asked for

/** Draw it; `more` asks for the next page. */
export function ending(shelf, more) {
  if (shelf.problem) {
    return html`<p class="end" role="alert">${shelf.problem.message} <button @click=${more}>Try again</button></p>`;
  }
  if (!shelf.done) return html`<p class="end"><button @click=${more} aria-disabled=${Boolean(shelf.loading)}>${shelf.loading ? "Loading…" : "Show more"}</button></p>`;
  return shelf.items.length ? html`<p class="end soft">${shelf.items.length > 1 ? `These are all ${many(shelf.items.length, "shape")}.` : ""}</p>` : "";
}

/** Return a function to call after each drawing: `near` is called where the end is near then, or comes near later. */
export function watchEnd(root, near, signal) {
  // a busy browser tells several things at once, oldest first: what counts is where the end is now
  const watcher = new IntersectionObserver((told) => told.at(-1).isIntersecting && near(), { rootMargin: NEAR });
  signal.addEventListener("abort", () => watcher.disconnect());
  return () => {
    watcher.disconnect(); // watching anew tells where the end is now
    const end = root.querySelector(".end");
    if (end && !signal.aborted) watcher.observe(end);
  };
}
