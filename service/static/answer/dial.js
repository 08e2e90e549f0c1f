// The dial between geometry and colour: what it asks the service for, and how it is called.

import { isDefault } from "./asked.js";

/** How much a block counts, against its own weight: at both ends only what looks at one thing alone. */
const FACTORS = {
  geometry: (share) => 2 * (1 - share),
  colour: (share) => 2 * share,
  both: (share) => 1 - Math.abs(2 * share - 1),
};

/**
 * Say which parameters of the interface rank as asked.
 *
 * @param {{method: string, colour: number}} asked
 * @param {Array<{name: string, default: boolean, blocks: Array<{name: string, weight: number, looks_at: string}>}>} methods
 * @returns {{method?: string, weights?: string}} nothing for the default method
 */
export function parametersOf(asked, methods) {
  if (isDefault(asked)) return {};
  if (asked.method) return { method: asked.method };
  const { name, blocks } = methods.find((method) => method.default);
  const weighed = blocks.map((block) => `${block.name}:${round(block.weight * FACTORS[block.looks_at](asked.colour / 100))}`);
  return { method: name, weights: weighed.join(",") };
}

const round = (number) => Number(number.toPrecision(6));

/** Say a place of the dial. */
export function wordsFor(colour) {
  if (colour <= 0) return "Geometry alone";
  if (colour >= 100) return "Colour alone";
  if (colour === 50) return "Geometry and colour alike";
  if (colour < 25) return "Mostly geometry";
  if (colour > 75) return "Mostly colour";
  return colour < 50 ? "Geometry more than colour" : "Colour more than geometry";
}
