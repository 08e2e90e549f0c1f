// The others by rank: how far each is, and what it is to the query.

import { html, repeat } from "../vendor/lit-html.js";
import { bar, short } from "../shared/measures.js";
import { picture } from "../shared/picture.js";
import { evidence, relationName } from "../shared/relation.js";
import { count } from "../shared/words.js";
import { isDefault } from "./asked.js";

const SIZES = "(max-width: 30rem) 42vw, 9.5rem"; // of a picture, see styles/answer.css
const AT_ONCE = 12; // pictures that are in view at first

/** Draw the ranked answer, or why there is none. */
export function results(answer) {
  const { ranked, refusal } = answer;
  if (refusal) return html`<p role="alert">${refusal.message} <small>(${refusal.code})</small></p>`;
  if (!ranked) return html`<p class="soft">Comparing…</p>`;
  if (!ranked.results.length && !ranked.partly) return html`<p>There is nothing to compare with yet: the library holds no other shape. <a href="#/">Add some</a></p>`;
  const farthest = Math.max(...ranked.results.map(({ distance }) => distance));
  return html`${partly(ranked)}<ol class="cards results">${repeat(ranked.results, ({ shape }) => shape.id,
      (result, place) => card(answer, result, place, farthest))}</ol>
    ${answer.hasMore() ? html`<p><button @click=${() => answer.more()}>Show more</button></p>`
      : html`<p class="soft">${ending(ranked.results.length)}</p>`}`;
}

const ending = (number) => number >= 1000 ? `The nearest ${count(number)} are shown.` : "These are all the others.";

/** What an answer leaves out while a new version describes all shapes anew. */
const partly = ({ partly: renewal }) => renewal ? html`<p role="status">A new version describes all shapes anew. This was compared with the
    ${count(renewal.done)} of ${count(renewal.total)} that are done; ask again later for the others.</p>` : "";

function card(answer, { rank, distance, shape, relation }, place, farthest) {
  return html`<li class="result">
    <button class="look" @click=${() => answer.look(place)} aria-label="${rank}. ${shape.name}: compare in 3D">
      <span class="rank">${rank}</span>
      <span class="frame">${picture(`/v1/shapes/${encodeURIComponent(shape.id)}`, SIZES, place < AT_ONCE)}</span>
      <span class="name">${shape.name}</span>
    </button>
    <span class="distance" title="Distance; the longest bar is the farthest shown">
      ${bar(farthest ? distance / farthest : 0)}<span class="unseen">Distance </span>${short(distance)}</span>
    ${isDefault(answer.asked) ? html`<span class="relation">${relation ? related(relation, shape.id) : ""}</span>` : ""}
    <a href=${answer.addressOf(shape.id)} aria-label="What is similar to ${shape.name}">Similar to this</a>
  </li>`;
}

/** The relation; its evidence where somebody asks. */
const related = (relation, id) => html`
  <button class="plain ${relation.name}" popovertarget="evidence-${id}" aria-label="${relationName(relation)}: why">${relationName(relation)}</button>
  <div id="evidence-${id}" class="evidence" popover>${evidence(relation)}</div>`;
