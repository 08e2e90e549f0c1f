// Names inside files, matched to the files at hand as the service matches them (worker/reading/references.py).

import { baseOf, folderOf } from "./kinds.js";

/** Files that belong together, found by the names that others of them use. */
export class Pool {
  /** @param {import("./gathering.js").Sent[]} files */
  constructor(files) {
    this.files = files;
    this.exact = new Map(files.map((sent) => [sent.path, sent]));
    this.byPath = Map.groupBy(files, (sent) => folded(sent.path));
    this.byBase = Map.groupBy(files, (sent) => folded(baseOf(sent.path)));
  }

  /**
   * Find the file that a name means: by its path, by its path in any letter case, by a base name that only one has.
   *
   * @param {string} reference - the name as written
   * @param {string} namedBy - path of the file that holds it
   * @returns {import("./gathering.js").Sent | undefined} nothing, too, where several could be meant
   */
  find(reference, namedBy) {
    const slashed = reference.trim().replaceAll("\\", "/");
    const path = normalised(isAbsolute(slashed) ? slashed : `${folderOf(namedBy)}/${slashed}`.replace(/^\//, ""));
    if (this.exact.has(path)) return this.exact.get(path);
    const found = this.byPath.get(folded(path)) ?? this.byBase.get(folded(baseOf(slashed))) ?? [];
    return found.length === 1 ? found[0] : undefined;
  }
}

/** Compare names in any letter case, accents composed or not. By way of capitals ß becomes ss, as on the server. */
const folded = (name) => name.normalize("NFC").toUpperCase().toLowerCase();

const isAbsolute = (path) => /^\/|^[A-Za-z]:/.test(path);

/** Return a path without `.` and `..`; "" where it leads outside, which no file is called. */
function normalised(path) {
  if (isAbsolute(path)) return "";
  const parts = [];
  for (const part of path.split("/")) {
    if (part === "..") {
      if (!parts.length) return "";
      parts.pop();
    } else if (part && part !== ".") parts.push(part);
  }
  return parts.join("/");
}
