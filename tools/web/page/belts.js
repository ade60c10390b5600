// SPDX-License-Identifier: GPL-3.0-or-later
// A Maslow 4: its log and its maslow.yaml from one box, and from them the belts, the anchors and the causes.
import {splitPasted, runsIn} from "./belts_text.js";
import {CHECK_FAILED, DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, h, textOf} from "./dom.js";
import {ANCHORS, BELTS, filledIn, HOLES, isBelts, jsonOf, LOG, MASLOW_SETTINGS, NO_DIAGNOSIS, WITHOUT} from "./folder.js";
import {hookOption} from "./hook.js";
import {inPage} from "./in_page.js";
import {replaceFolder} from "./machine.js";
import {fitParts} from "./verdict.js";
import {isWish, wishWords} from "./wish.js";

/** Delay between the last key and a run of the command: the time between two keys. */
const PAUSE_MS = 350;
const NO_RESULTS = {[ANCHORS]: null, "anchors.html": null, ...NO_DIAGNOSIS};

/** The points that are left out by hand, from 1. */
export const leftOut = (folder) => (folder[WITHOUT] ? textOf(folder[WITHOUT]).split(",").map(Number).filter((point) => point > 0) : []);

/** Belts that were read anew, with the distances between anchors that were taped before. */
function withTaped(bytes, before) {
  const taped = (jsonOf(before)?.distances ?? []).filter(({from, to}) => typeof from === "string" && typeof to === "string");
  return taped.length === 0 ? bytes : bytesOf(`${JSON.stringify({...jsonOf(bytes), distances: taped}, null, 2)}\n`);
}

const LENGTHS = [["span", "level from anchor to tool, as since October 2024"], ["belt_and_arm", "slanting, arm and belt's end included, as before"], ["belt", "the belt alone, slanting"]];
const FRAMES = [["upright", "stands upright"], ["flat", "lies flat on the floor"]];

function chooser(id, options, changed) {
  const select = h("select", {id, onchange: () => changed(select.value)}, options.map(([value, label]) => h("option", {value}, label)));
  return select;
}

export class Belts {
  #imported = [];
  #page;
  #analysed = null;
  #timer = null;
  #reading = null;
  #lengths = chooser("belt-lengths", LENGTHS, (lengths) => this.#again({lengths}));
  #frame = chooser("belt-frame", FRAMES, (orientation) => this.#again({orientation}));
  #run = chooser("belt-run", [], (run) => this.#again({run: Number(run)}));
  #assumed = h("div");

  constructor(page) {
    this.#page = page;
  }

  /** What the log left open, and what was assumed of it. */
  readingPart() {
    this.#reading = h("div", {hidden: true}, h("h4", {}, "How the log is read"), this.#assumed,
      h("p", {class: "choices"},
        h("span", {class: "pair"}, h("label", {for: "belt-lengths"}, "A length is"), this.#lengths),
        h("span", {class: "pair"}, h("label", {for: "belt-frame"}, "The frame"), this.#frame),
        h("span", {class: "pair", id: "belt-runs"}, h("label", {for: "belt-run"}, "Calibration"), this.#run)));
    return this.#reading;
  }

  given() {
    const {folder} = this.#page.store;
    const belts = jsonOf(folder[BELTS]);
    if (!belts) return "maslow.yaml; the log is still missing";
    const assumed = [belts.comment].flat().filter((line) => line?.startsWith("assumed")).length;
    return `Maslow 4: ${belts.points.length} places in the log${folder[MASLOW_SETTINGS] ? ", maslow.yaml" : ""}` +
      `${assumed > 0 ? `; ${assumed} thing${assumed > 1 ? "s" : ""} assumed` : ""}`;
  }

  /** A pasted or opened text: one part joins what the folder has of the other. True if it was read. */
  async take(text) {
    const {folder} = this.#page.store;
    const {yaml, log} = splitPasted(text);
    const kept = isBelts(folder) ? folder : {};
    const files = Object.fromEntries([[LOG, log ? bytesOf(log) : kept[LOG]], [MASLOW_SETTINGS, yaml ? bytesOf(yaml) : kept[MASLOW_SETTINGS]]]
      .filter(([, bytes]) => bytes));
    if (!files[LOG]) {
      replaceFolder(this.#page, files, "machine");
      this.#page.say(["maslow.yaml is read. Now open or paste what the machine printed while it found its anchors: drop the log anywhere on this page."]);
      return true;
    }
    const read = await this.#import(files, {});
    if (!read) return false;
    const sentences = sentencesOf(read).map(inPage);
    if (read.code !== DONE) {
      this.#page.say(sentences, true);
      return false;
    }
    this.#page.say([`The log${files[MASLOW_SETTINGS] ? " and maslow.yaml are" : " is"} read: ${jsonOf(read.files[BELTS]).points.length} places.`]);
    this.#imported = sentences;
    if (log) {
      replaceFolder(this.#page, {...files, ...read.files}, "result");
      this.#page.store.show({runs: runsIn(sentences), run: null});
    } else {
      this.#page.store.change({...files, [BELTS]: withTaped(read.files[BELTS], folder[BELTS]), ...NO_RESULTS});
      this.#page.store.show({step: "result"});
    }
    return true;
  }

  #import(files, {lengths, orientation, run}) {
    const words = ["import", "maslow4", LOG, ...(files[MASLOW_SETTINGS] ? ["--settings", MASLOW_SETTINGS] : []),
      ...(lengths ? ["--lengths", lengths] : []), ...(orientation ? ["--orientation", orientation] : []), ...(run ? ["--runs", String(run)] : []),
      "-o", BELTS, "--force"];
    return runVerb(this.#page, words, {files: Object.fromEntries(Object.entries(files).filter(([path]) => [LOG, MASLOW_SETTINGS].includes(path)))});
  }

  /** The log read in another way. Distances that were taped stay. */
  async #again(changed) {
    const {folder, view} = this.#page.store;
    const {machine} = jsonOf(folder[BELTS]);
    const read = await this.#import(folder, {lengths: machine.lengths, orientation: machine.orientation, run: view.run, ...changed});
    if (!read) return;
    this.#imported = sentencesOf(read).map(inPage);
    this.#page.say(read.code === DONE ? [] : this.#imported, read.code !== DONE);
    if (read.code !== DONE) return;
    const isOtherRun = changed.run !== undefined;
    this.#page.store.change({[BELTS]: withTaped(read.files[BELTS], folder[BELTS]), ...NO_RESULTS, ...(isOtherRun ? {[WITHOUT]: null} : {})});
    if (isOtherRun) this.#page.store.show({run: changed.run});
  }

  /** Leaves a point out, or takes it back. Points count from 1. */
  toggle(point) {
    const points = leftOut(this.#page.store.folder);
    const now = points.includes(point) ? points.filter((one) => one !== point) : [...points, point].sort((one, other) => one - other);
    this.#page.store.change({[WITHOUT]: now.length > 0 ? bytesOf(now.join(",")) : null, ...NO_RESULTS});
  }

  /** Anchors and causes follow what they are made of, undo and reload included. */
  update() {
    const {folder, view} = this.#page.store;
    if (!this.#reading) return;
    const belts = jsonOf(folder[BELTS]);
    this.#reading.hidden = !belts;
    if (!belts) {
      this.#analysed = null;
      return;
    }
    this.#drawReading(belts, view);
    const holes = filledIn(folder[HOLES]) > 0 ? folder[HOLES] : null;
    const made = [folder[BELTS], folder[WITHOUT], holes, [...hookOption({view}), ...wishWords(view)].join(" ")];
    if (this.#analysed?.every((one, index) => one === made[index])) return;
    const isTyping = this.#analysed !== null && this.#analysed[2] !== holes;
    this.#analysed = made;
    // An answer to an earlier wish does not answer this one.
    if (this.#page.fit) this.#page.fit = {...this.#page.fit, sentences: this.#page.fit.sentences.filter((line) => !isWish(line))};
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#analyse(made), isTyping ? PAUSE_MS : 0);
  }

  #drawReading({machine, comment}, view) {
    this.#lengths.value = machine.lengths;
    this.#frame.value = machine.orientation;
    const assumed = [comment].flat().filter((line) => line?.startsWith("assumed"));
    const imported = this.#imported.filter((line) => !/^Assumed/.test(line) && !/^ /.test(line));
    this.#assumed.replaceChildren(sentenceList([...assumed, ...imported].map((line) => inPage(line.charAt(0).toUpperCase() + line.slice(1)))));
    const runs = view.runs ?? 0;
    document.getElementById("belt-runs").hidden = runs < 2;
    if (this.#run.options.length !== runs) this.#run.replaceChildren(...Array.from({length: runs}, (_, index) => h("option", {value: index + 1}, `number ${index + 1}`)));
    this.#run.value = view.run ?? runs;
  }

  async #analyse(made) {
    const page = this.#page;
    const {folder} = page.store;
    const without = folder[WITHOUT] ? ["--without", textOf(folder[WITHOUT])] : [];
    const withHoles = made[2] ? ["--with", HOLES, ...hookOption(page.store)] : [];
    const isStale = () => made !== this.#analysed;
    const fit = await runVerb(page, ["fit", BELTS, ...withHoles, ...without, ...wishWords(page.store.view), "-o", ANCHORS, "--force"], {quiet: true, supersede: "belts"});
    if (!fit || isStale()) return;
    // Anchors that are not good enough to paste are a result all the same, with a warning that stops.
    const isWrong = fit.code !== DONE && fit.code !== CHECK_FAILED;
    page.fit = fitParts(sentencesOf(fit).map(inPage), isWrong);
    page.store.derive(isWrong ? NO_RESULTS : fit.files);
    if (isWrong) return;
    const diagnosis = await runVerb(page, ["diagnose", BELTS, ...without, "-o", "diagnosis.json", "--force"], {quiet: true, supersede: "belts"});
    if (!diagnosis || isStale()) return;
    if (diagnosis.code !== DONE) page.fit = {...page.fit, sentences: [...page.fit.sentences, ...sentencesOf(diagnosis)]};
    page.store.derive(diagnosis.code === DONE ? diagnosis.files : NO_DIAGNOSIS);
  }
}
