// SPDX-License-Identifier: GPL-3.0-or-later
// The folder that the page works on, with undo. A folder is an object path -> Uint8Array; none is ever changed in
// place, so that a step back is the folder as it was.

const MOST_STEPS = 200;

export class Store {
  folder = {};
  /** What is no file: the step that is shown, the unit of the table. */
  view = {step: "machine", unit: "mm", sheet: "marks.csv"};
  #past = [];
  #future = [];
  #last = null;
  #listeners = [];

  listen(listener) {
    this.#listeners.push(listener);
  }

  /** As it was kept. */
  restore(kept) {
    this.folder = kept.folder;
    this.view = {...this.view, ...kept.view};
    this.#told();
  }

  /**
   * Something that a person did: `files` are put into the folder, null takes one out. Changes one after the other
   * under one `name` (the digits of a cell) are one step back.
   */
  change(files, name = null) {
    if (name === null || name !== this.#last) {
      this.#past.push(this.folder);
      if (this.#past.length > MOST_STEPS) this.#past.shift();
    }
    this.#last = name;
    this.#future = [];
    this.#put(files);
  }

  /** What the command made of it; no step of its own. */
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
