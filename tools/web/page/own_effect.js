// SPDX-License-Identifier: GPL-3.0-or-later
// A cause of the owner's own: where it acts and by which formula, with a picture of what it does to a square; weighed with the
// listed ones once it is kept.
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, download, h, textOf} from "./dom.js";
import {jsonOf, nextLawFile, NO_DIAGNOSIS, OWN_EFFECT, ownEffects} from "./folder.js";
import {drawingFrame} from "./frame.js";
import {inPage} from "./in_page.js";
import {effectOf, WHERE} from "./own_effect_file.js";

const EXAMPLE = "size_mm * sin(4 * pi * L0 / turn + phase_rad)";
const WAIT_MS = 400;

/** Options of a verb that weighs the kept effect. */
export const ownWords = (folder) => ownEffects(folder).flatMap((name) => ["--effects", name]);

export function ownEffectPart(page) {
  const field = (id, label, value, size, hint) => {
    const input = h("input", {id, type: "text", value, size, autocomplete: "off", oninput: () => later()});
    return {input, element: h("span", {class: "pair"}, h("label", {for: id}, label), input, hint && h("span", {class: "hint"}, hint))};
  };
  const name = field("own-name", "Call it", "a sprocket that is not round", 30);
  const formula = field("own-formula", "It adds, mm", EXAMPLE, 44);
  const size = field("own-size", "size_mm is usually", "0.4", 5);
  const place = field("own-place", "its place or phase is usually", "0", 6);
  const where = h("select", {id: "own-where", onchange: () => later()}, Object.entries(WHERE).map(([value, {words}]) => h("option", {value}, words)));
  const said = h("div", {class: "said", role: "status", "aria-live": "polite"});
  const picture = h("div", {class: "own-picture"});
  const keep = h("button", {type: "button", onclick: () => kept()}, "Weigh it with the others");
  const weighed = h("div", {class: "hint"});
  const form = h("div", {},
    h("p", {}, "What you suspect and no list has: give it a formula. It is then weighed like any other cause."),
    h("p", {class: "choices"}, name.element, h("span", {class: "pair"}, h("label", {for: "own-where"}, "It acts on"), where)),
    h("p", {class: "choices"}, formula.element, size.element, place.element),
    h("p", {class: "hint"}, "A chain's formula may use L0 (its length), S (the free part), phi (its angle below the horizontal), T (its pull), turn (chain of one turn of the sprocket), " +
      "pitch, x and y of the tool, r (its distance from the middle), + - * / ^, sin, cos, exp, log, sqrt, abs, min, max, step and ramp; and one place: phase_rad, place_mm, place_rad or place_n."),
    said, picture);
  const element = h("details", {class: "folded", ontoggle: () => draw()}, h("summary", {}, "A cause of your own"), form,
    h("p", {class: "buttons"}, keep), weighed);
  let timer = null;
  let drawn = null;

  const values = () => ({name: name.input.value, where: where.value, formula: formula.input.value, size: size.input.value, place: place.input.value});
  const bytes = () => bytesOf(`${JSON.stringify(effectOf(values()), null, 1)}\n`);

  function later() {
    clearTimeout(timer);
    timer = setTimeout(draw, WAIT_MS);
  }

  /** The picture of the form as it stands; where the formula is wrong the sentence that says why. */
  async function draw() {
    if (!element.open || !page.store.folder["machine.json"]) return;
    const text = textOf(bytes());
    if (drawn === text) return;
    drawn = text;
    const effect = JSON.parse(text);
    const result = await runVerb(page, ["effects", effect.id, "--atlas", "machine.json", "--effects", OWN_EFFECT, "-o", "own.html", "--force"],
      {files: {...page.store.folder, [OWN_EFFECT]: bytesOf(text)}, quiet: true, supersede: "own effect"});
    if (!result || drawn !== text) return;
    keep.disabled = result.code !== DONE;
    const sentences = result.code === DONE ? [] : sentencesOf(result).map((line) => inPage(line.replace(/^\S+: (line \d+, column \d+: )?/, "")));
    said.replaceChildren(...(sentences.length > 0 ? [sentenceList(sentences, {class: "problem"})] : []));
    picture.replaceChildren(...(result.code === DONE ? [drawingFrame("What it does to a square", result.files["own.html"])] : []));
  }

  function kept() {
    page.store.change({[OWN_EFFECT]: bytes(), ...NO_DIAGNOSIS});
  }

  return {
    element,
    update({folder}) {
      weighed.replaceChildren(...ownEffects(folder).map((name) => h("p", {class: "buttons"},
        `Weighed: ${jsonOf(folder[name])?.cause ?? "a cause of your own"}. `,
        h("button", {type: "button", onclick: () => download(name, folder[name])}, "Download it"),
        h("button", {type: "button", onclick: () => page.store.change({[name]: null, ...NO_DIAGNOSIS})}, "Take it away"))));
      draw();
    },
  };
}

/** Keeps the law that a diagnosis claims as one more cause of the owner's. `words` are those of the diagnosis. */
export async function keepLaw(page, words) {
  const file = nextLawFile(page.store.folder);
  const result = await runVerb(page, [...words, "--law", file]);
  if (!result) return;
  const law = result.files?.[file];
  if (!law) {
    page.alert(sentencesOf(result).map(inPage).join(" "));
    return;
  }
  page.store.change({[file]: law});
}
