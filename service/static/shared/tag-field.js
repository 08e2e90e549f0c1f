// A field for one tag, which suggests those that the library has.

import { html, render } from "../vendor/lit-html.js";
import { path, read } from "./api.js";
import { many } from "./words.js";

const SUGGESTED = 20;
let fields = 0; // each has a list of its own

/**
 * Draw the field.
 *
 * @param {{label: string, button: string, take: (tag: string) => Promise<boolean|void>|boolean|void}} options - `take`
 *   gets what was entered; where it answers false the text stays
 */
export const tagField = (options) => html`<tag-field .options=${options}></tag-field>`;

class TagField extends HTMLElement {
  number = (fields += 1);

  set options(options) {
    this.chosen = options;
    render(this.form(options), this);
  }

  form({ label, button }) {
    const list = `tags-${this.number}`;
    return html`<form class="row" @submit=${(event) => this.submit(event)}>
      <label for="tag-${this.number}" class="unseen">${label}</label>
      <input id="tag-${this.number}" name="tag" list=${list} placeholder=${label} autocomplete="off" required maxlength="200"
        @focus=${() => this.suggest("")} @input=${(event) => this.suggest(event.target.value)}>
      <datalist id=${list}></datalist>
      <button>${button}</button>
    </form>`;
  }

  async submit(event) {
    event.preventDefault();
    const input = this.querySelector("input");
    const tag = input.value.trim();
    if (tag && (await this.chosen.take(tag)) !== false) input.value = "";
  }

  async suggest(start) {
    const asked = (this.asked = Symbol());
    const found = await read(path(["tags"], { limit: SUGGESTED, q: start.trim() })).catch(() => ({ items: [] }));
    if (asked !== this.asked) return; // a later question was quicker
    render(found.items.map(({ tag, shapes }) => html`<option value=${tag}>${many(shapes, "shape")}</option>`), this.querySelector("datalist"));
  }
}
customElements.define("tag-field", TagField);
