// What was decided on this page: pairs that are no duplicates, shapes that were removed; told in notes that can be undone.

import { Problem, path, request } from "../shared/api.js";
import { keyOf } from "./groups.js";

const addressOf = ([one, other]) => path(["duplicates", "dismissals", one, other]);

export class Decisions {
  dismissed = new Set(); // keys of pairs
  removed = new Set(); // ids of shapes
  notes = []; // {number, group, text, pairs, problem}: said in the place of a group
  #numbers = 0;

  notesOf(group) {
    return this.notes.filter((note) => note.group === group);
  }

  /** Dismiss pairs of ids; what was done before a refusal can be undone. */
  async dismiss(group, pairs, text) {
    const note = this.#note(group, text);
    await guarded(note, async () => {
      for (const pair of pairs.filter(([one, other]) => !this.dismissed.has(keyOf(one, other)))) {
        await request(addressOf(pair), { method: "PUT" });
        this.dismissed.add(keyOf(...pair));
        note.pairs.push(pair);
      }
    });
    return note;
  }

  async undo(note) {
    await guarded(note, async () => {
      while (note.pairs.length) {
        await this.takeBack(note.pairs.at(-1));
        note.pairs.pop();
      }
      this.notes = this.notes.filter((other) => other !== note);
    });
  }

  /** Take back that a pair was dismissed, here or long ago. */
  async takeBack(pair) {
    try {
      await request(addressOf(pair), { method: "DELETE" });
    } catch (error) {
      if (error.code !== "not_dismissed") throw error; // somebody else took it back
    }
    this.dismissed.delete(keyOf(...pair));
  }

  async remove(group, shape) {
    const note = this.#note(group, `“${shape.name}” was removed.`);
    await guarded(note, async () => {
      await request(path(["shapes", shape.id]), { method: "DELETE" });
      this.removed.add(shape.id);
    });
    return note;
  }

  #note(group, text) {
    const note = { number: (this.#numbers += 1), group, text, pairs: [], problem: null };
    this.notes = [...this.notes.filter((old) => old.group !== group || !old.problem || old.pairs.length), note];
    return note;
  }
}

/** What the service refuses is said in the note. */
async function guarded(note, act) {
  note.problem = null;
  try {
    await act();
  } catch (error) {
    if (!(error instanceof Problem)) throw error;
    note.problem = error;
  }
}
