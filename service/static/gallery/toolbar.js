// What to look at: words in the name, a state, tags.

import { html, live } from "../vendor/lit-html.js";
import { tagField } from "../shared/tag-field.js";
import { folded } from "../shared/tags.js";
import { STATES, count } from "../shared/words.js";

const PAUSE = 250; // milliseconds without a key before words are looked for

/**
 * Draw the filters.
 *
 * @param {object} filters - of filters.js
 * @param {{counts?: object, tags: {items: object[], next_cursor: string|null}}} known - what the service counted
 * @param {(change: object, typed?: boolean) => void} change - hears what is wanted instead
 */
export function toolbar(filters, known, change) {
  return html`<form role="search" class="filters" @submit=${(event) => event.preventDefault()}>
      <label>Find by name ${words(filters, change)}</label>
      <label>State ${states(filters, known.counts?.found, change)}</label>
    </form>
    ${chips(filters, known.tags, change)}`;
}

function words({ q }, change) {
  const typed = ({ target }) => {
    clearTimeout(target.pause);
    target.pause = setTimeout(() => change({ q: target.value.trim() }, true), PAUSE);
  };
  const done = ({ target }) => { // left, or Enter was pressed
    clearTimeout(target.pause);
    change({ q: target.value.trim() });
  };
  return html`<input type="search" name="q" .defaultValue=${q} placeholder="Words in the name or metadata" maxlength="500"
    autocomplete="off" @input=${typed} @change=${done}>`;
}

function states({ status }, found, change) {
  const option = ([value, words]) => {
    const number = found && (value ? found[value] : found.total);
    return html`<option value=${value} .selected=${live(value === status)}>${words}${found ? ` (${count(number)})` : ""}</option>`;
  };
  return html`<select name="status" @change=${({ target }) => change({ status: target.value })}>
    ${[["", "all"], ...Object.entries(STATES)].map(option)}</select>`;
}

function chips({ tags }, known, change) {
  const chosen = (tag) => tags.some((one) => folded(one) === folded(tag));
  const others = tags.filter((tag) => !known.items.some((one) => folded(one.tag) === folded(tag)));
  if (!known.items.length && !others.length) return "";
  const toggle = (tag) => change({ tags: chosen(tag) ? tags.filter((one) => folded(one) !== folded(tag)) : [...tags, tag] });
  const chip = ({ tag, shapes }) => html`<li><button class="pick" aria-pressed=${chosen(tag)} @click=${() => toggle(tag)}>
    <span>${tag}</span>${shapes === undefined ? "" : html` <small>${count(shapes)}</small>`}</button></li>`;
  const add = (tag) => chosen(tag) || change({ tags: [...tags, tag] });
  return html`<div class="tags"><ul class="chips" aria-label="Tags">${[...others.map((tag) => ({ tag })), ...known.items].map(chip)}</ul>
    ${known.next_cursor ? tagField({ label: "Another tag", button: "Show", take: add }) : ""}</div>`;
}
