// Jobs: what runs, waits and failed, and how fast it goes.

import { html, nothing, render } from "../vendor/lit-html.js";
import { path, read } from "../shared/api.js";
import { listen } from "../shared/live.js";
import { many } from "../shared/words.js";
import { Actions } from "./actions.js";
import { STATUSES, doubtful, gone, moved } from "./lists.js";
import { readQueue, watchQueue } from "./queue.js";
import { section } from "./sections.js";
import { renewalOf, speedOf, stallOf, workOf } from "./sentences.js";

const PAGE = 30; // shapes of a list, asked for at once

export async function showJobs({ root, signal }) {
  document.title = "Jobs · Faience";
  const state = { queue: null, problem: null, lists: unread(), retrying: null, refused: null };
  let asked = 0;
  const draw = () => {
    asked ||= requestAnimationFrame(() => { // many shapes may change at once
      asked = 0;
      if (state.queue && !signal.aborted) render(page(state, actions), root);
    });
  };
  const readList = async (status, cursor) => {
    const { items, next_cursor } = await read(path(["shapes"], { status, limit: PAGE, cursor }), { signal });
    const before = cursor ? state.lists[status].items.filter((old) => !items.some(({ id }) => id === old.id)) : [];
    state.lists = { ...state.lists, [status]: { items: [...before, ...items], cursor: next_cursor } };
    draw();
  };
  const actions = new Actions({ state, draw, readList, root, signal });
  listen(({ shape, removed }) => {
    state.lists = shape ? moved(state.lists, shape) : gone(state.lists, removed);
    draw();
  }, signal);
  state.queue = await readQueue(signal);
  await Promise.all(STATUSES.map((status) => readList(status)));
  watchQueue(({ queue, problem = null }) => {
    Object.assign(state, { problem, queue: queue ?? state.queue });
    if (queue) for (const status of doubtful(state.lists, queue)) readList(status).catch(() => {}); // the next look tells why
    draw();
  }, signal);
}

const unread = () => Object.fromEntries(STATUSES.map((status) => [status, { items: [], cursor: null }]));

function page(state, actions) {
  const { queue, lists, problem, retrying, refused } = state;
  const idle = !queue.queued && !queue.processing;
  return html`<h1 id="jobs" tabindex="-1">Jobs</h1>
    ${problem ? html`<p role="alert">${problem.message} <small>It is asked again every other second.</small></p>` : nothing}
    <p class="work">${workOf(queue)} ${idle ? html`Drop meshes anywhere on this page to add them to the library.` : nothing}</p>
    ${queue.renewal ? html`<p class="renewal">${renewalOf(queue)}</p>` : nothing}
    <p class="soft">${speedOf(queue)}</p>
    ${stall(stallOf(queue))}
    ${queue.workers.length ? html`<ul class="workers" aria-label="Workers">${queue.workers.map(({ name, jobs }) => html`<li><strong>${name}</strong> holds ${many(jobs, "job")}</li>`)}</ul>` : nothing}
    ${STATUSES.map((status) => section(status, lists[status], queue[status], { refused, ...actions }, status === "failed" ? all(retrying, actions) : nothing))}`;
}

const stall = (words) => (words ? html`<p class="stall">${words}</p>` : nothing);

/** The button that tries all again, or how far that is. */
function all(retrying, actions) {
  if (!retrying) return html`<button @click=${actions.retryAll}>Try all again</button>`;
  const { done, of, problem } = retrying;
  if (problem) return html`<span role="alert">${problem.message} <small><code>${problem.code}</code></small></span> <button @click=${actions.retryAll}>Try all again</button>`;
  return html`<progress aria-label="Tried again" max=${Math.max(of, done)} value=${done}></progress> <span>${done} of ${many(Math.max(of, done), "shape")} tried again</span>
    <button @click=${actions.stop}>Stop</button>`;
}
