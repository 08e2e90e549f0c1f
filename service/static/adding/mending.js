// A refused upload goes on: with a file that was missing, without its texture, or simply again.

import { baseOf } from "./kinds.js";
import { Pool } from "./pool.js";
import { enqueue } from "./queue.js";
import { remediesOf } from "./refusals.js";
import { change, uploads } from "./uploads.js";

/**
 * Add files to a refused upload; what was sent before is sent again with them.
 *
 * @param {object} upload
 * @param {import("./gathering.js").Sent[]} files
 * @returns {Promise<boolean>} whether the mesh uses one of them
 */
export async function mend(upload, files) {
  const before = new Set(upload.files.map(({ file }) => file));
  const names = new Set(files.map(({ path }) => baseOf(path).toLowerCase()));
  // what has a name again is replaced
  const kept = upload.pool.files.filter(({ path }) => !names.has(baseOf(path).toLowerCase()));
  upload.pool = new Pool([...kept, ...files]);
  await upload.gather();
  const helped = upload.files.some(({ file }) => !before.has(file));
  if (helped) {
    change(upload, { note: "" });
    enqueue(upload);
  }
  return helped;
}

/** The same for files that somebody chose for this upload; where they do not help, its row says why. */
export async function mendWith(upload, files) {
  if (!files.length || (await mend(upload, files))) return;
  const names = files.slice(0, 3).map(({ path }) => `“${baseOf(path)}”`).join(", ");
  const advice = "Give the file the name that is asked for, or choose another.";
  change(upload, { note: `The mesh does not name ${names}. ${advice}` });
}

/** Add files to whatever waits for one of them. */
export async function mendWaiting(files) {
  const helped = new Set();
  for (const upload of uploads()) {
    if (upload.state !== "refused" || !remediesOf(upload).includes("file")) continue;
    if (await mend(upload, files)) upload.files.forEach(({ file }) => helped.add(file));
  }
  return helped;
}

export function withoutTexture(upload) {
  change(upload, { untextured: true, note: "" });
  enqueue(upload);
}

export function again(upload) {
  change(upload, { broken: 0, note: "" });
  enqueue(upload);
}
