// The library as pictures, newest first.

import { html, render } from "../vendor/lit-html.js";
import { path, read } from "../shared/api.js";
import { many } from "../shared/words.js";
import { card } from "./card.js";

const PAGE = 60; // shapes asked for at once

export async function showGallery({ root, signal }) {
  document.title = "Faience";
  const page = await read(path(["shapes"], { limit: PAGE }), { signal });
  render(html`<h1>Library</h1>
    <p>${many(page.items.length, "shape")}</p>
    <ul class="cards">${page.items.map((shape, place) => card(shape, { eager: place < 12 }))}</ul>`, root);
}
