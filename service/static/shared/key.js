// The key of a library that asks for one: held until the browser's tab is closed.

import { html, render } from "../vendor/lit-html.js";

const NAME = "key";

export const heldKey = () => sessionStorage.getItem(NAME);

/** Ask for another key in the place of the view, whatever it could still show without one. */
export function exchangeKey() {
  sessionStorage.removeItem(NAME);
  window.dispatchEvent(new Event("keywanted"));
}

/** Show a form for the key in the place of a view. */
export function askForKey(root, then) {
  const refused = heldKey() !== null;
  const open = (event) => {
    event.preventDefault();
    sessionStorage.setItem(NAME, new FormData(event.target).get("secret").trim());
    then();
  };
  render(html`<h1>This library needs a key</h1>
    ${refused ? html`<p role="alert">That key does not open it. Keys can be revoked; ask whoever keeps the library for a new one.</p>` : ""}
    <form @submit=${open} class="row">
      <label for="secret">Key</label>
      <input id="secret" name="secret" type="password" autocomplete="current-password" required>
      <button class="strong">Open</button>
    </form>
    <p>It is made with <code>faience key create NAME</code> where the service runs.</p>`, root);
}
