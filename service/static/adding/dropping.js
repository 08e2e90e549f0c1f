// Files dragged over the page: two halves to drop them on, and rows that wait for one.

import { entriesOf } from "./gathering.js";

const STILL = 1000; // milliseconds without a sign after which the drag has left the window unnoticed
const carriesFiles = (event) => event.dataTransfer?.types.includes("Files");

let overlay, timer;

/**
 * Watch for drops anywhere on the page.
 *
 * @param {(entries: object[], purpose: "add" | "find" | number) => void} onDrop - a number: of the upload on whose row
 */
export function watchDrops(onDrop) {
  overlay = made();
  document.body.append(overlay);
  const over = (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault(); // the page takes them
    event.dataTransfer.dropEffect = "copy";
    show(placeOf(event));
  };
  window.addEventListener("dragenter", over);
  window.addEventListener("dragover", over);
  window.addEventListener("dragleave", (event) => event.relatedTarget === null && hide());
  window.addEventListener("drop", (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    const place = placeOf(event);
    hide();
    onDrop(entriesOf(event.dataTransfer), place?.dataset.purpose ?? (Number(place?.dataset.number) || "add"));
  });
}

function made() {
  const element = document.createElement("div");
  element.className = "dropping";
  element.hidden = true;
  element.innerHTML = `<p class="choice" data-purpose="add">Add to the library</p>
    <p class="choice" data-purpose="find">Find what is similar</p>`;
  return element;
}

const placeOf = (event) => event.target.closest?.("[data-purpose], [data-number]");

function show(place) {
  clearTimeout(timer);
  timer = setTimeout(hide, STILL);
  overlay.hidden = false;
  document.body.classList.add("dragging");
  for (const one of document.querySelectorAll(".over")) if (one !== place) one.classList.remove("over");
  place?.classList.add("over");
}

function hide() {
  clearTimeout(timer);
  overlay.hidden = true;
  document.body.classList.remove("dragging");
  for (const one of document.querySelectorAll(".over")) one.classList.remove("over");
}
