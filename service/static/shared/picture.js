// Thumbnails, no wider than they are shown: the browser chooses among widths that the server makes.

import { html } from "../vendor/lit-html.js";
import { request } from "./api.js";
import { heldKey } from "./key.js";

const WIDTHS = [96, 160, 256];

/**
 * Draw the thumbnail of a shape or of a remembered query.
 *
 * @param {string} base - e.g. `/v1/shapes/ID`
 * @param {string} sizes - its width on the page, as in the `sizes` attribute of an image
 * @param {boolean} eager - whether it is in view at once
 */
export function picture(base, sizes = "10rem", eager = false) {
  const address = (width) => `${base}/thumbnail.png?width=${width}`;
  if (heldKey()) return html`<keyed-picture .address=${address}></keyed-picture>`;
  return html`<img alt="" width="256" height="256" loading=${eager ? "eager" : "lazy"} decoding="async" sizes=${sizes}
    srcset=${WIDTHS.map((width) => `${address(width)} ${width}w`).join(", ")}>`;
}

/** An image that is asked for with the key, which <img> cannot send, when it comes into view. */
class KeyedPicture extends HTMLElement {
  connectedCallback() {
    this.watcher = new IntersectionObserver((told) => told.some((one) => one.isIntersecting) && this.load(), { rootMargin: "200px" });
    this.watcher.observe(this);
  }

  disconnectedCallback() {
    this.watcher.disconnect();
    if (this.held) URL.revokeObjectURL(this.held);
  }

  async load() {
    this.watcher.disconnect();
    const wanted = this.clientWidth * devicePixelRatio;
    const width = WIDTHS.find((one) => one >= wanted) ?? WIDTHS.at(-1);
    try {
      const answer = await request(this.address(width));
      this.held = URL.createObjectURL(await answer.blob());
    } catch {
      return; // the card stays without a picture; its text says what it is
    }
    const image = new Image();
    image.alt = "";
    image.src = this.held;
    this.replaceChildren(image);
  }
}
customElements.define("keyed-picture", KeyedPicture);
