// The tags of a shape: chips to remove them, a field to add one.

import { html } from "../vendor/lit-html.js";
import { tagField } from "../shared/tag-field.js";
import { tagsOf } from "../shared/tags.js";
import { addTag, removeTag } from "./changes.js";

export function tagging(panel) {
  const { shape } = panel;
  const add = (tag) => panel.write(() => addTag(shape, tag), `Tagged ${tag}.`);
  const chip = (tag) => html`<li class="chip"><span>${tag}</span>
    <button aria-label="Remove the tag ${tag}" @click=${() => panel.write(() => removeTag(shape, tag), `Tag ${tag} removed.`)}>×</button></li>`;
  return html`<ul class="chips" aria-label="Tags">${tagsOf(shape).map(chip)}</ul>
    ${tagField({ label: "Add a tag", button: "Add", take: add })}`;
}
