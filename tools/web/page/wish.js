// SPDX-License-Identifier: GPL-3.0-or-later
// The error of the tool that the owner wishes for: a box above the readings, and the option of a fit.
import {h} from "./dom.js";

/** A label with its box; `id` is the box's. One wish is held for chains and belts. */
export class WishBox {
  #input;
  element;

  constructor(page, id) {
    this.#input = h("input", {id, type: "text", inputmode: "decimal", size: 4, onchange: () => page.store.show({wish: this.#input.value.trim()})});
    this.element = h("span", {class: "pair"}, h("label", {for: id}, "Good enough for you, mm"), this.#input);
  }

  update({view}) {
    if (document.activeElement !== this.#input) this.#input.value = view.wish ?? "";
  }
}

/** A wish that is no number is none. */
export function wishWords({wish}) {
  const mm = Number((wish || "").replace(",", "."));
  return mm > 0 ? ["--wish-mm", String(mm)] : [];
}

/** What a fit says of the wish. */
export const isWish = (line) => line.startsWith("Your target is");
