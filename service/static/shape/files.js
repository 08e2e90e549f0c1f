// The files of a shape as they were uploaded.

import { html } from "../vendor/lit-html.js";
import { path, request } from "../shared/api.js";
import { heldKey } from "../shared/key.js";
import { size } from "../shared/words.js";
import { heading } from "./heading.js";

export function files(panel) {
  const { id, files: stored } = panel.shape;
  return html`${heading(panel, "Files")}<ul class="files">${stored.map((file) => html`<li>${link(panel, id, file)} <small>${size(file.size)}</small></li>`)}</ul>`;
}

function link(panel, id, { name }) {
  const address = path(["shapes", id, "files", ...name.split("/")]);
  const fetched = (event) => {
    if (!heldKey()) return; // the browser's own download
    event.preventDefault();
    panel.attempt(() => save(address, name.split("/").at(-1)));
  };
  return html`<a href=${address} download @click=${fetched}>${name}</a>`;
}

/** Fetch a file with the key, which a link cannot send, and hand it to the browser. */
async function save(address, name) {
  const held = URL.createObjectURL(await (await request(address)).blob());
  Object.assign(document.createElement("a"), { href: held, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(held), 60_000); // a browser may still read it after the click
}
