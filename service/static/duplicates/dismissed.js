// Pairs that somebody dismissed, with pictures, and how to take that back.

import { html, nothing } from "../vendor/lit-html.js";
import { Problem, path, read } from "../shared/api.js";
import { portrait } from "../shared/portrait.js";
import { when } from "../shared/words.js";

const PAGE = 12; // pairs; each takes two more questions

/** The dismissed pairs that were read so far. */
export class Dismissed {
  pairs = null; // {one, other, created_at}, with shapes for ids; null before they were asked for
  cursor = null;

  /** Read the first page, or the next. */
  async read(signal, { next = false } = {}) {
    const page = await read(path(["duplicates", "dismissals"], { limit: PAGE, cursor: next ? this.cursor : null }), { signal });
    const found = await Promise.all(page.items.map((item) => withShapes(item, signal)));
    this.pairs = [...(next ? this.pairs : []), ...found.filter(Boolean)];
    this.cursor = page.next_cursor;
  }
}

async function withShapes({ one, other, created_at }, signal) {
  try {
    const shapes = await Promise.all([one, other].map((id) => read(path(["shapes", id]), { signal })));
    return { one: shapes[0], other: shapes[1], created_at };
  } catch (error) {
    if (error instanceof Problem && error.status === 404) return null; // removed in this moment, and the dismissal with it
    throw error;
  }
}

/**
 * Draw them.
 *
 * @param {Dismissed} dismissed
 * @param {{one: object, other: object, back: boolean}?} takenBack - the pair that was last taken back, and whether it is
 *   shown above again
 * @param {{open: Function, more: Function, takeBack: Function}} on
 */
export function dismissedView(dismissed, takenBack, on) {
  return html`<section class="dismissed" aria-labelledby="dismissed">
    <h2 id="dismissed">Dismissed</h2>
    <details @toggle=${(event) => event.target.open && on.open()}>
      <summary>Pairs that somebody called no duplicates</summary>
      ${takenBack ? takenBackView(takenBack, on) : nothing}
      ${dismissed.pairs === null ? html`<p>Reading…</p>` : list(dismissed, on)}
    </details>
  </section>`;
}

function list({ pairs, cursor }, on) {
  if (!pairs.length) return html`<p>Nobody has dismissed a pair. What you call “Not a duplicate” is kept here, and can be taken back.</p>`;
  return html`<ul class="pairs">${pairs.map((pair) => pairView(pair, on))}</ul>
    ${cursor ? html`<p><button @click=${on.more}>Show more</button></p>` : nothing}`;
}

function pairView(pair, on) {
  const { one, other } = pair;
  return html`<li>
    ${[one, other].map((shape) => html`<a href="#/shapes/${encodeURIComponent(shape.id)}/details" title=${shape.name}>
      ${portrait(shape, "6rem")}<span class="name">${shape.name}</span></a>`)}
    <div><small>Dismissed on ${when(pair.created_at)}</small>
      <button @click=${() => on.takeBack(pair)}>Take back<span class="unseen"> (${one.name} and ${other.name})</span></button></div>
  </li>`;
}

function takenBackView({ one, other, back }, on) {
  return html`<p class="decision row" id="taken-back" tabindex="-1"><span>“${one.name}” and “${other.name}” may be in a group again${back ? ": they are shown above." : "."}</span>
    ${back ? nothing : html`<button @click=${on.again}>Look again</button>`}</p>`;
}
