// SPDX-License-Identifier: GPL-3.0-or-later
// What the folder holds: which machine, which lists, which results are of them.
import {textOf} from "./dom.js";
import {Sheet} from "./sheet.js";

export const MARKS = "marks.csv";
export const HOLES = "holes.csv";
/** New points for checking the map, once there is one; they are not fitted. */
export const NEW_POINTS = "five.csv";

/** Four belts: what they are read from, and the places that are left out by hand. */
export const LOG = "log.txt";
export const MASLOW_SETTINGS = "maslow.yaml";
export const BELTS = "belts.json";
export const ANCHORS = "anchors.json";
export const WITHOUT = "without.txt";
/** What the machine believes once the lines are pasted. */
export const PASTED = "pasted.json";

/** A V-plotter: as its controller holds it, its test drawing, and what was found of it. */
export const PLOTTER = "plotter.json";
export const DRAWING = "drawing.json";
export const FOUND = "found.json";

/** A cause of the owner's own, as typed; laws that were kept have files of their own. */
export const OWN_EFFECT = "own_effect.json";
const lawFile = (number) => (number === 1 ? "law_effect.json" : `law_effect_${number}.json`);
export const ownEffects = (folder) => Object.keys(folder).filter((name) => folder[name] && (name === OWN_EFFECT || /^law_effect(_\d+)?\.json$/.test(name))).sort();

/** Of the next law that is kept. */
export function nextLawFile(folder) {
  let number = 1;
  while (folder[lawFile(number)]) number += 1;
  return lawFile(number);
}

/** Of files that other readings make stale; an undo brings them back with the readings that they are of. */
export const NO_DIAGNOSIS = {"diagnosis.json": null, "diagnosis.html": null};

export const isBelts = (folder) => Boolean(folder[BELTS] || folder[MASLOW_SETTINGS]);
export const isPlotter = (folder) => Boolean(folder[DRAWING]);
/** Which of the three machines it is. */
export const roadOf = (folder) => (isBelts(folder) ? "belts" : isPlotter(folder) ? "plotter" : "chains");
/** What a program is compensated with. */
export const mapOf = (folder) => ({belts: ANCHORS, plotter: FOUND, chains: "map.json"})[roadOf(folder)];
export const programOf = (sheet) => sheet.replace(/\.csv$/, ".nc");

/** The list of readings for the map: the one shown, or the one shown last. */
export const fittedList = ({sheet, fitted}) => (sheet === NEW_POINTS ? fitted ?? MARKS : sheet);

/** Files are never changed in place: the same object is the same file. */
const parsed = new WeakMap();

/** A file's content; null for no file and for one that is no JSON: the command says what is wrong with that. */
export function jsonOf(bytes) {
  if (!bytes) return null;
  if (!parsed.has(bytes)) {
    let content = null;
    try {
      content = JSON.parse(textOf(bytes));
    } catch {
      // null
    }
    parsed.set(bytes, content);
  }
  return parsed.get(bytes);
}

export function bedOf(folder) {
  const bed = jsonOf(folder["machine.json"])?.bed;
  return bed && Number(bed.width_mm) > 0 && Number(bed.height_mm) > 0 ? bed : null;
}

/** Rows of a list that are filled in. */
export const filledIn = (bytes) => (bytes ? Sheet.of(textOf(bytes))?.filled ?? 0 : 0);

/** True if readings were typed into a list: they are not discarded without a question. */
export function hasReadings(folder) {
  const isRuled = (jsonOf(folder[DRAWING])?.measures ?? []).some(({value_mm: value}) => value !== null && value !== undefined);
  return isRuled || Boolean(folder[BELTS]) || Object.entries(folder).some(([path, bytes]) => path.endsWith(".csv") && filledIn(bytes) > 0);
}
