// SPDX-License-Identifier: GPL-3.0-or-later
// The box for distances between the anchors of four belts.
import {bytesOf, h} from "./dom.js";
import {CORNER_NAMES} from "./belts_picture.js";
import {BELTS, jsonOf} from "./folder.js";
import {explained} from "./glossary.js";
import {inPage} from "./in_page.js";
import {millimetresOf} from "./sheet.js";

const DISTANCES = [["tl", "br"], ["tr", "bl"], ["bl", "br"]];

/** The box for distances between anchors, which alone say how large the frame is. */
export class Tape {
  #page;
  #note = h("p", {class: "note", role: "status"});
  #inputs = DISTANCES.map(([from, to]) => h("input", {id: `tape-${from}-${to}`, type: "text", inputmode: "decimal", size: 8, autocomplete: "off",
    "aria-describedby": "tape-note", onchange: () => this.#taped()}));
  element = h("section", {class: "tape"}, h("h3", {}, "A taped distance"),
    h("p", {}, explained("Belts show the frame's shape, not its size. Tape one long distance between two anchors, and the size is known too.")),
    h("div", {class: "fields"}, DISTANCES.map(([from, to], index) => h("p", {},
      h("label", {for: this.#inputs[index].id}, `${CORNER_NAMES[from]} to ${CORNER_NAMES[to]}, mm`), this.#inputs[index]))), this.#note);

  constructor(page) {
    this.#page = page;
    this.#note.id = "tape-note";
  }

  update({folder}) {
    const taped = jsonOf(folder[BELTS])?.distances ?? [];
    for (const [index, [from, to]] of DISTANCES.entries()) {
      const input = this.#inputs[index];
      if (document.activeElement !== input) input.value = taped.find((one) => one.from === from && one.to === to)?.distance_mm ?? "";
    }
    const {sentences, isWrong} = this.#page.fit ?? {};
    const wrong = isWrong ? sentences.filter((line) => line.includes("/distances/")) : [];
    this.#note.textContent = wrong.map((line) => inPage(line.replace(/^\S+: \S+: /, ""))).join(" ");
    for (const input of this.#inputs) {
      if (wrong.length > 0 && input.value !== "") input.setAttribute("aria-invalid", "true");
      else input.removeAttribute("aria-invalid");
    }
  }

  #taped() {
    const belts = jsonOf(this.#page.store.folder[BELTS]);
    const others = (belts.distances ?? []).filter(({from, to}) => !DISTANCES.some(([one, other]) => one === from && other === to));
    const typed = DISTANCES.map(([from, to], index) => ({from, to, text: millimetresOf(this.#inputs[index].value, "mm")})).filter(({text}) => text !== "");
    // Text that is not a number goes into the file unchanged, so that the command reports it.
    const taped = typed.map(({from, to, text}) => ({from, to, distance_mm: Number.isFinite(Number(text)) ? Number(text) : text}));
    const {distances: _, ...rest} = belts;
    const all = [...others, ...taped];
    this.#page.store.change({[BELTS]: bytesOf(`${JSON.stringify(all.length > 0 ? {...rest, distances: all} : rest, null, 2)}\n`)});
  }
}
