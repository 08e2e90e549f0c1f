// The start of the page: the address after # chooses a view, which lives until the next one.

import { html, render } from "./vendor/lit-html.js";
import { startAdding } from "./adding/start.js";
import { Problem } from "./shared/api.js";
import { askForKey } from "./shared/key.js";
import { routeOf } from "./routes.js";

const main = document.getElementById("main");
let leaving = new AbortController();

async function show() {
  const { root, signal } = clear();
  const { view, parameters, section } = routeOf(location.hash);
  markSection(section);
  try {
    await view({ root, parameters, signal });
  } catch (error) {
    if (!signal.aborted) explain(error, root);
  }
}

/** End the view that is shown; return the place of the next one, and the signal of its end. */
function clear() {
  leaving.abort();
  leaving = new AbortController();
  const root = document.createElement("div");
  main.replaceChildren(root);
  return { root, signal: leaving.signal };
}

/** Say what went wrong in the place of the view; without a key, ask for one. */
function explain(error, root) {
  if (error instanceof Problem && error.status === 401) {
    askForKey(root, show);
    return;
  }
  render(html`<h1>This did not work</h1>
    <p role="alert">${error.message}</p>
    <p><button @click=${show}>Try again</button> <a href="#/">To the library</a></p>`, root);
  if (!(error instanceof Problem)) throw error; // a defect of ours belongs into the console, too
}

function markSection(section) {
  for (const link of document.querySelectorAll("nav a")) {
    if (link.getAttribute("href") === section) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

window.addEventListener("hashchange", () => {
  show();
  main.focus({ preventScroll: true }); // a new page: those who listen begin at its content
  window.scrollTo(0, 0);
});
window.addEventListener("keywanted", () => askForKey(clear().root, show));
startAdding();
show();
