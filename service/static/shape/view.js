// A page for one shape: its details alone, also of one that is not ready.

import { html, render } from "../vendor/lit-html.js";
import { path, read } from "../shared/api.js";
import { libraryAddress } from "../shared/place.js";
import { details } from "./details.js";

export async function showShape({ root, parameters, signal }) {
  const shape = await read(path(["shapes", parameters.id]), { signal });
  document.title = `${shape.name} – Faience`;
  root.addEventListener("changed", ({ detail }) => (document.title = `${detail.name} – Faience`));
  render(html`<p class="ways-on"><a href=${libraryAddress()}>‹ Library</a>
      ${shape.status === "ready" ? html`<a href="#/shapes/${encodeURIComponent(shape.id)}">What is similar to it ›</a>` : ""}</p>
    ${details(shape, { whole: true })}`, root);
}
