// Why two shapes differ: what the colours of the picture mean, and how much each thing counts.

import { html } from "../vendor/lit-html.js";
import { bar } from "../shared/measures.js";
import { capital } from "../shared/words.js";

const NAMES = {
  "log-hks": "shape",
  "colour-histogram": "colours",
  "colour-curves": "where the colours are",
  "hks-0": "shape",
  "hks-0.05": "shape with some colour",
  "hks-0.1": "shape with more colour",
};

const percent = (share) => (share > 0 && share < 0.01 ? "under 1%" : `${Math.round(100 * share)}%`);

/** Share of the whole difference that is nowhere in the picture. */
export const unplaced = (blocks) => blocks.reduce((sum, { share, placed }) => sum + share * (1 - placed), 0);

/**
 * Draw an explanation.
 *
 * @param {{distance: number, blocks: Array<{name: string, share: number, placed: number}>}} explained
 * @param {boolean} refined - whether the ranking has a second stage, which is not in the picture
 */
export function explanation({ distance, blocks }, refined) {
  const counted = [...blocks].sort((one, other) => other.share - one.share);
  return html`
    <div class="legend"><span>no difference</span><span class="scale"></span><span>differs most</span></div>
    ${distance > 0 ? html`<ul class="shares" aria-label="What the difference consists of">${counted.map(share)}</ul>` : html`<p>Nothing that is compared differs.</p>`}
    ${omitted(unplaced(blocks), refined)}`;
}

const share = (block) => html`<li><span>${capital(NAMES[block.name] ?? block.name)}</span>${bar(block.share)}<span>${percent(block.share)}</span></li>`;

function omitted(nowhere, refined) {
  const told = [];
  if (nowhere >= 0.005) told.push(`${percent(nowhere)} of the difference belongs to no place on the surfaces.`);
  if (refined) told.push("The second, closer look of the ranking is not in this picture.");
  return told.length ? html`<p class="soft">${told.join(" ")}</p>` : "";
}
