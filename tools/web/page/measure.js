// SPDX-License-Identifier: GPL-3.0-or-later
// The second step: sheets to print, readings to type, and the fit as they are typed.
import {CHECK_FAILED, DONE, problemOf, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, download, h, textOf} from "./dom.js";
import {reportFrame} from "./frame.js";
import {settingsWords} from "./numbers.js";
import {Readings} from "./readings.js";
import {Sheet} from "./sheet.js";

const WAYS = [
  ["marks.csv", "Marks: x and y of each from the sheet's middle lines, with a square"],
  ["holes.csv", "Holes: distances between them, with a tape"],
  ["lengths.csv", "Chain lengths: read off the machine at each mark"],
];
/** New points for checking the map, once there is one; they are not fitted. */
export const NEW_POINTS = "five.csv";
const CHECK = [NEW_POINTS, "New points: does the map still hold?"];
/** Delay between the last key and a run of the command: the time between two keys. */
const PAUSE_MS = 350;

export function measureStep(page) {
  const said = h("div", {class: "said", role: "status", "aria-live": "polite"});
  const readings = new Readings((text, name) => {
    page.store.change({[page.store.view.sheet]: bytesOf(text)}, name && `${page.store.view.sheet} ${name}`);
    fitSoon();
  }, said);
  const print = h("div");
  const odd = h("p", {class: "hint", hidden: true}, "This list is not in the form that the command writes lists in. It is used as " +
    "it is; to change it, edit it in a spreadsheet and open it again.");
  const way = h("select", {id: "way", onchange: () => chooseWay(page, way.value)}, [...WAYS, CHECK].map(([path, label]) => h("option", {value: path}, label)));
  const unit = h("select", {id: "unit", onchange: () => page.store.show({unit: unit.value})},
    h("option", {value: "mm"}, "millimetres"), h("option", {value: "in"}, "inches"));
  const program = h("button", {type: "button", onclick: () => {
    const name = programOf(page.store.view.sheet);
    download(name, page.store.folder[name]);
  }}, "Download the program that drives there");
  const sheetButton = h("button", {type: "button", onclick: () => showSheet()}, "Show the sheet to print");
  const element = h("div", {},
    h("section", {}, h("h2", {}, "Measure"),
      h("p", {class: "choices"}, h("label", {for: "way"}, "What you read"), way),
      h("p", {class: "buttons"}, sheetButton, program),
      h("p", {class: "hint"}, "Run the program without any compensation, measure, and type what you read below. What you leave empty is left out."),
      print),
    h("section", {}, h("h2", {}, "Readings"),
      h("p", {class: "choices"}, h("label", {for: "unit"}, "You read in"), unit),
      odd, readings.element));
  let timer = null;

  function fitSoon() {
    clearTimeout(timer);
    timer = setTimeout(() => judge(page, readings, said), PAUSE_MS);
  }

  function showSheet() {
    const name = page.store.view.sheet.replace(/\.csv$/, ".html");
    const bytes = page.store.folder[name];
    if (print.firstChild || !bytes) print.replaceChildren();
    else print.replaceChildren(reportFrame(`The sheet ${name}`, name, bytes, {onDownload: () => download(name, bytes)}));
    sheetButton.textContent = print.firstChild ? "Hide the sheet" : "Show the sheet to print";
  }

  let shown = null;
  let onCauses = false;
  return {
    element,
    update() {
      const {folder, view} = page.store;
      way.value = view.sheet;
      way.lastChild.disabled = !folder["map.json"];
      unit.value = view.unit;
      program.hidden = !folder[programOf(view.sheet)];
      sheetButton.hidden = !folder[view.sheet.replace(/\.csv$/, ".html")];
      const bytes = folder[view.sheet];
      const bed = bedOf(folder);
      const sheet = bytes && bed ? Sheet.of(textOf(bytes)) : null;
      odd.hidden = sheet !== null || !bytes;
      readings.element.hidden = sheet === null;
      if (sheet) readings.draw(sheet, bed, view.unit);
      if (shown === bytes && shown !== null && onCauses === Boolean(view.causes)) return;
      shown = bytes;
      onCauses = Boolean(view.causes);
      if (sheet) fitSoon();
      else said.replaceChildren();
    },
  };
}

const programOf = (sheet) => sheet.replace(/\.csv$/, ".nc");

export function bedOf(folder) {
  try {
    const {bed} = JSON.parse(textOf(folder["machine.json"]));
    return Number(bed.width_mm) > 0 && Number(bed.height_mm) > 0 ? bed : null;
  } catch {
    return null;
  }
}

/** The list of readings for the map: the one shown, or the one shown last. */
export const fittedList = ({sheet, fitted}) => (sheet === NEW_POINTS ? fitted ?? WAYS[0][0] : sheet);

export async function chooseWay(page, path) {
  if (!page.store.folder[path] && page.store.folder["machine.json"]) {
    const what = path === NEW_POINTS ? ["--check", "map.json"] : ["--machine", "machine.json", "--measure", "lengths"];
    const result = await runVerb(page, ["plan", ...what, "-o", path,
      "--page", path.replace(/\.csv$/, ".html"), "--gcode", programOf(path), "--force"]);
    if (result?.code === DONE) page.store.derive(result.files);
    else if (result) page.alert(sentencesOf(result).join(" "));
  }
  page.store.show({sheet: path, fitted: fittedList({...page.store.view, sheet: path === NEW_POINTS ? page.store.view.sheet : path})});
}

/** The command's messages on the input so far, shown below the list and at the rows they refer to. */
async function judge(page, readings, said) {
  const {sheet: path} = page.store.view;
  const text = page.store.folder[path];
  if (!text) return;
  const list = Sheet.of(textOf(text));
  if (list && list.filled === 0) {
    readings.mark(new Map());
    said.replaceChildren(h("p", {class: "hint"}, "Nothing is typed in yet."));
    return;
  }
  const isCheck = path === NEW_POINTS;
  const words = isCheck ? ["check", "map.json", path, "--machine", "machine.json", ...settingsWords(page.store.folder)]
    : ["fit", path, "--machine", "machine.json", "-o", "map.json", "--force", "--verbose",
      ...(page.store.view.causes ? ["--causes"] : [])];
  const result = await runVerb(page, words, {quiet: true, supersede: "judge"});
  if (!result || page.store.folder[path] !== text) return;
  const sentences = sentencesOf(result);
  const problems = new Map();
  for (const sentence of sentences) markRow(problems, list, sentence, path);
  readings.mark(problems);
  const withRows = (sentence) => list?.withRows(sentence) ?? sentence;
  if (isCheck) {
    showVerdict(said, result, sentences.map(withRows), withRows);
    return;
  }
  if (result.code === DONE) page.store.derive({...result.files, "diagnosis.json": null, "diagnosis.html": null});
  else if (page.store.folder["map.json"]) page.store.derive({"map.json": null, "diagnosis.json": null, "diagnosis.html": null});
  said.className = result.code === DONE ? "said" : "said problem";
  said.replaceChildren(...outcome(page, sentences.map(withRows), result.code));
}

/** The output of a check: the verdict on the first line, the numbers below. */
function showVerdict(said, {code, stdout}, sentences, withRows) {
  const [verdict, ...numbers] = withRows(stdout).split("\n").filter((line) => line !== "");
  said.className = code === DONE ? "said" : "said problem";
  said.replaceChildren(sentenceList([verdict, ...sentences].filter(Boolean)),
    code === DONE || code === CHECK_FAILED ? h("pre", {tabindex: "0", "aria-label": "Measured less map"}, numbers.join("\n")) : "");
}

function outcome(page, sentences, code) {
  // Tables of --verbose follow the sentences after an empty line; their lines begin with blanks or are their titles.
  const end = sentences.findIndex((line) => /^Settings {3,}/.test(line));
  const plain = end < 0 ? sentences : sentences.slice(0, end);
  const tables = end < 0 ? [] : sentences.slice(end);
  return [
    sentenceList(plain),
    tables.length > 0 && h("details", {}, h("summary", {}, "The numbers"), h("pre", {tabindex: "0"}, tables.join("\n"))),
    code === DONE && h("p", {class: "buttons"},
      h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "result"})}, "See the map and the causes")),
  ].filter(Boolean);
}

/** Shows a message at the row that it refers to, by a place in the file or a point's number. */
function markRow(problems, list, sentence, path) {
  if (!list) return;
  const problem = problemOf(sentence, path);
  if (problem?.line) {
    const cell = list.cellAt(problem.line, problem.column);
    if (cell) problems.set(cell.row, {column: cell.column, text: problem.text});
    return;
  }
  const point = /^Point (\d+) /.exec(sentence);
  const between = /\b([A-Z]\d*)-([A-Z]\d*)\b/.exec(sentence);
  const row = point ? list.rowOfPoint(Number(point[1]))
    : between ? list.rows.findIndex(({cells}) => cells[0] === between[1] && cells[1] === between[2]) : -1;
  if (row >= 0) problems.set(row, {column: null, text: list.withRows(sentence)});
}
