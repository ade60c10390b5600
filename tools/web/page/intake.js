// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever is opened, dropped or pasted: what it is, and which step takes it.
import {isOfBelts, splitPasted} from "./belts_text.js";
import {isProgram} from "./cut.js";
import {bytesOf, contentOf, textOf, unreadable} from "./dom.js";
import {BELTS, hasReadings, HOLES, isBelts, isPlotter, MARKS} from "./folder.js";
import {mayReplace, openZip, startFrom} from "./machine.js";
import {isOfPlotter} from "./plotter_text.js";
import {Sheet} from "./sheet.js";

const GCODE = /^\s*(?:N\d+\s*)?[GM]\d+\b/mi;
const EXPECTED = "Expected: groundcontrol.ini, webcontrol.json, a Maslow 4's log or maslow.yaml, a plotter's settings, readings (marks.csv), a G-code program, or a zip from Download.";

/** What a file is, by its content first and its name second. */
function kindOf(name, text) {
  if (/^PK\u0003\u0004/.test(text) || /\.zip$/i.test(name)) return "zip";
  if (text.trim() === "") return "empty";
  if (/^\s*(<\?xml[^>]*>\s*)?(<!--[^]*?-->\s*)?<svg\b/i.test(text)) return "picture";
  if (isOfPlotter(text)) return "plotter";
  if (isOfBelts(text)) return "belts";
  if (Sheet.of(text)) return "readings";
  if (/^\s*\{/.test(text) || /\.(ini|json|ya?ml)$/i.test(name)) return "settings";
  if (GCODE.test(text)) return "program";
  if (/^\s*\[[^\]]+\]\s*$/m.test(text)) return "settings";
  return isProgram(name) && !/\.txt$/i.test(name) ? "program" : "unknown";
}

const REFUSALS = {
  empty: (name) => `${name} is empty. ${EXPECTED}`,
  picture: (name) => `${name} is a picture. A machine's settings are text. ${EXPECTED}`,
  unknown: (name) => `${name} is neither settings nor readings nor a program. ${EXPECTED}`,
};

/** Takes files of any kind at once: settings before the readings that belong to them. */
export async function intake(page, files) {
  const read = [];
  for (const file of files) {
    const bytes = await contentOf(file);
    if (!bytes) return page.say([unreadable(file)], true);
    const text = textOf(bytes);
    const name = file.name.replace(/[^\w.-]/g, "_");
    read.push({name, bytes, text, kind: kindOf(name, text)});
  }
  const refused = read.find(({kind}) => REFUSALS[kind]);
  if (refused) return page.say([REFUSALS[refused.kind](refused.name)], true);
  const belts = read.filter(({kind}) => kind === "belts");
  const others = ["zip", "settings", "plotter"].flatMap((kind) => read.filter((one) => one.kind === kind));
  const log = belts.map(({text}) => text).join("\n");
  const isNew = others.length > 0 || (belts.length > 0 && (!isBelts(page.store.folder) || splitPasted(log).log !== null));
  if (isNew && !mayReplace(page)) return undefined;
  for (const {kind, name, bytes, text} of others) {
    const taken = kind === "zip" ? openZip(page, bytes) : kind === "plotter" ? page.plotter.take(text, name) : startFrom(page, text.includes('"chaintrue_machine"') ? "machine.json" : name, bytes, "machine");
    if (!await taken) return undefined;
  }
  if (belts.length > 0 && !await page.belts.take(log)) return undefined;
  for (const one of read.filter(({kind}) => kind === "readings")) takeReadings(page, one);
  for (const {name, bytes} of read.filter(({kind}) => kind === "program")) await page.cut.take(name, bytes);
  return undefined;
}

/** Readings go into the list with their places; a list of other places replaces the one of its kind. */
function takeReadings(page, {name, text}) {
  const {folder} = page.store;
  const given = Sheet.of(text);
  if (isPlotter(folder) || (isBelts(folder) && (!folder[BELTS] || given.isOfPoints)) || (!isBelts(folder) && !folder["machine.json"]))
    return page.say([`${name} holds readings, but there is no machine yet that they are of. Open its settings first, then ${name} again.`], true);
  const lists = Object.keys(folder).filter((path) => path.endsWith(".csv"));
  const path = lists.find((one) => Sheet.of(textOf(folder[one]))?.withValuesOf(given)) ?? (given.isOfPoints ? given.columns.includes("left_mm") ? "lengths.csv" : MARKS : HOLES);
  if (hasReadings({[path]: folder[path]}) && !confirm(`This replaces the readings in ${path}. Undo brings them back.`)) return undefined;
  page.store.change({[path]: bytesOf(text)});
  page.store.show({sheet: path, fitted: path, step: "measure"});
  return page.say([`${given.filled} of ${given.rows.length} readings were read from ${name}.`]);
}

/** A drop anywhere on the page is taken; the browser would leave the page for it. */
export function takeDrops(page) {
  const over = (is) => document.body.classList.toggle("over", is);
  addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  addEventListener("dragleave", () => over(false));
  addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    const files = [...event.dataTransfer.files];
    if (files.length > 0) intake(page, files);
  });
}

/** A text as a file of that name, for what was pasted. */
export const pasted = (text) => new File([text], "pasted.txt");
