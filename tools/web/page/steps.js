// SPDX-License-Identifier: GPL-3.0-or-later
// The steps below each other: one is open, the others are folded to their title and a line that says what was given.
import {h} from "./dom.js";

export class Steps {
  element = h("div", {class: "steps"});
  #parts = {};
  #shown = null;

  /**
   * @param steps [[id, label, {element, update(), given()}]]: given() is the line of a folded step, "" if there is nothing yet
   * @param open(id) is called on a click on a title
   */
  constructor(steps, open) {
    for (const [id, label, step] of steps) {
      const given = h("p", {class: "given", id: `given-${id}`});
      const title = h("button", {type: "button", id: `title-${id}`, "aria-controls": `step-${id}`, "aria-describedby": given.id,
        onclick: () => open(id)}, label);
      const body = h("div", {id: `step-${id}`, class: "step-body", role: "region", "aria-labelledby": title.id}, step.element);
      const frame = h("div", {class: "step"}, h("div", {class: "step-head"}, h("h2", {}, title), given), body);
      this.#parts[id] = {step, given, title, body, frame};
      this.element.append(frame);
    }
  }

  update(open) {
    const hadFocus = this.#parts[this.#shown]?.body.contains(document.activeElement);
    for (const [id, {step, given, title, body, frame}] of Object.entries(this.#parts)) {
      const isOpen = id === open;
      body.hidden = !isOpen;
      title.setAttribute("aria-expanded", String(isOpen));
      // One step is always open: its title folds nothing.
      title.setAttribute("aria-disabled", String(isOpen));
      step.update();
      const line = step.given();
      given.textContent = line;
      given.hidden = isOpen || line === "";
      frame.classList.toggle("open", isOpen);
      frame.classList.toggle("done", line !== "");
    }
    if (this.#shown === open) return;
    this.#shown = open;
    scrollTo(0, 0);
    if (hadFocus) this.#parts[open].title.focus({preventScroll: true});
  }
}
