// Removing a shape, after a question that names it.

import { html } from "../vendor/lit-html.js";
import { libraryAddress } from "../shared/place.js";
import { say } from "../shared/said.js";
import { remove } from "./changes.js";

export function removing(panel) {
  const { name } = panel.shape;
  const dialog = () => panel.querySelector("dialog.removing");
  const act = async () => {
    dialog().close();
    if (!(await panel.attempt(() => remove(panel.shape)))) return;
    say(`${name} was removed.`);
    location.hash = libraryAddress();
  };
  return html`<button class="danger" @click=${() => dialog().showModal()}>Remove…</button>
    <dialog class="removing" aria-labelledby="removing-title">
      <h2 id="removing-title">Remove “${name}”?</h2>
      <p>Its files, its picture and its description are deleted. This cannot be undone.</p>
      <div class="row"><button class="danger strong" @click=${act}>Remove it</button>
        <button autofocus @click=${() => dialog().close()}>Keep it</button></div>
    </dialog>`;
}
