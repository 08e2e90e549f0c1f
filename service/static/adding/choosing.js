// Which of several meshes to ask about.

import { html, render } from "../vendor/lit-html.js";
import { count } from "../shared/words.js";

const MOST = 200; // that are listed

/**
 * Let somebody choose one mesh.
 *
 * @param {import("./gathering.js").Sent[]} meshes
 * @returns {Promise<import("./gathering.js").Sent | undefined>} nothing where they think better of it
 */
export function chooseOne(meshes) {
  const dialog = document.createElement("dialog");
  dialog.className = "choosing";
  dialog.setAttribute("aria-labelledby", "choosing");
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(meshes[dialog.returnValue]);
    });
    render(content(meshes), dialog);
    document.body.append(dialog);
    dialog.showModal();
  });
}

const content = (meshes) => html`<form method="dialog">
  <h2 id="choosing">Which one shall be compared with the library?</h2>
  <ul>${meshes.slice(0, MOST).map(({ path }, place) => html`<li><button value=${place}>${path}</button></li>`)}</ul>
  ${meshes.length > MOST ? html`<p class="soft">These are the first ${MOST} of ${count(meshes.length)}.</p>` : ""}
  <p><button value="none">Cancel</button></p>
</form>`;
