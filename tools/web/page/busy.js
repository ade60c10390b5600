// SPDX-License-Identifier: GPL-3.0-or-later
// The progress of the command, and the button that stops it.
import {h} from "./dom.js";

/** Shorter work shows no message. */
const QUIET_MS = 300;

export class Busy {
  #words = h("span", {role: "status"});
  element = null;
  #tasks = new Set();

  /** @param cancel() stops all work */
  constructor(cancel) {
    this.element = h("div", {class: "busy", hidden: true}, h("span", {class: "spinner", "aria-hidden": "true"}), this.#words,
      h("button", {type: "button", onclick: cancel}, "Stop"));
  }

  begin(what) {
    const task = {what, end: null, say: null};
    const timer = setTimeout(() => {
      this.element.hidden = false;
      this.#words.textContent ||= `${what} ...`;
    }, QUIET_MS);
    task.say = (words) => {
      this.#words.textContent = words;
    };
    task.end = () => {
      clearTimeout(timer);
      this.#tasks.delete(task);
      const [waiting] = this.#tasks;
      if (waiting) {
        this.#words.textContent = `${waiting.what} ...`;
        return;
      }
      this.element.hidden = true;
      this.#words.textContent = "";
    };
    this.#tasks.add(task);
    return task;
  }
}
