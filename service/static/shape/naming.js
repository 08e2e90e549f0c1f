// The name of a shape, and a form in its place to rename it.

import { html, ref } from "../vendor/lit-html.js";
import { rename } from "./changes.js";

/** Draw the name; `panel` has the shape, whether it is being renamed, and `write`. */
export function naming(panel) {
  return panel.renaming ? form(panel) : title(panel);
}

function title(panel) {
  const { name } = panel.shape;
  const heading = panel.whole ? html`<h1>${name}</h1>` : html`<h2>${name}</h2>`;
  return html`<div class="naming">${heading}<button ${ref(focusAfter(panel))} @click=${() => panel.rename(true)}>Rename</button></div>`;
}

/** Once the form is gone, who used the keyboard goes on from its button. */
const focusAfter = (panel) => (button) => {
  if (button && panel.renamed) queueMicrotask(() => button.focus()); // when it is in the page
  if (button) panel.renamed = false;
};

function form(panel) {
  const save = async (event) => {
    event.preventDefault();
    const name = new FormData(event.target).get("name").trim();
    if (await panel.write(() => rename(panel.shape, name), "Renamed.")) panel.rename(false);
  };
  const escape = (event) => event.key === "Escape" && panel.rename(false);
  return html`<form class="naming row" @submit=${save} @keydown=${escape}>
    <label for="new-name">Name</label>
    <input id="new-name" name="name" required maxlength="500" .defaultValue=${panel.shape.name} ${ref(selectAtFirst)}>
    <button class="strong">Save</button>
    <button type="button" @click=${() => panel.rename(false)}>Cancel</button>
  </form>`;
}

const selectAtFirst = (input) =>
  input && queueMicrotask(() => {
    input.focus();
    input.select();
  });
