// SPDX-License-Identifier: GPL-3.0-or-later
// What the belts say: two numbers, the frame, the verdict and the causes, a taped distance, and the lines to paste.
import {beltsPicture, CORNER_NAMES, frameOf} from "./belts_picture.js";
import {Choice, JOBS, NUMBERS, waysOf} from "./choice.js";
import {DONE, printed, runVerb, sentenceList, sentencesOf} from "./command.js";
import {rankedCauses, remedies} from "./diagnosis.js";
import {bytesOf, folded, h, textOf} from "./dom.js";
import {ANCHORS, BELTS, filledIn, HOLES, isBelts, jsonOf, PASTED} from "./folder.js";
import {report} from "./frame.js";
import {explained} from "./glossary.js";
import {inPage} from "./in_page.js";
import {millimetresOf} from "./sheet.js";
import {wishSaid} from "./wish.js";

const DISTANCES = [["tl", "br"], ["tr", "bl"], ["bl", "br"]];
const DIAGNOSIS = "diagnosis.json";

export function beltsResult(page) {
  const first = h("div");
  const frame = h("div");
  const causes = h("div");
  const lines = new Lines(page);
  const tape = new Tape(page);
  const remembered = new Map();
  const choice = new Choice(page, isBelts, {[NUMBERS]: lines.element, [JOBS]: h("p", {class: "buttons"},
    h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "cut"})}, "Open a program to cut"))});
  const whole = folded("The whole diagnosis", (box) => report(page, DIAGNOSIS, "diagnosis.html", "The diagnosis", box));
  const numbers = h("pre", {tabindex: "0", "aria-label": "What the fit says"});
  const details = h("details", {}, h("summary", {}, "The numbers"), numbers);
  const why = h("section", {}, h("h3", {}, "Why does it err?"), causes, whole.element, details);
  const none = h("p", {class: "hint"}, "The log is still missing: paste it in the first step.");
  const element = h("div", {hidden: true}, none, h("section", {id: "belts-first"}, h("h3", {}, "How true it cuts"), first, frame), choice.element, tape.element, why);
  let drawn = [];

  return {
    element,
    given: () => givenBy(page),
    update() {
      const {folder, view} = page.store;
      element.hidden = !isBelts(folder);
      if (element.hidden || view.step !== "result") return;
      none.hidden = Boolean(folder[BELTS]);
      first.parentElement.hidden = tape.element.hidden = !folder[BELTS];
      tape.update(page.store);
      // While the anchors are found anew what was drawn stays.
      if (folder[BELTS] && folder[BELTS] === drawn[0] && !folder[ANCHORS] && !page.belts.said.isWrong) return;
      const now = [folder[BELTS], folder[ANCHORS], folder[DIAGNOSIS], folder[HOLES], page.belts.said];
      choice.element.hidden = why.hidden = !folder[ANCHORS];
      if (folder[ANCHORS]) {
        choice.update(page.store);
        if (view.way === NUMBERS) lines.update(page.store);
      }
      if (now.every((one, index) => one === drawn[index])) return;
      if (folder[DIAGNOSIS] !== drawn[2]) whole.forget();
      if (folder[BELTS] !== drawn[0]) remembered.clear();
      drawn = now;
      const diagnosis = jsonOf(folder[DIAGNOSIS]);
      first.replaceChildren(...headlines(page, diagnosis));
      const known = frameOf(folder);
      frame.replaceChildren(...(known?.anchors ? [beltsPicture(known, (point) => page.belts.toggle(point), remembered)] : []));
      causes.replaceChildren(...(diagnosis ? [...rankedCauses(diagnosis.hypotheses), ...remedies(diagnosis)] : [h("p", {class: "hint"}, "The causes are being looked for ...")]));
      whole.element.hidden = !diagnosis;
      numbers.textContent = page.belts.said.fitted.map(inPage).join("\n");
    },
  };
}

function givenBy(page) {
  const {folder, view} = page.store;
  if (!folder[ANCHORS]) return "";
  return [twoNumbers(page.belts.said.fitted) ?? "The anchors are found.", view.way && `${waysOf(true)[view.way].title}.`].filter(Boolean).join(" ");
}

/** The tool's error today and with the lines, as the command says them of the anchors; null until it has. */
function twoNumbers(fitted) {
  const said = fitted.find((line) => /^(Your machine (misses|needs)|With these anchors)\b/.test(line));
  return said ? said.replace(/these anchors/g, "these lines").replace(/ The scale, which only a tape can tell, comes on top\.$/, "") : null;
}

function headlines(page, diagnosis) {
  const {folder} = page.store;
  const {fitted, isWrong} = page.belts.said;
  if (isWrong) return [h("div", {class: "said problem", role: "alert"}, sentenceList(fitted.map(inPage)))];
  if (!diagnosis) return [h("p", {class: "hint", role: "status"}, "Anchors and causes are being found ...")];
  const isSizeKnown = Boolean(jsonOf(folder[ANCHORS])?.fit.scale);
  return [
    h("p", {class: "headline", role: "status"}, explained(twoNumbers(fitted) ?? "The anchors are found.")),
    wishSaid(fitted) && h("p", {class: "wish"}, inPage(wishSaid(fitted))),
    !isSizeKnown && h("p", {}, "How large everything comes out is not known yet: tape one long distance, below."),
    h("p", {class: "verdict"}, explained(inPage(diagnosis.sentence), 2)),
  ].filter(Boolean);
}

/** Where the lines come from: the anchors with the causes taken off, or those that the holes were fitted with. */
function sourceOfLines(folder) {
  const isNamed = (jsonOf(folder[DIAGNOSIS])?.causes ?? []).length > 0;
  return isNamed && filledIn(folder[HOLES]) === 0 ? DIAGNOSIS : ANCHORS;
}

/** The lines to paste into the machine's terminal, each beside what is in force. */
class Lines {
  element = h("div");
  #page;
  #drawn = null;

  constructor(page) {
    this.#page = page;
  }

  async update({folder}) {
    const source = sourceOfLines(folder);
    const now = [folder[source], folder[PASTED]];
    if (this.#drawn?.every((one, index) => one === now[index])) return;
    this.#drawn = now;
    const result = await runVerb(this.#page, ["export", "maslow4", source], {quiet: true});
    if (!result || this.#drawn !== now) return;
    const hadFocus = this.element.contains(document.activeElement);
    this.element.replaceChildren(...this.#parts(folder, source, result));
    if (hadFocus) this.element.querySelector("button")?.focus({preventScroll: true});
  }

  #parts(folder, source, result) {
    const said = sentenceList(sentencesOf(result).map(inPage));
    if (result.code !== DONE) return [h("div", {class: "said problem"}, said)];
    const copied = h("span", {class: "hint", role: "status"});
    const copy = h("button", {type: "button", onclick: async () => {
      copied.textContent = await navigator.clipboard?.writeText(result.stdout).then(() => "Copied.", () => "Select them and copy.") ?? "Select them and copy.";
    }}, "Copy the lines");
    return [
      printed(result.stdout, "Lines to paste"), h("p", {class: "buttons"}, copy, copied),
      changesTable(folder, result.stdout), said,
      folder[PASTED]
        ? h("p", {class: "said", role: "status"}, "These lines are in the machine. What is left, holes and a tape show; programs can be compensated for it. ",
          h("button", {type: "button", onclick: () => this.#page.store.change({[PASTED]: null})}, "The machine has its old anchors"))
        : h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => this.#pasted(folder, source)}, "I have pasted them")),
    ];
  }

  #pasted(folder, source) {
    const belts = jsonOf(folder[BELTS]);
    const machine = jsonOf(folder[source]).belts?.machine;
    this.#page.store.change({[PASTED]: machine ? bytesOf(`${JSON.stringify({...belts, machine}, null, 2)}\n`) : folder[source]});
  }
}

/** What each line changes, where the log or maslow.yaml said what is in force. */
function changesTable(folder, lines) {
  const {machine} = jsonOf(folder[BELTS]);
  const rows = lines.split("\n").map((line) => /\/([tb][lr])([XYZ])=(-?[\d.]+)$/.exec(line)).filter(Boolean).map(([, corner, axis, value]) => {
    const now = machine.anchors?.[corner]?.[`${axis.toLowerCase()}_mm`];
    return {name: `${CORNER_NAMES[corner]} ${axis.toLowerCase()}`, now, will: Number(value)};
  });
  const isKnown = rows.some(({now}) => now !== undefined);
  if (!isKnown) return h("p", {class: "hint"}, "What is in force is not known: paste maslow.yaml into the box of the first step, and it stands here.");
  const mm = (value) => (value === undefined ? "" : value.toFixed(1));
  return h("div", {class: "table-box"}, h("table", {class: "changes"}, h("caption", {}, "What will change, mm"),
    h("thead", {}, h("tr", {}, ["anchor", "now", "will be", "moves by"].map((title, index) => h("th", {scope: "col", class: index > 0 && "number"}, title)))),
    h("tbody", {}, rows.map(({name, now, will}) => h("tr", {}, h("th", {scope: "row"}, name), h("td", {class: "number"}, mm(now)), h("td", {class: "number"}, mm(will)),
      h("td", {class: "number"}, now === undefined ? "" : `${will >= now ? "+" : "\u2212"}${Math.abs(will - now).toFixed(1)}`))))));
}

/** The box for distances between anchors, which alone say how large the frame is. */
class Tape {
  #page;
  #note = h("p", {class: "note", role: "status"});
  #inputs = DISTANCES.map(([from, to]) => h("input", {id: `tape-${from}-${to}`, type: "text", inputmode: "decimal", size: 8, autocomplete: "off",
    "aria-describedby": "tape-note", onchange: () => this.#taped()}));
  element = h("section", {class: "tape"}, h("h3", {}, "A taped distance"),
    h("p", {}, explained("Belts know the frame's shape and not its size: one long distance between two anchors says how large everything is.")),
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
    const {fitted, isWrong} = this.#page.belts.said;
    const wrong = isWrong ? fitted.filter((line) => line.includes("/distances/")) : [];
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
    // What is no number goes into the file as it is, so that the command reports it.
    const taped = typed.map(({from, to, text}) => ({from, to, distance_mm: Number.isFinite(Number(text)) ? Number(text) : text}));
    const {distances: _, ...rest} = belts;
    const all = [...others, ...taped];
    this.#page.store.change({[BELTS]: bytesOf(`${JSON.stringify(all.length > 0 ? {...rest, distances: all} : rest, null, 2)}\n`)});
  }
}
