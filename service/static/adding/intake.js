// What comes in, by whatever way, becomes uploads; what does not is told.

import { many } from "../shared/words.js";
import { remember } from "./answering.js";
import { chooseOne } from "./choosing.js";
import { startFollowing } from "./following.js";
import { meshesOf, poolOf } from "./grouping.js";
import { baseOf, kindOf } from "./kinds.js";
import { mendWaiting, mendWith } from "./mending.js";
import { startPanel } from "./panel.js";
import { enqueue } from "./queue.js";
import { addUpload, note, uploads } from "./uploads.js";

const NAMED = 3; // names in a note

/**
 * Take in what was gathered.
 *
 * @param {import("./gathering.js").Gathered} gathered
 * @param {"add" | "find" | number} purpose - a number: of the upload whose missing file it is
 */
export async function take(gathered, purpose) {
  startPanel();
  startFollowing();
  tellLeftOut(gathered);
  const mended = uploads().find(({ number }) => number === purpose);
  const meshes = meshesOf(gathered.files);
  if (mended) await mendWith(mended, poolOf(gathered.files).files);
  else if (!meshes.length) await takeWithoutMesh(gathered.files);
  else if (purpose === "find") await ask(meshes, poolOf(gathered.files));
  else await add(meshes, poolOf(gathered.files));
}

async function add(meshes, pool) {
  const used = new Set();
  const added = meshes.map((mesh) => addUpload("add", mesh, pool));
  for (const upload of added) {
    await upload.gather();
    upload.files.forEach(({ file }) => used.add(file));
    enqueue(upload);
  }
  tellUnused(pool.files.filter(({ file }) => !used.has(file)), "names");
}

async function ask(meshes, pool) {
  const mesh = meshes.length === 1 ? meshes[0] : await chooseOne(meshes);
  if (!mesh) return;
  const upload = addUpload("find", mesh, pool);
  remember(upload);
  await upload.gather();
  enqueue(upload);
}

/** Materials and images alone may be what a refused upload waits for. */
async function takeWithoutMesh(files) {
  if (!files.length) return;
  const helped = await mendWaiting(poolOf(files).files);
  if (helped.size) tellUnused(files.filter(({ file }) => !helped.has(file)), "waits for");
  else note(`There is no mesh in it, only ${namesOf(files)}. Add a .ply, an .obj with its files, or a zip.`);
}

function tellLeftOut({ hidden, unreadable, files }) {
  if (hidden) note(`${leftOut(hidden)}: systems add such by themselves.`);
  const lost = unreadable.map((path) => ({ path }));
  if (lost.length) note(`${many(lost.length, "file")} could not be read: ${namesOf(lost)}.`);
  if (!hidden && !unreadable.length && !files.length) note("There is no file in it.");
}

/** @param {string} verb - what no mesh does with them */
function tellUnused(files, verb) {
  const others = files.filter(({ path }) => kindOf(path) === "other");
  const unused = files.filter(({ path }) => kindOf(path) !== "other");
  if (unused.length) note(`${leftOut(unused.length)}, which no mesh ${verb} for its colours: ${namesOf(unused)}.`);
  if (others.length) note(`${leftOut(others.length)}, of other kinds: ${namesOf(others)}.`);
}

const leftOut = (number) => `${many(number, "file")} left out`;

function namesOf(files) {
  const names = files.slice(0, NAMED).map(({ path }) => baseOf(path)).join(", ");
  return files.length > NAMED ? `${names} and ${many(files.length - NAMED, "other")}` : names;
}
