// SPDX-License-Identifier: GPL-3.0-or-later
// The second step: sheets to print, readings to type, and the fit as they are typed.
import {CHECK_FAILED, DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {beltsMeasure} from "./belts_measure.js";
import {bytesOf, download, folded, h, textOf} from "./dom.js";
import {bedOf, fittedList, HOLES, isBelts, isPlotter, MARKS, NEW_POINTS, NO_DIAGNOSIS, programOf} from "./folder.js";
import {reportFrame} from "./frame.js";
import {howToMeasure} from "./how.js";
import {hookTick, hookWords} from "./hook.js";
import {inPage, sheetInPage} from "./in_page.js";
import {ownWords} from "./own_effect.js";
import {plotterMeasure} from "./plotter_measure.js";
import {markRow, Readings} from "./readings.js";
import {Sheet} from "./sheet.js";
import {settingsWords} from "./type_in.js";
import {fitBox, fitParts} from "./verdict.js";
import {WishBox, wishWords} from "./wish.js";

const WAYS = [
  [MARKS, "Marks: x and y of each from the sheet's middle lines, with a square"],
  [HOLES, "Holes: distances between them, with a tape"],
  ["lengths.csv", "Chain lengths: read off the machine at each mark"],
];
const CHECK = [NEW_POINTS, "New points: is the map still valid?"];
/** Delay between the last key and a run of the command: the time between two keys. */
const PAUSE_MS = 350;

export function measureStep(page) {
  const said = h("div");
  const readings = new Readings((text, name) => {
    page.store.change({[page.store.view.sheet]: bytesOf(text), ...NO_DIAGNOSIS}, name && `${page.store.view.sheet} ${name}`);
    fitSoon();
  }, said);
  const print = h("div");
  const odd = h("p", {class: "hint", hidden: true}, "This list is not in the form that the command writes lists in. It is used as " +
    "it is; to change it, edit it in a spreadsheet and open it again.");
  const way = h("select", {id: "way", onchange: () => chooseWay(page, way.value)}, [...WAYS, CHECK].map(([path, label]) => h("option", {value: path}, label)));
  const unit = h("select", {id: "unit", onchange: () => page.store.show({unit: unit.value})},
    h("option", {value: "mm"}, "millimetres"), h("option", {value: "in"}, "inches"));
  const wish = new WishBox(page, "wish");
  const program = h("button", {type: "button", onclick: () => {
    const name = programOf(page.store.view.sheet);
    download(name, page.store.folder[name]);
  }}, "Download the program that drives there");
  const sheetButton = h("button", {type: "button", onclick: () => showSheet()}, "Show the sheet to print");
  const how = folded("How to measure", (box) => box.append(howToMeasure(page.store.view.sheet)));
  const hook = hookTick(page);
  const ofChains = h("div", {},
    h("section", {}, h("h3", {}, "Measure"),
      h("p", {class: "choices"}, h("label", {for: "way"}, "What you read"), way),
      h("p", {class: "buttons"}, sheetButton, program),
      h("p", {class: "hint"}, "Run the program without any compensation, measure, and type what you read below. What you leave empty is left out."),
      how.element, print),
    h("section", {}, h("h3", {}, "Readings"),
      h("p", {class: "choices"},
        h("span", {class: "pair"}, h("label", {for: "unit"}, "You read in"), unit), hook.element, wish.element),
      odd, readings.element));
  const ofBelts = beltsMeasure(page);
  const ofPlotter = plotterMeasure(page);
  const element = h("div", {}, ofChains, ofBelts.element, ofPlotter.element);
  let timer = null;

  function fitSoon() {
    clearTimeout(timer);
    timer = setTimeout(() => judge(page, readings, said), PAUSE_MS);
  }

  function showSheet() {
    const name = page.store.view.sheet.replace(/\.csv$/, ".html");
    const bytes = page.store.folder[name];
    if (print.firstChild || !bytes) print.replaceChildren();
    else print.replaceChildren(reportFrame(`The sheet ${name}`, name, bytesOf(sheetInPage(textOf(bytes))), {onDownload: () => download(name, bytes)}));
    sheetButton.textContent = print.firstChild ? "Hide the sheet" : "Show the sheet to print";
  }

  let shown = null;
  let shownHow = null;
  let fittedWith = "";
  let shownRead = null;
  return {
    element,
    given: () => (isBelts(page.store.folder) ? ofBelts.given() : isPlotter(page.store.folder) ? ofPlotter.given() : given(page.store)),
    update() {
      const {folder, view} = page.store;
      ofBelts.update();
      ofPlotter.update();
      ofChains.hidden = isBelts(folder) || isPlotter(folder);
      if (ofChains.hidden) return;
      way.value = view.sheet;
      way.lastChild.disabled = !folder["map.json"];
      unit.value = view.unit;
      program.hidden = !folder[programOf(view.sheet)];
      sheetButton.hidden = !folder[view.sheet.replace(/\.csv$/, ".html")];
      const bytes = folder[view.sheet];
      const bed = bedOf(folder);
      const sheet = bytes && bed ? Sheet.of(textOf(bytes)) : null;
      odd.hidden = sheet !== null || !bytes;
      hook.update(page.store);
      if (shownHow !== view.sheet) {
        shownHow = view.sheet;
        how.forget();
        how.element.open = sheet !== null && sheet.filled === 0;
      }
      readings.element.hidden = sheet === null;
      if (sheet) readings.draw(sheet, bed, view.unit);
      wish.update(page.store);
      const fitWith = [view.sheet, ...wishWords(view), ...hookWords(page.store)].join(" ");
      if (view.read !== shownRead && page.fit && view.sheet !== NEW_POINTS) said.replaceChildren(...fitBox(page));
      shownRead = view.read;
      if (shown === bytes && shown !== null && fittedWith === fitWith) return;
      shown = bytes;
      // An answer to an earlier wish does not answer this one.
      if (fittedWith !== fitWith) said.replaceChildren(h("p", {class: "hint"}, "Being computed ..."));
      fittedWith = fitWith;
      if (view.sheet !== NEW_POINTS) page.fit = null;
      if (sheet) {
        fitSoon();
        return;
      }
      said.replaceChildren();
    },
  };
}

/** The line of the folded step. */
function given({folder, view}) {
  const path = fittedList(view);
  const sheet = folder[path] ? Sheet.of(textOf(folder[path])) : null;
  if (!sheet || sheet.filled === 0) return "";
  return `${sheet.filled} of ${sheet.rows.length} ${sheet.isOfPoints ? "marks" : "distances"} typed in`;
}

export async function chooseWay(page, path) {
  if (!page.store.folder[path] && page.store.folder["machine.json"]) {
    const what = path === NEW_POINTS ? ["--check", "map.json"] : ["--machine", "machine.json", "--measure", "lengths"];
    const result = await runVerb(page, ["plan", ...what, "-o", path,
      "--page", path.replace(/\.csv$/, ".html"), "--gcode", programOf(path), "--force"]);
    if (result?.code === DONE) page.store.derive(result.files);
    else if (result) page.alert(sentencesOf(result).join(" "));
  }
  if (path !== NEW_POINTS && path !== fittedList(page.store.view)) page.store.derive(NO_DIAGNOSIS);
  page.store.show({sheet: path, fitted: fittedList({...page.store.view, sheet: path === NEW_POINTS ? page.store.view.sheet : path})});
}

/** The command's messages on the input so far, shown below the list and at the rows they refer to. */
async function judge(page, readings, said) {
  const {sheet: path} = page.store.view;
  const text = page.store.folder[path];
  if (!text || readings.isHalfTyped) return;
  const list = Sheet.of(textOf(text));
  if (list && list.filled === 0) {
    readings.mark(new Map());
    said.replaceChildren(h("p", {class: "hint"}, "Nothing is typed in yet."));
    return;
  }
  const added = list?.withPlacesAdded();
  if (added) {
    said.replaceChildren(h("div", {class: "said caution", role: "status"}, h("p", {}, "These numbers look like errors, not like places. Type where each mark is, counted from the middle lines."),
      h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => page.store.change({[path]: bytesOf(added)})}, "They are errors: add the places that were sent"))));
    return;
  }
  const isCheck = path === NEW_POINTS;
  const words = isCheck ? ["check", "map.json", path, "--machine", "machine.json", ...settingsWords(page.store.folder)]
    : ["fit", path, "--machine", "machine.json", "-o", "map.json", "--force", "--verbose",
      ...wishWords(page.store.view), ...ownWords(page.store.folder), ...hookWords(page.store)];
  const result = await runVerb(page, words, {quiet: true, supersede: "judge"});
  if (!result || page.store.folder[path] !== text) return;
  const sentences = sentencesOf(result);
  const problems = new Map();
  for (const sentence of sentences) markRow(problems, list, sentence, path);
  readings.mark(problems);
  const withRows = (sentence) => inPage(list?.withRows(sentence) ?? sentence);
  if (isCheck) {
    showCheck(page, said, result, sentences.map(withRows), withRows);
    return;
  }
  const isDone = result.code === DONE;
  page.fit = fitParts(sentences.map(withRows), !isDone);
  said.replaceChildren(...fitBox(page));
  page.store.derive(isDone ? result.files : {"map.json": null, ...NO_DIAGNOSIS});
}

/** A check's verdict, the next step, and the numbers below. */
function showCheck(page, said, {code, stdout}, sentences, withRows) {
  const [verdict, ...numbers] = withRows(stdout).split("\n").filter((line) => line !== "");
  const again = () => chooseWay(page, fittedList(page.store.view));
  const go = (words, onclick) => h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick}, words));
  said.replaceChildren(h("div", {class: `said ${code === DONE ? "good" : "bad"}`, role: "status"}, sentenceList([verdict, ...sentences].filter(Boolean)),
    code === DONE ? go("Go on to your programs", () => page.store.show({step: "cut"})) : code === CHECK_FAILED ? go("Measure the whole bed again", again) : ""),
  code === DONE || code === CHECK_FAILED ? h("details", {}, h("summary", {}, "The numbers"), h("pre", {tabindex: "0", "aria-label": "Measured less map"}, numbers.join("\n"))) : "");
}
