// Material files (.mtl): the image that each material lays over faces. Read as worker/reading/mtl.py reads them.

import { decoded } from "./scanning.js";

// options that may stand before or after the name of an image, and the most arguments of each
const OPTIONS = {
  "-blendu": 1, "-blendv": 1, "-boost": 1, "-bm": 1, "-cc": 1, "-clamp": 1, "-colorspace": 1, "-imfchan": 1,
  "-mm": 2, "-o": 3, "-s": 3, "-t": 3, "-texres": 1, "-type": 1,
};
const OPTIONAL = new Set(["-mm", "-o", "-s", "-t"]); // their second and third number may be left out
const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;
const isOption = (word) => Object.hasOwn(OPTIONS, word.toLowerCase());

/**
 * Read which image each material of a file names for its colour. Bumps, gloss and the like are no colour: the service
 * does not look at them.
 *
 * @param {ArrayBuffer} content
 * @returns {Map<string, string>} names of images by materials
 */
export function imagesByMaterial(content) {
  const images = new Map();
  let material = "", known = true; // what stands before the first newmtl belongs to none
  for (const line of decoded(content).split(/[\r\n]+/)) {
    const [, keyword, rest] = line.trim().match(/^(\S*)\s*(.*)$/);
    if (keyword.toLowerCase() === "newmtl") {
      material = rest;
      known = !rest || images.has(rest); // of two with one name the first counts
      if (!known) images.set(material, "");
    } else if (keyword.toLowerCase() === "map_kd" && rest && !known) images.set(material, imageOf(rest));
  }
  return images;
}

/** Read what stands after `map_Kd`: options, then a name that may hold blanks. */
export function imageOf(rest) {
  const words = [...rest.matchAll(/\S+/g)];
  const first = afterOptions(words.map((word) => word[0]));
  const following = words.findIndex((word, place) => place > first && isOption(word[0]));
  const last = words[(following < 0 ? words.length : following) - 1];
  return rest.slice(words[first].index, last.index + last[0].length).replace(/^"+|"+$/g, "");
}

/** The place of the first word of the name. */
function afterOptions(words) {
  let place = 0;
  while (place < words.length - 1 && isOption(words[place])) {
    const option = words[place].toLowerCase();
    place += 1;
    for (let taken = 0; taken < OPTIONS[option] && place < words.length - 1; taken += 1) {
      if (OPTIONAL.has(option) && !NUMBER.test(words[place])) break;
      place += 1;
    }
  }
  return place;
}

/**
 * Read the names after `mtllib`: one that may hold blanks, or several.
 *
 * @param {string} rest
 * @param {(name: string) => boolean} isThere
 */
export function libraryNames(rest, isThere) {
  const whole = rest.replaceAll("\\ ", " ").trim().replace(/^"+|"+$/g, "");
  if (!whole || isThere(whole)) return whole ? [whole] : [];
  return whole.split(/(?<=\.mtl)\s+/i);
}
