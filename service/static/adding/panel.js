// The dock of uploads at the foot of the page; it stays while views change.

import { html, render, repeat } from "../vendor/lit-html.js";
import { say } from "../shared/said.js";
import { count, many } from "../shared/words.js";
import { exchangeKey } from "../shared/key.js";
import { goOn, hold } from "./queue.js";
import { inWords, remediesOf } from "./refusals.js";
import { row } from "./row.js";
import { FOLLOWED, UNSENT, allNotes, clearFinished, isFinished, uploads, watch } from "./uploads.js";

const MOST = 50; // rows of refused uploads, and of others
const EVERY = 80; // milliseconds between two drawings
const dock = document.getElementById("adding");
let folded = false, started = false, drawing, said = "";

/** Show the dock as soon as there is something in it. */
export function startPanel() {
  if (started) return;
  started = true;
  watch(() => (drawing ??= setTimeout(draw, EVERY)));
  window.addEventListener("beforeunload", (event) => {
    if (uploads().some(({ state }) => UNSENT.has(state))) event.preventDefault(); // the browser asks
  });
}

function draw() {
  drawing = undefined;
  const all = uploads();
  const focused = dock.contains(document.activeElement);
  dock.hidden = !all.length && !allNotes().length;
  render(dock.hidden ? "" : content(all), dock);
  document.body.classList.toggle("docked", !dock.hidden);
  if (focused && document.activeElement === document.body) dock.querySelector(".fold")?.focus(); // what had it is gone
  announce(all);
  if (hold?.until) drawing = setTimeout(draw, 1000); // it counts down
}

function content(all) {
  return html`<div class="head">
      <h2><button class="fold" aria-expanded=${!folded} aria-controls="uploads" @click=${fold}>
        <span class="unseen">Uploads: </span>${summary(all)}</button></h2>
      ${all.some(isFinished) || allNotes().length ? html`<button @click=${clearFinished}>Clear finished</button>` : ""}
    </div>
    ${overall(all)}
    <div id="uploads" tabindex="0" role="group" aria-label="Uploads" ?hidden=${folded}>
      ${hold ? holding() : ""}
      ${allNotes().map((text) => html`<p class="note">${text}</p>`)}
      ${rows(all)}
    </div>`;
}

function fold() {
  folded = !folded;
  draw();
}

/** "12 of 40 ready, 2 refused". */
function summary(all) {
  if (!all.length) return "Nothing was added";
  const done = all.filter(isFinished).length;
  const refused = all.filter(({ state }) => state === "refused").length;
  const only = all.every(({ purpose }) => purpose === "find");
  const failed = refused ? `, ${count(refused)} refused` : "";
  return `${count(done)} of ${count(all.length)} ${only ? "compared" : "ready"}${failed}`;
}

function overall(all) {
  const done = all.filter(({ state }) => !UNSENT.has(state) && !FOLLOWED.has(state)).length;
  if (all.length < 2 || done === all.length) return "";
  return html`<progress class="overall" max=${all.length} .value=${done} aria-label="All uploads"></progress>`;
}

/** Those refused first, what can be mended here before what cannot, then those that changed last. */
function rows(all) {
  const refused = all.filter(({ state }) => state === "refused")
    .sort((one, other) => remediesOf(other).length - remediesOf(one).length);
  const others = all.filter(({ state }) => state !== "refused").sort((one, other) => other.changed - one.changed);
  const shown = [...refused.slice(0, MOST), ...others.slice(0, MOST).sort((one, other) => other.number - one.number)];
  return html`<ul>${repeat(shown, ({ number }) => number, row)}</ul>
    ${shown.length < all.length ? html`<p class="note">and ${many(all.length - shown.length, "other")}</p>` : ""}`;
}

function holding() {
  const { problem, until } = hold;
  const { title, action } = inWords(problem);
  const seconds = Math.max(Math.ceil((until - Date.now()) / 1000), 0);
  const key = ["unauthorised", "read_only_key"].includes(problem.code);
  // of keys the service tells how programs send them
  const more = until ? `Next try in ${seconds} s.` : key ? "" : problem.message;
  return html`<div class="note why">
    <p><strong>${title}.</strong> ${action} ${more} <code>${problem.code}</code></p>
    <p class="row">
      ${key ? html`<button @click=${exchangeKey}>Enter a key</button>` : ""}
      <button class="strong" @click=${goOn}>${until ? "Try now" : "Go on"}</button>
    </p>
  </div>`;
}

/** Tell those who listen: each refusal, why all wait, and the end. */
function announce(all) {
  const refused = all.filter(({ state }) => state === "refused");
  const busy = all.some(({ state }) => UNSENT.has(state) || FOLLOWED.has(state));
  const text = hold ? inWords(hold.problem).title
    : refused.length ? `${refused.at(-1).name} is refused: ${inWords(refused.at(-1).problem).title}`
    : all.length && !busy ? summary(all) : allNotes().at(-1) ?? "";
  if (text && text !== said) say(text);
  said = text;
}
