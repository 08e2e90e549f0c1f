// Headings of the details' parts: one level below the shape's name, wherever that stands.

import { html } from "../vendor/lit-html.js";

export const heading = (panel, text) => (panel.whole ? html`<h2>${text}</h2>` : html`<h3>${text}</h3>`);
