// What becomes of shapes that were added, as it happens.

import { path, read, request } from "../shared/api.js";
import { listen } from "../shared/live.js";
import { FOLLOWED, change, isListed, uploads } from "./uploads.js";

const followed = new Map(); // the uploads of each shape, by its id: the same file may be added twice

/** Hear of changes before a mesh is sent, so that none is missed. Said again, it opens a stream that was refused. */
export const startFollowing = () => listen(hear, undefined, { onOpen: lookAgain });

/**
 * Follow a shape from now on.
 *
 * @param {object} upload
 * @param {object} shape - as the service answered
 * @param {boolean} known - the library had it already
 */
export function follow(upload, shape, known) {
  const before = upload.shape;
  if (before?.status === "failed" && before.id !== shape.id) forgetFailed(before.id);
  followed.set(shape.id, (followed.get(shape.id) ?? new Set()).add(upload));
  if (known && shape.status !== "failed") change(upload, { state: "known", shape });
  else apply(upload, shape);
  if (FOLLOWED.has(upload.state)) look(upload); // it may have changed between the answer and here
}

/** What failed for want of a file is replaced by what came with it. */
function forgetFailed(id) {
  followed.delete(id);
  request(path(["shapes", id]), { method: "DELETE" }).catch(() => {}); // it stays on the list of what failed
}

function hear({ shape, removed }) {
  for (const upload of followed.get(shape?.id ?? removed) ?? []) {
    if (!isListed(upload)) followed.get(shape?.id ?? removed).delete(upload);
    else if (removed) change(upload, { state: "removed" });
    else if (upload.state === "known") change(upload, { shape });
    else apply(upload, shape);
  }
}

function apply(upload, shape) {
  const news = { state: shape.status, shape, name: shape.name };
  if (shape.status === "failed") change(upload, { ...news, state: "refused", problem: problemOf(shape) });
  else change(upload, news);
}

const problemOf = ({ error }) => ({ code: error.code, message: error.detail, status: 422 });

async function look(upload) {
  try {
    const shape = await read(path(["shapes", upload.shape.id]));
    if (FOLLOWED.has(upload.state)) hear({ shape });
  } catch (problem) {
    if (problem.status === 404) change(upload, { state: "removed" });
  }
}

/** After the stream was cut: ask for those that may have changed meanwhile, one after the other. */
async function lookAgain() {
  for (const upload of uploads()) if (FOLLOWED.has(upload.state)) await look(upload);
}
