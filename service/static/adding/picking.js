// The browser's own dialogs for files and folders.

import { gatherList } from "./gathering.js";

/** @returns {Promise<import("./gathering.js").Gathered>} nothing where they think better of it: then it stays open */
export const chooseFiles = () => choose({ multiple: true });
export const chooseFolder = () => choose({ webkitdirectory: true });

/** Whether this browser can take a folder; those of phones cannot. */
export const takesFolders = "webkitdirectory" in HTMLInputElement.prototype && !matchMedia("(pointer: coarse)").matches;

function choose(kind) {
  const input = Object.assign(document.createElement("input"), { type: "file", ...kind });
  return new Promise((resolve) => {
    input.addEventListener("change", () => resolve(gatherList(input.files)));
    input.click();
  });
}
