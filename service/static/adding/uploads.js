// The uploads of this visit, and who watches them. Nothing here draws or sends.

import { fromCommonFolder, together } from "./grouping.js";
import { stemOf } from "./kinds.js";

/** States in which the browser still holds something that the service does not. */
export const UNSENT = new Set(["waiting", "sending", "describing"]);
/** States in which the service goes on by itself. */
export const FOLLOWED = new Set(["queued", "processing"]);

const all = new Map();
const watchers = new Set();
let notes = [];
let last = 0;

/** One mesh on its way, to be added or only to be asked about. */
class Upload {
  constructor(purpose, mesh, pool) {
    this.number = last += 1;
    this.purpose = purpose; // "add" or "find"
    this.mesh = mesh;
    this.pool = pool; // what it may bring along
    this.files = [mesh];
    this.name = stemOf(mesh.path);
    // waiting, sending, describing (of a question), queued, processing, ready, known, answered, refused, removed
    this.state = "waiting";
    this.sent = 0; // share of its bytes
    this.untextured = false; // may go without its texture
    this.broken = 0; // connections that broke while it was sent
    this.shape = null; // what became of it in the library
    this.problem = null; // why it is refused
    this.results = null; // of a question whose answer could not be kept
    this.query = null; // of a question whose answer is kept
    this.note = ""; // what else its row says
    this.changed = 0; // grows with every change of state
  }

  /** Look what it brings along; one that cannot be read is found out when it is sent. */
  async gather() {
    this.files = fromCommonFolder(await together(this.mesh, this.pool).catch(() => [this.mesh]));
  }
}

let changes = 0;

/** @returns {Upload} */
export function addUpload(purpose, mesh, pool) {
  const upload = new Upload(purpose, mesh, pool);
  all.set(upload.number, upload);
  change(upload, { state: "waiting" });
  return upload;
}

/** Change what is known of an upload, and tell. */
export function change(upload, news) {
  if (news.state && news.state !== upload.state) upload.changed = changes += 1;
  Object.assign(upload, news);
  tell();
}

/** Take an upload off the list. */
export function drop(upload) {
  all.delete(upload.number);
  tell();
}

/** Take off what needs nobody any more. */
export function clearFinished() {
  for (const upload of all.values()) if (isFinished(upload)) all.delete(upload.number);
  notes = [];
  tell();
}

export const isFinished = ({ state }) => !UNSENT.has(state) && !FOLLOWED.has(state) && state !== "refused";
export const uploads = () => [...all.values()];
export const isListed = (upload) => all.has(upload.number);

/** Say something about a whole drop. */
export function note(text) {
  notes = [...notes, text];
  tell();
}
export const allNotes = () => notes;

/** Hear that something changed. */
export const watch = (watcher) => watchers.add(watcher);

export function tell() {
  for (const watcher of watchers) watcher();
}
