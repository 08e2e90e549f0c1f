// Which files are sent together: each mesh with the materials and images that its colours need, and nothing else.
//
// The same rule as `faience index` follows (service/commands/companions.py), so that a mesh has the same content, and
// is known again, however it was added.

import { folderOf, kindOf } from "./kinds.js";
import { imagesByMaterial, libraryNames } from "./materials.js";
import { Pool } from "./pool.js";
import { scanObj, scanPly } from "./scanning.js";

/** @typedef {import("./gathering.js").Sent} Sent */

/** @param {Sent[]} files @returns {Sent[]} what becomes an upload each: meshes and zips */
export const meshesOf = (files) => files.filter(({ path }) => ["mesh", "zip"].includes(kindOf(path)));

/** @param {Sent[]} files @returns {Pool} what meshes can bring along */
export const poolOf = (files) => new Pool(files.filter(({ path }) => !["mesh", "zip"].includes(kindOf(path))));

/**
 * List a mesh and what it brings along.
 *
 * @param {Sent} mesh
 * @param {Pool} pool
 * @returns {Promise<Sent[]>} the mesh first
 */
export async function together(mesh, pool) {
  if (!pool.files.length || kindOf(mesh.path) === "zip") return [mesh];
  const obj = mesh.path.toLowerCase().endsWith(".obj");
  const found = obj ? await companionsOfObj(mesh, pool) : await companionsOfPly(mesh, pool);
  return [mesh, ...new Set(found.filter(Boolean))];
}

async function companionsOfPly(mesh, pool) {
  return (await scanPly(mesh.file)).map((name) => pool.find(name, mesh.path));
}

async function companionsOfObj(mesh, pool) {
  if (!pool.files.some(({ path }) => kindOf(path) !== "image")) return []; // images are named by material files
  const { libraries, materials } = await scanned(mesh.file);
  const names = libraries.flatMap((rest) => libraryNames(rest, (name) => pool.find(name, mesh.path) !== undefined));
  const found = [...new Set(names.map((name) => pool.find(name, mesh.path)).filter(Boolean))];
  const images = new Map();
  for (const library of found) {
    for (const [material, image] of imagesByMaterial(await library.file.arrayBuffer())) {
      if (!materials.has(material) || images.has(material)) continue;
      images.set(material, image && pool.find(image, library.path));
    }
  }
  return [...found, ...images.values()];
}

const scans = new WeakMap(); // a mesh that waits for an image is not read again for each that comes
function scanned(file) {
  if (!scans.has(file)) scans.set(file, scanObj(file));
  return scans.get(file);
}

/**
 * Name files from the deepest folder that holds them all.
 *
 * @param {Sent[]} files
 * @returns {Sent[]}
 */
export function fromCommonFolder(files) {
  const folders = files.map(({ path }) => folderOf(path).split("/"));
  let depth = 0;
  while (folders.every((parts) => parts[depth] && parts[depth] === folders[0][depth])) depth += 1;
  return files.map(({ path, file }) => ({ path: path.split("/").slice(depth).join("/"), file }));
}
