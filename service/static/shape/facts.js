// What is known of a mesh and of its metadata, as people say it. No page in here: pairs of texts.

import { count } from "../shared/words.js";

const COLOURS = {
  texture: "from an image (texture)",
  vertex: "from its vertices",
  face: "from its faces",
  material: "from its materials",
  none: "it has none; it is compared by its form",
};

/** Pairs of what it is called and what it is. */
export function meshFacts(mesh) {
  return [
    ["Vertices", count(mesh.vertices)],
    ["Faces", count(mesh.faces)],
    ["Pieces", mesh.components === 1 ? "one" : count(mesh.components)],
    ["Surface", `${mesh.area.toLocaleString("en-GB", { maximumSignificantDigits: 3 })} in the file's own unit, squared`],
    ["Colours", COLOURS[mesh.colour] ?? mesh.colour],
  ];
}

/** Pairs of a metadata's name and its value as text; tags are shown elsewhere. */
export function metadataRows(metadata) {
  return Object.entries(metadata).filter(([name]) => name !== "tags").map(([name, value]) => [name, asText(value)]);
}

function asText(value) {
  if (value === null || value === "") return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value) && value.every((one) => typeof one !== "object")) return value.map(asText).join(", ");
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}
