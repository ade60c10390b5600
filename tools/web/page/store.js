// SPDX-License-Identifier: GPL-3.0-or-later
// The folder that the page works on, with undo. A folder is an object path -> Uint8Array; none is ever changed in
// place, so that a step back is the folder as it was.

const MOST_STEPS = 200;

export class Store {
  folder = {};
  /** State besides the files: the step that is shown, the unit of the table. */
  view = {step: "machine", unit: "mm", sheet: "marks.csv"};
  #past = [];
  #future = [];
  #last = null;
  #listeners = [];

  listen(listener) {
    this.#listeners.push(listener);
  }

  /** Restores the stored state. */
  restore(kept) {
    this.folder = kept.folder;
    this.view = {...this.view, ...kept.view};
    this.#told();
  }

  /**
   * An action of the user: `files` are added to the folder, null removes one. Consecutive changes
   * with one `name` (the digits of a cell) are one undo step.
   */
  change(files, name = null) {
    if (name === null || name !== this.#last) {
      this.#past.push(this.folder);
      if (this.#past.length > MOST_STEPS) this.#past.shift();
    }
    this.#last = name;
    this.#future = [];
    this.view = {...this.view, isExample: false};
    this.#put(files);
  }

  /** The command's output; not a separate undo step. */
  derive(files) {
    this.#put(files);
  }

  show(view) {
    this.view = {...this.view, ...view};
    this.#told();
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  undo() {
    this.#step(this.#past, this.#future);
  }

  redo() {
    this.#step(this.#future, this.#past);
  }

  #step(from, to) {
    if (from.length === 0) return;
    to.push(this.folder);
    this.folder = from.pop();
    this.#last = null;
    this.#told();
  }

  #put(files) {
    const folder = {...this.folder};
    for (const [path, bytes] of Object.entries(files)) {
      if (bytes === null) delete folder[path];
      else folder[path] = bytes;
    }
    this.folder = folder;
    this.#told();
  }

  #told() {
    for (const listener of this.#listeners) listener();
  }
}
