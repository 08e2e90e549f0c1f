// What the buttons of the page of duplicates do, and where the focus goes once the button is gone.

import { confirmed } from "../shared/confirm.js";
import { say } from "../shared/said.js";
import { many } from "../shared/words.js";
import { KINDS, addressOf } from "./kinds.js";
import { leftOf } from "./groups.js";
import { Look } from "./look.js";
import { reached } from "./progress.js";

export class Actions {
  #busy = false; // with one decision: a second press of the same button is none of its own

  constructor({ state, draw, root, signal }) {
    Object.assign(this, { state, draw, root, signal });
  }

  /** Look for other kinds, from the beginning. */
  choose = (kind, wanted) => {
    const { state } = this;
    state.kinds = KINDS.filter((one) => (one === kind ? wanted : state.kinds.includes(one)));
    if (state.kinds.length) history.replaceState(null, "", addressOf(state.kinds));
    this.again();
  };

  /** Look from the beginning. */
  again = () => {
    const { state } = this;
    state.look.stop();
    state.anew = null;
    state.look = new Look(state.kinds);
    state.decisions.notes = [];
    if (state.kinds.length) return this.further();
    this.draw();
  };

  further = async () => {
    const { state } = this;
    const { look } = state;
    const known = look.groups.length;
    const done = look.further(this.draw, this.signal);
    this.draw();
    await done;
    if (look !== state.look || this.signal.aborted) return; // other kinds were chosen meanwhile
    this.draw();
    say(`${look.groups.length === known ? "Nothing was" : `${many(look.groups.length - known, "group")} were`} found. ${reached(look, state.total)}`);
  };

  stop = () => this.state.look.stop();

  /** The two shapes of a group are no duplicates. */
  apart = (group, part) => {
    const [one, other] = part.shapes;
    return this.#dismiss(group, [[one.id, other.id]], `“${one.name}” and “${other.name}” are no duplicates.`);
  };

  /** One shape is a duplicate of no other in its group. */
  misfit = (group, part, shape) => {
    const pairs = part.shapes.filter(({ id }) => id !== shape.id).map(({ id }) => [shape.id, id]);
    return this.#dismiss(group, pairs, `“${shape.name}” does not belong to this group.`);
  };

  #dismiss(group, pairs, text) {
    return this.#once(async () => this.#told(await this.state.decisions.dismiss(group.id, pairs, text)));
  }

  undo = (note) => this.#once(async () => {
    await this.state.decisions.undo(note);
    if (note.problem) return this.#told(note);
    this.#changed(`#group-${note.group}-0`);
    say("It is back in its group.");
  });

  remove = async (group, shape) => {
    const sure = await confirmed({
      title: `Remove “${shape.name}”?`,
      text: "The shape, the files that were uploaded with it and its picture are deleted. This cannot be undone.",
      action: "Remove it for good", signal: this.signal,
    });
    if (sure) await this.#once(async () => this.#told(await this.state.decisions.remove(group.id, shape)));
  };

  /** Read the dismissed pairs when they are opened for the first time. */
  open = () => this.state.dismissed.pairs ?? this.#readDismissed();

  more = () => this.#readDismissed({ next: true });

  takeBack = ({ one, other }) => this.#once(async () => {
    const { look, decisions, dismissed } = this.state;
    await decisions.takeBack([one.id, other.id]);
    decisions.notes = decisions.notes.filter((note) => !note.pairs.some((pair) => pair.includes(one.id) && pair.includes(other.id)));
    await dismissed.read(this.signal);
    const back = look.groups.some((group) => leftOf(group, decisions.dismissed, decisions.removed)
      .some(({ shapes }) => [one, other].every(({ id }) => shapes.some((shape) => shape.id === id))));
    this.state.anew = { one, other, back };
    this.#changed("#taken-back");
  });

  async #readDismissed(how) {
    await this.state.dismissed.read(this.signal, how);
    this.draw();
  }

  /** Show a note, in the place of the button that was pressed. */
  #told(note) {
    if (this.state.dismissed.pairs) this.#readDismissed(); // it may be open below
    this.#changed(`#decision-${note.number}`);
    say(note.problem ? "" : note.text);
  }

  #changed(focus) {
    this.draw();
    this.root.querySelector(focus)?.focus();
  }

  async #once(act) {
    if (this.#busy) return;
    this.#busy = true;
    try {
      await act();
    } finally {
      this.#busy = false;
    }
  }
}
