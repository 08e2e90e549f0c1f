// The dial between geometry and colour, and the paper's methods beside it.

import { html, live } from "../vendor/lit-html.js";
import { MIDDLE, isDefault } from "./asked.js";
import { wordsFor } from "./dial.js";
import { methodTitle } from "./names.js";

/** Draw what says how to compare. */
export function controls(answer) {
  const { asked, methods } = answer;
  const turn = (colour) => answer.compare({ method: "", colour });
  const back = ({ target }) => {
    target.closest(".controls").querySelector("input").focus(); // the button goes
    turn(MIDDLE);
  };
  return html`<div class="controls" role="group" aria-label="How to compare">
    <div class="dial ${asked.method ? "idle" : ""}">
      <button @click=${() => turn(0)}>Geometry</button>
      <input type="range" min="0" max="100" step="5" aria-label="What counts, from geometry to colour"
        aria-valuetext=${asked.method ? "Not used" : wordsFor(asked.colour)}
        .value=${live(String(asked.colour))} @input=${(event) => turn(event.target.valueAsNumber)}>
      <button @click=${() => turn(100)}>Colour</button>
    </div>
    <select aria-label="Method" @change=${(event) => answer.compare({ method: event.target.value, colour: MIDDLE })}>
      <option value="" .selected=${live(!asked.method)}>By the dial</option>
      <optgroup label="As in the paper of 2011">
        ${methods.filter((method) => !method.default).map((method) => html`
          <option value=${method.name} .selected=${live(method.name === asked.method)}>${methodTitle(method)}</option>`)}
      </optgroup>
    </select>
    <p class="hint">${hint(asked, methods)}
      <button class="plain" ?disabled=${isDefault(asked)} @click=${back}>Back to the middle</button></p>
  </div>`;
}

/** Say what is compared, and whether there is a second, closer look. */
function hint({ method, colour }, methods) {
  if (method) return `${methods.find(({ name }) => name === method)?.description ?? method}.`;
  const words = html`<strong>${wordsFor(colour)}.</strong>`;
  const { refined } = methods.find((one) => one.default);
  return colour === MIDDLE
    ? html`${words} The nearest ${refined} are looked at a second time, more closely.`
    : html`${words} The second, closer look is off: it would weigh both alike.`;
}
