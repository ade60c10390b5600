// SPDX-License-Identifier: GPL-3.0-or-later
// A V-plotter: its settings become a page to draw, what a ruler reads of it becomes its settings as they are.
import {DONE, runVerb, sentencesOf} from "./command.js";
import {bytesOf, textOf} from "./dom.js";
import {DRAWING, FOUND, isPlotter, jsonOf, NO_DIAGNOSIS, PLOTTER} from "./folder.js";
import {inPage} from "./in_page.js";
import {replaceFolder} from "./machine.js";
import {isDrawingText} from "./plotter_text.js";
import {fitParts} from "./verdict.js";

/** Delay between the last key and a run of the command: the time between two keys. */
const PAUSE_MS = 350;
/** With fewer measures nothing checks what is found. */
export const FEWEST = 12;
const NO_RESULTS = {[FOUND]: null, ...NO_DIAGNOSIS};
const FOLDER = "plotter";

export class Plotter {
  #page;
  #fitted = null;
  #timer = null;

  constructor(page) {
    this.#page = page;
  }

  /** Settings, a chaintrue_plotter or a filled-in drawing. True if they were read. */
  async take(text, name) {
    if (isDrawingText(text)) {
      replaceFolder(this.#page, {[DRAWING]: bytesOf(text)}, "measure");
      this.#page.say([`${name} is read: ${measuredIn(bytesOf(text))} measures are filled in.`]);
      return true;
    }
    const isOurs = /^\s*\{/.test(text);
    return this.#start(isOurs ? PLOTTER : name, bytesOf(text));
  }

  /** FluidNC's yaml, where somebody says that it hangs a pen. */
  async takeWallPlotter(name, bytes) {
    const result = await runVerb(this.#page, ["import", "plotter", name, "-o", PLOTTER, "--force"], {files: {[name]: bytes}});
    if (!result) return false;
    if (result.code !== DONE) {
      this.#page.say(sentencesOf(result).map(inPage), true);
      return false;
    }
    return this.#start(PLOTTER, result.files[PLOTTER], sentencesOf(result));
  }

  /** `chaintrue start`: the page to draw, and the list of what to measure on it. */
  async #start(name, bytes, before = []) {
    const result = await runVerb(this.#page, ["start", name, FOLDER], {files: {[name]: bytes}});
    if (!result) return false;
    const sentences = [...before, ...sentencesOf(result)].filter((line) => !/holds the test page/.test(line)).map((line) => inPage(line.replace(`${name}: `, "")));
    if (result.code !== DONE) {
      this.#page.say(sentences, true);
      return false;
    }
    const made = Object.fromEntries(Object.entries(result.files).map(([path, content]) => [path.replace(`${FOLDER}/`, ""), content]));
    replaceFolder(this.#page, {[name]: bytes, ...made}, "machine");
    this.#page.store.show({assumed: sentences});
    this.#page.say([`${name} is read. Check what was assumed, then go on to measuring.`]);
    return true;
  }

  given() {
    const {folder, view} = this.#page.store;
    const set = jsonOf(folder[DRAWING])?.set;
    if (!set) return "";
    const assumed = (view.assumed ?? []).length;
    return `${set.firmware === "mural" ? "mural" : `Plotter with ${set.firmware}`}: pins ${Math.round(set.machine.pin_spacing_mm)} mm apart` +
      `${assumed > 0 ? `; ${assumed} thing${assumed > 1 ? "s" : ""} assumed` : ""}`;
  }

  /** A measure's value by its place in the list. */
  typed(index, value) {
    const drawing = jsonOf(this.#page.store.folder[DRAWING]);
    const measures = drawing.measures.map((measure, place) => (place === index ? {...measure, value_mm: value} : measure));
    this.#page.store.change({[DRAWING]: bytesOf(`${JSON.stringify({...drawing, measures}, null, 2)}\n`), ...NO_RESULTS}, `${DRAWING} ${index}`);
  }

  /** What is typed becomes the settings and the causes, undo and reload included. */
  update() {
    const {folder} = this.#page.store;
    const drawing = isPlotter(folder) ? folder[DRAWING] : null;
    if (drawing === this.#fitted) return;
    this.#fitted = drawing;
    if (drawing) this.#page.fit = null;
    clearTimeout(this.#timer);
    if (!drawing || measuredIn(drawing) === 0) return;
    this.#timer = setTimeout(() => this.#fit(drawing), PAUSE_MS);
  }

  async #fit(drawing) {
    const page = this.#page;
    const isStale = () => drawing !== this.#fitted;
    if (isStale()) return;
    if (measuredIn(drawing) < FEWEST) return;
    const fit = await runVerb(page, ["fit", DRAWING, "-o", FOUND, "--force"], {quiet: true, supersede: "plotter"});
    if (!fit || isStale()) return;
    const isDone = fit.code === DONE;
    page.fit = fitParts(sentencesOf(fit).map((line) => capital(inPage(line.replace(`${DRAWING}: `, "")))), !isDone);
    page.store.derive(isDone ? fit.files : {[FOUND]: null});
    // A slip of the hand has no cause in the plotter; settings that fit nothing may have one.
    if (!isDone && !fit.stderr.includes("no settings explain this drawing")) return;
    const diagnosis = await runVerb(page, ["diagnose", DRAWING, "-o", "diagnosis.json", "--force"], {quiet: true, supersede: "plotter"});
    if (!diagnosis || isStale()) return;
    page.store.derive(diagnosis.code === DONE ? diagnosis.files : NO_DIAGNOSIS);
  }

  /** The page for the plotter with the numbers typed in. */
  async secondPage() {
    const page = this.#page;
    const result = await runVerb(page, ["start", FOUND, FOLDER], {files: {[FOUND]: page.store.folder[FOUND]}});
    if (!result) return;
    if (result.code !== DONE) {
      page.alert(sentencesOf(result).map(inPage).join(" "));
      return;
    }
    const made = Object.fromEntries(Object.entries(result.files).map(([path, content]) => [path.replace(`${FOLDER}/`, ""), content]));
    page.store.change({...made, ...NO_RESULTS});
    page.store.show({step: "measure", typed: false, way: null});
  }
}

const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** How many measures have a value. */
export const measuredIn = (bytes) => (jsonOf(bytes)?.measures ?? []).filter(({value_mm: value}) => value !== null && value !== undefined).length;

export const sheetText = (folder) => (folder["sheet.txt"] ? textOf(folder["sheet.txt"]) : "");
