// What was dropped or chosen, as a plain list of files with their paths; folders are walked through.

import { isHidden } from "./kinds.js";

/**
 * @typedef {{path: string, file: File}} Sent - a file and where it lay, relative to what was dropped
 * @typedef {{files: Sent[], hidden: number, unreadable: string[]}} Gathered - `hidden`: how many files were left out
 *   that systems add by themselves
 */

/** Take out of a drop what can be walked through; to be called before anything is awaited, for then it is gone. */
export function entriesOf(transfer) {
  const items = [...transfer.items].filter((item) => item.kind === "file");
  return items.map((item) => item.webkitGetAsEntry() ?? plain(item.getAsFile())).filter(Boolean);
}

/** Wrap a file that belongs to no folder, such as one that is pasted. */
const plain = (file) =>
  file && { name: file.name, fullPath: `/${file.name}`, isFile: true, file: (found) => found(file) };

/**
 * Walk through folders.
 *
 * @param {FileSystemEntry[]} entries
 * @returns {Promise<Gathered>}
 */
export async function gather(entries) {
  const gathered = { files: [], hidden: 0, unreadable: [] };
  const waiting = [entries];
  while (waiting.length) {
    const batch = waiting.pop();
    const seen = batch.filter((entry) => !isHidden(entry.name));
    gathered.hidden += batch.length - seen.length;
    await Promise.all(seen.filter((entry) => entry.isFile).map((entry) => take(entry, gathered)));
    for (const folder of seen.filter((entry) => entry.isDirectory)) {
      for await (const more of batchesOf(folder, gathered)) waiting.push(more);
    }
  }
  gathered.files.sort((one, other) => one.path.localeCompare(other.path, undefined, { numeric: true }));
  return gathered;
}

async function take(entry, gathered) {
  try {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    gathered.files.push({ path: entry.fullPath.replace(/^\//, ""), file });
  } catch {
    gathered.unreadable.push(entry.fullPath);
  }
}

/** Yield what a folder holds; browsers hand out at most a hundred at a time, and none at the end. */
async function* batchesOf(folder, gathered) {
  const reader = folder.createReader();
  while (true) {
    try {
      const batch = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (!batch.length) return;
      yield batch;
    } catch {
      gathered.unreadable.push(folder.fullPath);
      return;
    }
  }
}

/**
 * List what a file input holds.
 *
 * @param {Iterable<File>} list
 * @returns {Gathered}
 */
export function gatherList(list) {
  const files = [...list].map((file) => ({ path: file.webkitRelativePath || file.name, file }));
  const kept = files.filter(({ path }) => !path.split("/").some(isHidden));
  return { files: kept, hidden: files.length - kept.length, unreadable: [] };
}
