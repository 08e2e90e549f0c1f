// Lengths that can be compared at a glance.

import { html } from "../vendor/lit-html.js";

/** A bar as long as a share of the whole. */
export const bar = (share) => html`<svg class="bar" viewBox="0 0 100 6" preserveAspectRatio="none" aria-hidden="true">
  <rect width=${(100 * share).toFixed(1)} height="6"></rect></svg>`;

/** A distance in few digits. */
export const short = (distance) => distance >= 0.1 || distance === 0
  ? distance.toLocaleString("en-GB", { minimumFractionDigits: 2, maximumFractionDigits: 2 })
  : distance.toLocaleString("en-GB", { maximumSignificantDigits: 2 });
