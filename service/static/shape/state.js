// A shape that is not ready: what it waits for, or why it failed and what can be done.

import { html } from "../vendor/lit-html.js";
import { retry } from "./changes.js";
import { heading } from "./heading.js";

export function state(panel) {
  const { shape } = panel;
  if (shape.status === "failed") return failure(panel);
  if (shape.status === "ready") return "";
  const words = shape.status === "queued" ? "It waits to be described." : "It is being described now.";
  return html`<p class="soft">${words} Its picture and what is similar to it come by themselves.</p>`;
}

function failure(panel) {
  const { error } = panel.shape;
  const again = () => panel.write(() => retry(panel.shape), "It waits to be described again.");
  return html`<section class="failure">
    ${heading(panel, "Why it failed")}
    <p>${error.detail}</p>
    <p><button @click=${again} ?disabled=${panel.busy}>Try again</button> <small>code <code>${error.code}</code></small></p>
  </section>`;
}
