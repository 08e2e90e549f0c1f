// One upload as a row: its name, how far it is, and what can be done where it is refused.

import { html, nothing } from "../vendor/lit-html.js";
import { picture } from "../shared/picture.js";
import { addressOf } from "./answering.js";
import { again, mendWith, withoutTexture } from "./mending.js";
import { chooseFiles } from "./picking.js";
import { poolOf } from "./grouping.js";
import { cancel } from "./queue.js";
import { actionOf, inWords, remediesOf } from "./refusals.js";
import { FOLLOWED, UNSENT } from "./uploads.js";

const STATES = {
  waiting: "waiting to be sent",
  describing: "being described, then compared",
  queued: "waiting to be described",
  processing: "being described",
  ready: "ready",
  known: "already in the library",
  removed: "removed from the library",
  answered: "compared with the library",
};

/** Draw an upload. */
export function row(upload) {
  const mendable = upload.state === "refused" && remediesOf(upload).includes("file");
  return html`<li class="upload ${upload.state}" data-number=${mendable ? upload.number : nothing}>
    <span class="thumb">${sight(upload)}</span>
    <div class="told">
      <p class="name">${titleOf(upload)}</p>
      ${upload.state === "refused" ? refusal(upload) : progress(upload)}
    </div>
    <button class="away" aria-label="${UNSENT.has(upload.state) ? "Cancel" : "Take off this list:"} ${upload.name}"
      @click=${() => cancel(upload)}>×</button>
  </li>`;
}

function sight({ state, shape }) {
  const there = shape?.status === "ready" && state !== "removed";
  if (there) return picture(`/v1/shapes/${encodeURIComponent(shape.id)}`, "3rem");
  return html`<span class="sign" aria-hidden="true">${{ refused: "!", answered: "≈" }[state] ?? ""}</span>`;
}

function titleOf({ name, shape, state }) {
  if (!shape || shape.status === "failed" || state === "removed") return html`<span>${name}</span>`;
  return html`<a href="#/shapes/${encodeURIComponent(shape.id)}">${name}</a>`;
}

function progress(upload) {
  const { state, sent, shape, name } = upload;
  if (state === "sending") {
    const share = Math.floor(100 * sent);
    return html`<progress max="100" .value=${share} aria-label="Sending ${name}"></progress><p>sending, ${share} %</p>`;
  }
  const goesOn = FOLLOWED.has(state) || state === "describing";
  const busy = goesOn ? html`<progress aria-label="${name}: ${STATES[state]}"></progress>` : "";
  const as = state === "known" && shape.name !== name ? ` as “${shape.name}”` : "";
  return html`${busy}<p>${STATES[state]}${as}</p>${answer(upload)}`;
}

/** The way to an answer; one that the service could not keep is told here. */
function answer(upload) {
  if (upload.state !== "answered") return "";
  if (upload.query !== null) return html`<p><a href=${addressOf(upload)}>See what is similar</a></p>`;
  if (!upload.results.length) return html`<p>There is nothing to compare it with yet.</p>`;
  const found = ({ id, name }) => html`<li><a href="#/shapes/${encodeURIComponent(id)}">${name}</a></li>`;
  return html`<p>The service could not keep the question (its disk may be full), so the answer is here:</p>
    <ol>${upload.results.map(({ shape }) => found(shape))}</ol>`;
}

function refusal(upload) {
  const { problem, note } = upload;
  return html`<p class="why"><strong>${inWords(problem).title}.</strong> ${problem.message}</p>
    <p>${actionOf(upload)} <code>${problem.code}</code></p>
    ${note ? html`<p class="why">${note}</p>` : ""}
    <p class="row">${remediesOf(upload).map((remedy) => BUTTONS[remedy](upload))}</p>`;
}

const BUTTONS = {
  file: (upload) => html`<button class="strong" @click=${() => addFile(upload)}>
    ${upload.problem.code.includes("image") ? "Add the mended image" : "Add the missing file"}</button>`,
  untextured: (upload) => html`<button @click=${() => withoutTexture(upload)}>
    ${upload.purpose === "find" ? "Compare" : "Add"} without its texture</button>`,
  again: (upload) => html`<button @click=${() => again(upload)}>Try again</button>`,
};

async function addFile(upload) {
  await mendWith(upload, poolOf((await chooseFiles()).files).files);
}
