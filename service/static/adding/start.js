// The ways in: buttons in the header, a drop anywhere, a paste. What follows is loaded when somebody takes one.

import { html, render } from "../vendor/lit-html.js";
import { watchDrops } from "./dropping.js";
import { entriesOf, gather } from "./gathering.js";
import { chooseFiles, chooseFolder, takesFolders } from "./picking.js";

const take = async (gathered, purpose) => (await import("./intake.js")).take(gathered, purpose);

/** Let somebody choose what to add; for other parts of the page that invite to it. */
export const addFiles = async () => take(await chooseFiles(), "add");
const addFolder = async () => take(await chooseFolder(), "add");
const findSimilar = async () => take(await chooseFiles(), "find");

export function startAdding() {
  render(html`<button class="strong" @click=${addFiles}>Add meshes</button>
    ${takesFolders ? html`<button @click=${addFolder}>Add a folder</button>` : ""}
    <button @click=${findSimilar}>Find similar to a file</button>`, document.getElementById("ways"));
  watchDrops(async (entries, purpose) => take(await gather(entries), purpose));
  document.addEventListener("paste", async (event) => {
    const entries = entriesOf(event.clipboardData);
    if (entries.length) await take(await gather(entries), "add");
  });
}
