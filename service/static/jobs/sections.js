// What runs, waits and failed, as lists.

import { html, nothing, repeat } from "../vendor/lit-html.js";
import { count, many, size, when } from "../shared/words.js";

const TITLES = { processing: "Running", queued: "Waiting", failed: "Failed" };

/**
 * Draw a list, unless it is empty.
 *
 * @param {string} status
 * @param {{items: object[], cursor: string?}} list
 * @param {number} total - as the queue has it
 * @param {{more: (status: string) => void, retry: (shape: object) => void, refused: {id: string, problem: Error}?}} on
 * @param {object} head - what stands beside the title
 */
export function section(status, list, total, on, head = nothing) {
  if (!total && !list.items.length) return nothing;
  return html`<section aria-labelledby="jobs-${status}">
    <div class="row beside"><h2 id="jobs-${status}" tabindex="-1">${TITLES[status]} <span class="soft">${count(total)}</span></h2>${head}</div>
    ${list.items.length ? html`<ul class="jobs">${repeat(list.items, ({ id }) => id, (shape) => row(shape, on))}</ul>` : nothing}
    ${list.cursor ? html`<p><button @click=${() => on.more(status)}>Show more<span class="unseen"> (${TITLES[status]})</span></button></p>` : nothing}
  </section>`;
}

function row(shape, on) {
  const bytes = shape.files.reduce((sum, file) => sum + file.size, 0);
  return html`<li class="job ${shape.status}">
    <div>
      <a href="#/shapes/${encodeURIComponent(shape.id)}/details">${shape.name}</a>
      ${shape.error ? reason(shape.error) : nothing}
      ${on.refused?.id === shape.id ? html`<p role="alert">${on.refused.problem.message} <small><code>${on.refused.problem.code}</code></small></p>` : nothing}
      <small>${size(bytes)} in ${many(shape.files.length, "file")}; added on ${when(shape.created_at)}</small>
    </div>
    ${shape.status === "failed" ? html`<button @click=${() => on.retry(shape)}>Try again<span class="unseen"> (${shape.name})</span></button>` : nothing}
  </li>`;
}

function reason({ code, detail }) {
  return html`<p>${detail} <small><code>${code}</code></small></p>`;
}
