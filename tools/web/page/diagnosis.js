// SPDX-License-Identifier: GPL-3.0-or-later
// Why the machine errs: the cause with its picture and one remedy, and folded the others, what to measure next, the diagnosis.
import {causePicture} from "./cause_pictures.js";
import {DONE, printed, runVerb, sentenceList, sentencesAbout} from "./command.js";
import {bytesOf, folded, h, textOf} from "./dom.js";
import {fittedList, HOLES, jsonOf, NO_DIAGNOSIS, ownEffects, roadOf} from "./folder.js";
import {report} from "./frame.js";
import {explained} from "./glossary.js";
import {hookWords} from "./hook.js";
import {inPage} from "./in_page.js";
import {keepLaw, ownEffectPart, ownWords} from "./own_effect.js";
import {Sheet} from "./sheet.js";

/** What a diagnosis adds that the result does not repeat: its own numbers. */
const NUMBERS = / Correcting for it reduces the .*$| The error of one belt's reading falls from .*$/;

export function causesPart(page) {
  const noise = new NoiseFields(page, () => diagnose(page, noise.words()));
  const own = ownEffectPart(page);
  const cause = h("section", {class: "cause"});
  const rest = h("div");
  const law = h("div");
  const next = h("div");
  const whole = folded("The whole diagnosis", (box) => report(page, "diagnosis.json", "diagnosis.html", "The diagnosis", box));
  const others = h("details", {}, h("summary", {}, "Other causes that were looked at"), rest);
  const measureNext = h("details", {}, h("summary", {}, "What to measure next"), next);
  let shown = null;
  let asked = null;

  /** Chains have their causes looked for once there is a map; belts and plotters with each fit. */
  function askOnce(folder) {
    const of = [folder["map.json"], ...ownEffects(folder).map((name) => folder[name])];
    if (roadOf(folder) !== "chains" || folder["diagnosis.json"] || !of[0] || (asked?.length === of.length && of.every((one, index) => one === asked[index]))) return;
    asked = of;
    diagnose(page, noise.words());
  }

  return {
    cause, noise: noise.element, folds: [others, measureNext, own.element, whole.element],
    update({folder}) {
      noise.update(page.store);
      own.update(page.store);
      askOnce(folder);
      const isChains = roadOf(folder) === "chains";
      const bytes = folder["diagnosis.json"];
      const found = jsonOf(bytes);
      cause.hidden = others.hidden = whole.element.hidden = !found;
      measureNext.hidden = !found || !isChains;
      noise.element.hidden ||= !isChains;
      own.element.hidden = !isChains;
      if (shown === bytes) return;
      shown = bytes;
      whole.forget();
      for (const box of [cause, rest, next]) box.replaceChildren();
      if (!found) return;
      next.replaceChildren(sentenceList((found.what_to_do ?? []).slice(1).map((line) => inPage(capital(line)))),
        h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => planNext(page, next)}, "Plan more marks")));
      law.replaceChildren(...lawPart(page, found, () => keepLaw(page, diagnosisWords(page, noise.words()))));
      drawCause(page, found, cause);
      cause.append(law);
      drawRest(page, found, rest);
    },
  };
}

const SIDES = {left: "left", right: "right", both: "both", x: "along x", y: "along y", tl: "top left", tr: "top right", bl: "bottom left", br: "bottom right", all: "all"};

/** "chain pitch error, right" of an effect's id and side. */
function nameOf({effect, side}) {
  return `${effect.replaceAll("_", " ")}${side ? `, ${SIDES[side] ?? side}` : ""}`;
}

/** As laws are claimed (grid/diagnosis/constants.hpp, kLawClaimed). */
const CLAIMED = 0.9;
const SAYS = {confirmed: "confirmed, it acts here", denied:
    "denied, with the values in the file it would have " +
    "shown", open: "left open, measure more points", not_testable: "not testable with these readings"};

/** The button that makes a claimed law a cause of the owner's own. */
function lawPart(page, found, keep) {
  const [first] = found?.unexplained?.laws ?? [];
  if (!first || first.probability < CLAIMED) return [];
  return [h("p", {class: "buttons"}, h("button", {type: "button", onclick: keep}, "Keep the law as a cause of your own"),
    h("span", {class: "hint"}, "then measure other points: they confirm or deny it"))];
}

const NOT_CAUSES = {nothing: "nothing besides the settings", law: "a law that no listed cause has", unknown:
    "a pattern that no known cause " +
    "explains", noise: "readings that are worse than they should be", bad_points: "readings that are wrong"};

/** The hypotheses of a diagnosis as bars, likeliest first. `meanings` has sentences by effect. */
function causeBars(hypotheses, meanings) {
  return h("ol", {class: "causes"}, hypotheses.map(({effect, side, probability}) => {
    const percent = 100 * probability;
    const words = percent > 99.9 ? "above 99.9 %" : percent < 0.1 ? "below 0.1 %" : `${percent.toFixed(percent < 10 ? 1 : 0)} %`;
    return h("li", {}, h("span", {class: "bar"}, h("span", {style: `width: ${Math.max(percent, 0.5).toFixed(1)}%`})),
      h("b", {}, NOT_CAUSES[effect] ?? nameOf({effect, side})), h("span", {class: "percent"}, words),
      meanings[effect] && h("span", {class: "hint"}, meanings[effect]));
  }));
}


const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** The verdict, one remedy to tick off, and the picture of the likeliest cause. */
async function drawCause(page, found, box) {
  const [remedy] = found.what_to_do ?? [];
  const needsNone = /^Your machine needs no map/.test(page.fit?.headline ?? "") || (found.causes?.length === 0 && roadOf(page.store.folder) === "plotter");
  const tick = h("input", {type: "checkbox", checked: page.store.view.done === remedy, onchange: () => page.store.show({done: tick.checked ? remedy : null})});
  const picture = h("div");
  box.replaceChildren(h("h3", {}, "The cause"), h("p", {class: "verdict"}, explained(inPage(found.sentence).replace(NUMBERS, ""), 2)),
    ...(remedy && !needsNone ? [h("p", {}, h("label", {class: "pair"}, tick, capital(inPage(remedy))))] : []), picture);
  if (found.declared?.length > 0)
    box.append(h("h4", {}, "Your own cause"), sentenceList(found.declared.map((one) => `${capital(nameOf(one))}: ${SAYS[one.says]}.`)));
  const [first] = found.hypotheses;
  const drawn = first && await causePicture(page, found, first, NOT_CAUSES[first.effect] ?? nameOf(first));
  if (drawn) picture.replaceChildren(drawn);
}

/** All hypotheses by their probability, and what the verdict does not prove. */
async function drawRest(page, found, box) {
  const draw = (meanings) => box.replaceChildren(h("p", {class: "hint"},
      "Each probability stands alone, because causes can act " +
      "together."), causeBars(found.hypotheses, meanings),
    h("h4", {}, "What this does not prove"), sentenceList([found.not_proved, ...(found.notes ?? [])].filter(Boolean).map(inPage)));
  draw({});
  const meanings = await meaningsOf(page);
  if (jsonOf(page.store.folder["diagnosis.json"]) === found) draw(meanings);
}

let catalogue = null;

/** The catalogue's sentence for each effect. */
async function meaningsOf(page) {
  if (!catalogue) {
    const result = await runVerb(page, ["effects", "--json"], {files: {}, quiet: true});
    if (result?.code !== DONE) return {};
    catalogue = Object.fromEntries(JSON.parse(result.stdout).effects.map(({effect, cause}) => [effect, cause]));
  }
  return catalogue;
}

const NOISE = [["--noise-length-mm", "Error of a chain length, " +
                                     "mm"], ["--noise-position-mm",
                                         "Error of a measured place, mm"]];

/** How well the user reads. */
class NoiseFields {
  #page;
  #changed;
  #inputs = NOISE.map(([option]) => h("input", {
    id: option.slice(2), type: "text", inputmode: "decimal", size: 5,
    onchange: () => {
      this.#page.store.show({noise: this.#inputs.map(({value}) => value)});
      this.#changed();
    },
  }));
  element = h("p", {class: "choices"}, NOISE.map(([option, label], index) =>
    h("span", {class: "pair"}, h("label", {for: option.slice(2)}, label), this.#inputs[index])));

  constructor(page, changed) {
    this.#page = page;
    this.#changed = changed;
  }

  update({folder, view}) {
    this.element.hidden = fittedList(view) === HOLES;
    for (const [index, input] of this.#inputs.entries()) {
      if (document.activeElement !== input) input.value = view.noise?.[index] ?? usual(folder, NOISE[index][0]);
    }
  }

  words() {
    if (this.element.hidden) return [];
    return this.#inputs.flatMap(({value}, index) => (value.trim() === "" ? [] : [NOISE[index][0], value.trim().replace(",", ".")]));
  }
}

/** The noise that the command's README.txt recommends. */
function usual(folder, option) {
  const readme = folder["README.txt"] ? textOf(folder["README.txt"]) : "";
  return new RegExp(`chaintrue diagnose .*${option} (\\S+)`).exec(readme)?.[1] ?? "";
}

const diagnosisWords = ({store}, noise) =>
  ["diagnose", fittedList(store.view), "--machine", "machine.json", ...ownWords(store.folder), ...noise, ...hookWords(store), "-o", "diagnosis.json", "--force"];

async function diagnose(page, noise) {
  const list = fittedList(page.store.view);
  const readings = page.store.folder[list];
  const result = await runVerb(page, diagnosisWords(page, noise));
  if (!result || page.store.folder[list] !== readings) return;
  if (result.code !== DONE) {
    page.alert(sentencesAbout(listOf(page), result).map(inPage).join(" "));
    return;
  }
  page.store.derive(result.files);
}

async function planNext(page, box) {
  const result = await runVerb(page, ["plan", fittedList(page.store.view), "--after", "diagnosis.json", "--machine", "machine.json", "-o", "next.csv", "--force"]);
  if (!result) return;
  const rows = result.files["next.csv"] ? textOf(result.files["next.csv"]).split("\n").slice(1).filter((line) => line && !line.startsWith("#")) : [];
  box.replaceChildren(sentenceList(sentencesAbout(listOf(page), result).map(inPage)), ...(rows.length === 0 ? [] : [
    printed(textOf(result.files["next.csv"]), "Places to measure next"),
    h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => addRows(page, result.files["next.csv"])}, "Add them to the list")),
  ]));
}

/** The new lines in the columns of the list; their numbers continue those of the list. */
function addRows(page, bytes) {
  const path = fittedList(page.store.view);
  const list = textOf(page.store.folder[path]);
  const lines = list.split("\n").filter((line) => line !== "");
  const columns = lines.find((line) => !line.startsWith("#")).split(",");
  const [header, ...added] = textOf(bytes).split("\n").filter((line) => line && !line.startsWith("#")).map((line) => line.split(","));
  const rows = added.map((cells) => columns.map((column) => cells[header.indexOf(column)] ?? "").join(","));
  const notes = lines.filter((line) => line.startsWith("#"));
  const kept = lines.filter((line) => !line.startsWith("#"));
  page.store.change({[path]: bytesOf(`${[...kept, ...rows, ...notes].join("\n")}\n`), ...NO_DIAGNOSIS});
  page.store.show({step: "measure", sheet: path});
}

const listOf = (page) => Sheet.of(textOf(page.store.folder[fittedList(page.store.view)]));
