// SPDX-License-Identifier: GPL-3.0-or-later
// Why the machine errs: the verdict, the causes by their probability with a picture each, what to do; and the map built on them.
import {causePicture} from "./cause_pictures.js";
import {DONE, printed, runVerb, sentenceList, sentencesAbout} from "./command.js";
import {bytesOf, folded, h, textOf} from "./dom.js";
import {bedOf, fittedList, HOLES, jsonOf, NO_DIAGNOSIS} from "./folder.js";
import {report} from "./frame.js";
import {explained} from "./glossary.js";
import {hookWords} from "./hook.js";
import {inPage} from "./in_page.js";
import {keepLaw, ownEffectPart, ownWords} from "./own_effect.js";
import {errorPicture} from "./picture.js";
import {Sheet} from "./sheet.js";

/** Ranked causes that are shown at once: what is less likely than this is folded. */
const SHOWN_FROM = 0.05;

export function causesPart(page) {
  const noise = new NoiseFields(page);
  const noiseBox = h("details", {}, h("summary", {}, "How well you read"), noise.element);
  const causes = h("div");
  const use = h("div");
  const own = ownEffectPart(page);
  const law = h("div");
  const next = h("div");
  const whole = folded("The whole diagnosis", (box) => report(page, "diagnosis.json", "diagnosis.html", "The diagnosis", box));
  const ask = h("button", {type: "button", class: "main", onclick: () => diagnose(page, noise.words())}, "Find the cause");
  const element = h("section", {}, h("h3", {}, "Why does it err?"),
    h("p", {}, "Which of the known causes explains the readings, how sure that is, and what to do."),
    noiseBox, own.element, h("p", {class: "buttons"}, ask), causes, use, law, next, whole.element);
  let shown = null;
  let used = {};

  /** What the map says of causes, where that has changed. */
  function drawUse(view) {
    if (used.plain === view.plain && used.fit === page.fit) return;
    used = {plain: view.plain, fit: page.fit};
    const hadFocus = use.contains(document.activeElement);
    use.replaceChildren(...usePart(page, view));
    if (hadFocus) use.querySelector("button")?.focus({preventScroll: true});
  }

  return {
    element,
    update({folder, view}) {
      noise.update(page.store);
      noiseBox.hidden = noise.element.hidden;
      own.update(page.store);
      const bytes = folder["diagnosis.json"];
      whole.element.hidden = !bytes;
      ask.classList.toggle("main", !bytes);
      drawUse(view);
      if (shown === bytes) return;
      shown = bytes;
      next.replaceChildren(...(bytes ? [h("p", {class: "buttons"},
        h("button", {type: "button", onclick: () => planNext(page, next)}, "What to measure next"))] : []));
      whole.forget();
      causes.replaceChildren();
      law.replaceChildren(...lawPart(page, jsonOf(bytes), () => keepLaw(page, diagnosisWords(page, noise.words()))));
      if (bytes) drawCauses(page, jsonOf(bytes), causes);
    },
  };
}

const SIDES = {left: "left", right: "right", both: "both", x: "along x", y: "along y", tl: "top left", tr: "top right", bl: "bottom left", br: "bottom right", all: "all"};

/** "chain pitch error, right" of an effect's id and side. */
function nameOf({effect, side}) {
  return `${effect.replaceAll("_", " ")}${side ? `, ${SIDES[side] ?? side}` : ""}`;
}

/** As laws are claimed (grid/diagnosis/constants.def, kLawClaimed). */
const CLAIMED = 0.9;
const SAYS = {confirmed: "confirmed, it acts here", denied: "denied, as it stands in the file it would have shown", open: "left open, measure more points", not_testable: "not testable with these readings"};

/** The button that makes a claimed law a cause of the owner's own. */
function lawPart(page, found, keep) {
  const [first] = found?.unexplained?.laws ?? [];
  if (!first || first.probability < CLAIMED) return [];
  return [h("p", {class: "buttons"}, h("button", {type: "button", onclick: keep}, "Keep the law as a cause of your own"),
    h("span", {class: "hint"}, "then measure other points: they confirm or deny it"))];
}

const NOT_CAUSES = {nothing: "nothing is wrong", law: "a law that no listed cause has", unknown: "a pattern that no known cause makes", noise: "readings that are worse than they should be", bad_points: "readings that are wrong"};

/** The hypotheses of a diagnosis as bars, likeliest first. `meanings` has sentences by effect, `pictures` figures by rank. */
function causeBars(hypotheses, meanings, pictures = []) {
  return h("ol", {class: "causes"}, hypotheses.map(({effect, side, probability}, rank) => {
    const percent = 100 * probability;
    const words = percent > 99.9 ? "above 99.9 %" : percent < 0.1 ? "below 0.1 %" : `${percent.toFixed(percent < 10 ? 1 : 0)} %`;
    return h("li", {}, h("span", {class: "bar"}, h("span", {style: `width: ${Math.max(percent, 0.5).toFixed(1)}%`})),
      h("b", {}, NOT_CAUSES[effect] ?? nameOf({effect, side})), h("span", {class: "percent"}, words),
      meanings[effect] && h("span", {class: "hint"}, meanings[effect]), pictures[rank]);
  }));
}

const likelyOf = (hypotheses) => hypotheses.filter(({probability}, rank) => rank === 0 || probability >= SHOWN_FROM);

/** The likely ones at once, at least one; the rest folded. */
export function rankedCauses(hypotheses, meanings = {}, pictures = []) {
  const likely = likelyOf(hypotheses);
  const rest = hypotheses.slice(likely.length);
  return [h("h4", {}, "Causes, likeliest first"), causeBars(likely, meanings, pictures),
    rest.length > 0 && h("details", {}, h("summary", {}, `${rest.length} others that were looked at`), causeBars(rest, meanings))].filter(Boolean);
}

const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** What to do, and below it, folded, what the verdict does not prove. */
export function remedies(found) {
  return [
    found.what_to_do?.length > 0 && h("h4", {}, "What to do"),
    found.what_to_do?.length > 0 && h("ul", {class: "sentences"}, found.what_to_do.map((line) => h("li", {}, explained(inPage(capital(line)))))),
    h("details", {}, h("summary", {}, "What this does not prove"),
      sentenceList([found.not_proved, ...(found.notes ?? [])].filter(Boolean).map(inPage))),
  ].filter(Boolean);
}

async function drawCauses(page, found, box) {
  box.append(h("p", {class: "headline verdict"}, explained(inPage(found.sentence), 2)));
  const bed = bedOf(page.store.folder);
  const points = (found.points ?? []).filter(({before_mm: before, after_mm: after}) => before && after);
  if (bed && points.length > 0 && found.causes?.length > 0) {
    box.append(errorPicture(bed, points, ({before_mm: error}) => error, ({after_mm: error}) => error, {
      label: `The bed with two arrows at each mark: its error, and what is left of it with ${found.causes.map(nameOf).join(" and ")}.`,
      before: "with better numbers alone", after: `with ${found.causes.map(nameOf).join(" and ")}`,
    }));
  }
  if (found.declared?.length > 0)
    box.append(h("h4", {}, "Your own cause"), sentenceList(found.declared.map((one) => `${capital(nameOf(one))}: ${SAYS[one.says]}.`)));
  const ranked = h("div", {}, rankedCauses(found.hypotheses));
  box.append(ranked, ...remedies(found));
  const meanings = await meaningsOf(page);
  ranked.replaceChildren(...rankedCauses(found.hypotheses, meanings));
  const pictures = [];
  for (const one of likelyOf(found.hypotheses)) pictures.push(await causePicture(page, found, one, NOT_CAUSES[one.effect] ?? nameOf(one)));
  if (ranked.isConnected) ranked.replaceChildren(...rankedCauses(found.hypotheses, meanings, pictures));
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

/** What the map says of causes, and the button that builds it without them, or again with them. */
function usePart(page, view) {
  const about = page.fit?.sentences.filter((sentence) => /^(Found, |Probable cause|Possible cause|What changed)/.test(sentence)) ?? [];
  if (!view.plain && about.length === 0) return [];
  const button = h("button", {type: "button", onclick: () => buildPlain(page, !view.plain)},
    view.plain ? "Build the map with the causes that are found" : "Build the map without causes");
  return [h("div", {id: "use-causes"}, changes(page, view, about), h("p", {class: "buttons"}, button))];
}

/** Before and after, with the command's own sentences on the causes. */
function changes(page, {plain, before}, about) {
  if (page.fit?.isPlain !== plain) return h("p", {class: "hint"}, "The map is built again ...");
  const now = before && (before === page.fit.headline ? "Now: the same." : page.fit.headline && `Now: ${page.fit.headline}`);
  return h("div", {class: "said", role: "status"}, sentenceList([before && `Before: ${before}`, now, ...about].filter(Boolean)));
}

/** The measure step fits the readings again. */
function buildPlain(page, plain) {
  page.store.show({plain, before: page.fit?.headline ?? null, sheet: fittedList(page.store.view)});
}

const NOISE = [["--noise-length-mm", "A chain length is good to, mm"], ["--noise-position-mm", "A place that you read is good to, mm"]];

/** How well the user reads. */
class NoiseFields {
  #page;
  #inputs = NOISE.map(([option]) => h("input", {
    id: option.slice(2), type: "text", inputmode: "decimal", size: 5,
    onchange: () => this.#page.store.show({noise: this.#inputs.map(({value}) => value)}),
  }));
  element = h("p", {class: "choices"}, NOISE.map(([option, label], index) =>
    h("span", {class: "pair"}, h("label", {for: option.slice(2)}, label), this.#inputs[index])));

  constructor(page) {
    this.#page = page;
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
