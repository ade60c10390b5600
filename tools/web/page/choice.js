// SPDX-License-Identifier: GPL-3.0-or-later
// The one choice after the result: numbers for the controller, or each program compensated. What is not chosen is put
// away with the reason, and the way back.
import {h} from "./dom.js";

export const NUMBERS = "numbers";
export const JOBS = "jobs";

const CHAINS = {
  [NUMBERS]: {title: "Type numbers in", words: "Once, into the controller. They take off what settings can; programs stay as they are.",
    away: "Compensating each job is put away: a program compensated for the old numbers comes out wrong with the new ones."},
  [JOBS]: {title: "Compensate each job", words: "Truer: every program is rewritten before it is cut. The controller keeps its numbers.",
    away: "Typing numbers in is put away: with other numbers in the controller, programs compensated for the present ones come out wrong."},
};
const BELTS = {
  [NUMBERS]: {...CHAINS[NUMBERS], title: "Paste the lines", words: "Once, into the Maslow's terminal. Programs stay as they are."},
  [JOBS]: {...CHAINS[JOBS], words: "Every program is rewritten before it is cut. The machine keeps its anchors.",
    away: "The lines to paste are put away: with other anchors in the machine, programs compensated for the present ones come out wrong."},
};

/** What to call the two ways on this machine. */
export const waysOf = (isBelts) => (isBelts ? BELTS : CHAINS);
const otherWay = (way) => (way === NUMBERS ? JOBS : NUMBERS);

/** Why the other way is put away, and the button that takes it instead. */
export function putAway(page, ways, way) {
  return h("p", {class: "put-away"}, `${ways[way].away} `,
    h("button", {type: "button", onclick: () => page.store.show({way: otherWay(way)})}, `${ways[otherWay(way)].title} instead`));
}

/**
 * The section of the choice.
 * @param isBelts(folder) which machine; @param chosen {numbers: element, jobs: element}, what each way goes on with
 */
export class Choice {
  element = h("section");
  #page;
  #isBelts;
  #chosen;
  #drawn = null;

  constructor(page, isBelts, chosen) {
    this.#page = page;
    this.#isBelts = isBelts;
    this.#chosen = chosen;
  }

  update({folder, view}) {
    const isBelts = this.#isBelts(folder);
    const key = `${view.way} ${isBelts}`;
    if (this.#drawn === key) return;
    const hadFocus = this.element.contains(document.activeElement);
    this.#drawn = key;
    const ways = waysOf(isBelts);
    this.element.replaceChildren(...(view.way ? this.#after(ways, view.way) : this.#before(ways)));
    if (hadFocus) this.element.querySelector("button")?.focus({preventScroll: true});
  }

  #before(ways) {
    return [h("h3", {}, "What now? Choose one"), h("div", {class: "ways"}, [NUMBERS, JOBS].map((way) => h("div", {class: "way"},
      h("button", {type: "button", class: "main", onclick: () => this.#page.store.show({way})}, ways[way].title),
      h("p", {}, ways[way].words))))];
  }

  #after(ways, way) {
    return [h("h3", {}, `You chose: ${ways[way].title.toLowerCase()}`), this.#chosen[way], putAway(this.#page, ways, way)];
  }
}
