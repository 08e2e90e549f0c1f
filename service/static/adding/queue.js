// Uploads in line: at most three on their way, and all wait together while the service cannot take them.

import { Problem, path } from "../shared/api.js";
import { answered } from "./answering.js";
import { follow, startFollowing } from "./following.js";
import { formOf, send } from "./sending.js";
import { change, drop, isListed, tell } from "./uploads.js";

const AT_ONCE = 3;
const ADDING = path(["shapes"]);
const ASKING = path(["search"], { remember: true, limit: 12 });
const FIRST_WAIT = 2, LONGEST_WAIT = 30; // seconds
const TRIES = 3; // connections that may break over one upload while the service is there

const AWAY = new Set([0, 429, 502, 503, 504]); // comes back by itself
const FOR_ALL = new Set([401, 403, 507]); // whoever is next would hear the same
const BROKEN = new Set([400, 408]); // the body did not come through

const line = [];
const controllers = new Map();
let patience = FIRST_WAIT;
let timer;

/** Why nothing is sent at the moment: null, or the problem and until when (milliseconds; null: until somebody says). */
export let hold = null;

/** Put an upload into the line; questions come first, for somebody waits for them. */
export function enqueue(upload) {
  if (!isListed(upload)) return; // taken off while its files were looked through
  if (upload.purpose === "find") line.unshift(upload);
  else line.push(upload);
  change(upload, { state: "waiting", problem: null, sent: 0 });
  next();
}

/** Take an upload out of the line, or break off sending it. */
export function cancel(upload) {
  controllers.get(upload)?.abort();
  if (line.includes(upload)) line.splice(line.indexOf(upload), 1);
  drop(upload);
}

/** Go on at once. */
export function goOn() {
  clearTimeout(timer);
  hold = null;
  startFollowing(); // a stream that was refused for want of a key
  tell();
  next();
}

function next() {
  while (!hold && controllers.size < AT_ONCE && line.length) run(line.shift());
}

async function run(upload) {
  const controller = new AbortController();
  controllers.set(upload, controller);
  change(upload, { state: "sending", sent: 0 });
  try {
    const address = upload.purpose === "find" ? ASKING : ADDING;
    const onSent = (sent) => onProgress(upload, sent);
    accept(upload, await send(address, formOf(upload), { signal: controller.signal, onSent }));
  } catch (error) {
    if (error.name !== "AbortError") await react(upload, error);
  } finally {
    controllers.delete(upload);
    next();
  }
}

function onProgress(upload, sent) {
  const describing = sent === 1 && upload.purpose === "find";
  change(upload, { sent, ...(describing && { state: "describing" }) });
}

function accept(upload, { status, body }) {
  patience = FIRST_WAIT;
  if (upload.purpose === "find") {
    answered(upload, body);
    return;
  }
  // after a broken connection "known" may be what came through then
  follow(upload, body, status === 200 && !upload.broken);
}

/** Wait where the service comes back by itself, stop where somebody must act, refuse where this mesh is at fault. */
async function react(upload, error) {
  if (!(error instanceof Problem)) throw error;
  const problem = error.status === 0 || BROKEN.has(error.status) ? await whyBroken(upload, error) : error;
  if (!isListed(upload)) return;
  if (!AWAY.has(problem.status) && !FOR_ALL.has(problem.status)) {
    change(upload, { state: "refused", problem });
    return;
  }
  line.unshift(upload);
  change(upload, { state: "waiting", sent: 0 });
  if (FOR_ALL.has(problem.status)) stop(problem, null);
  else if (!hold) stop(problem, Date.now() + 1000 * (problem.wait ?? nextPatience()));
}

/** Tell a service that is away from a file that is gone and from a connection that always breaks. */
async function whyBroken(upload, error) {
  for (const { path: name, file } of upload.files) {
    if (!(await isReadable(file))) {
      const detail = `“${name}” cannot be read any more: it was moved or changed.`;
      return new Problem(-1, { code: "file_gone", detail });
    }
  }
  const there = await fetch("/livez").then((answer) => answer.ok, () => false);
  upload.broken += there ? 1 : 0;
  if (!there || upload.broken < TRIES) return new Problem(0, { detail: there ? "The connection broke." : undefined });
  if (error.status !== 0) return error;
  const detail = `The connection broke ${TRIES} times while this was sent.`;
  return new Problem(-1, { code: "broken_connection", detail });
}

const isReadable = (file) => file.slice(0, 1).arrayBuffer().then(() => true, () => false);

function nextPatience() {
  const wait = patience;
  patience = Math.min(2 * patience, LONGEST_WAIT);
  return wait;
}

function stop(problem, until) {
  clearTimeout(timer);
  hold = { problem, until };
  if (until !== null) timer = setTimeout(goOn, until - Date.now());
  tell();
}
