// A question that must be answered before something is done that cannot be undone.

import { html, render } from "../vendor/lit-html.js";

/**
 * Ask; the safe answer has the focus.
 *
 * @param {{title: string, text: string, action: string, keep?: string, signal?: AbortSignal}} question - `action` is
 *   what the button that does it says; leaving the view answers no
 * @returns {Promise<boolean>}
 */
export function confirmed({ title, text, action, keep = "Keep it", signal }) {
  const dialog = document.createElement("dialog");
  dialog.className = "question";
  dialog.setAttribute("aria-labelledby", "question");
  render(html`<form method="dialog">
    <h2 id="question">${title}</h2>
    <p>${text}</p>
    <p class="row"><button value="" autofocus>${keep}</button> <button value="yes" class="danger strong">${action}</button></p>
  </form>`, dialog);
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => {
    signal?.addEventListener("abort", () => dialog.close(""));
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes");
    });
  });
}
