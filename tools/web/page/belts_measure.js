// SPDX-License-Identifier: GPL-3.0-or-later
// The readings of four belts place by place, and holes with a tape besides them.
import {leftOut} from "./belts.js";
import {beltsPicture, CORNER_NAMES, CORNERS, frameOf, isBad} from "./belts_picture.js";
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, download, folded, h, textOf} from "./dom.js";
import {ANCHORS, BELTS, filledIn, HOLES, isBelts, jsonOf, WITHOUT} from "./folder.js";
import {reportFrame} from "./frame.js";
import {hookTick} from "./hook.js";
import {howToMeasure} from "./how.js";
import {inPage, sheetInPage} from "./in_page.js";
import {markRow, Readings} from "./readings.js";
import {Sheet} from "./sheet.js";
import {fitBox} from "./verdict.js";
import {WishBox} from "./wish.js";

/** From the outermost place that was measured to the outermost hole's sheet edge, as plan takes it on a small bed. */
const EDGE_MM = 100;

export function beltsMeasure(page) {
  const places = h("div");
  const holes = new HolesPart(page);
  const wish = new WishBox(page, "belts-wish");
  const element = h("div", {hidden: true},
    h("section", {}, h("h3", {}, "The readings of the log"),
      h("p", {}, "One line for each place; what does not fit the others is marked. A place that you do not trust can be left out."),
      h("p", {class: "choices"}, wish.element), places),
    holes.element);
  const remembered = new Map();
  let drawn = [];
  return {
    element,
    given() {
      const {folder} = page.store;
      const points = jsonOf(folder[BELTS])?.points.length;
      if (!points) return "";
      const out = leftOut(folder);
      const filled = filledIn(folder[HOLES]);
      return [`${points} places`, out.length > 0 && `left out: ${out.join(", ")}`, filled > 0 && `${filled} distances between holes`].filter(Boolean).join("; ");
    },
    update() {
      const {folder, view} = page.store;
      element.hidden = !isBelts(folder) || !folder[BELTS];
      if (element.hidden || view.step !== "measure") return;
      holes.update(page.store);
      wish.update(page.store);
      const known = frameOf(folder);
      const now = [folder[ANCHORS], folder["diagnosis.json"], folder[BELTS], folder[WITHOUT], page.fit];
      if (now.every((one, index) => one === drawn[index]) || !known) return;
      // While the anchors are found anew the last picture stays.
      if (!known.anchors && !page.fit?.isWrong && places.firstChild) return;
      if (now[2] !== drawn[2]) remembered.clear();
      drawn = now;
      const focused = document.activeElement?.id;
      places.replaceChildren(h("div", {class: "readings"}, h("div", {class: "table-box"}, placesTable(known, (point) => page.belts.toggle(point))),
        h("div", {class: "beside"}, known.anchors ? beltsPicture(known, (point) => page.belts.toggle(point), remembered)
          : "", page.fit ? fitBox(page) : "")));
      if (focused?.startsWith("leave-")) document.getElementById(focused)?.focus({preventScroll: true});
    },
  };
}

function placesTable({places}, toggle) {
  return h("table", {class: "places"}, h("caption", {}, "Lengths in mm; in brackets the " +
                                                        "difference of a wrong one from the " +
                                                        "prediction by the others."),
    h("thead", {}, h("tr", {}, h("th", {scope: "col"}, "place"), CORNERS.map((corner) => h("th", {scope: "col", class: "number"}, CORNER_NAMES[corner])),
      h("th", {scope: "col"}, "leave out"))),
    h("tbody", {}, places.map((place) => {
      const {point, reading, isOut} = place;
      return h("tr", {class: [isOut && "out", isBad(place) && "wrong"].filter(Boolean).join(" "), "data-point": point},
        h("th", {scope: "row"}, String(point)),
        CORNERS.map((corner) => h("td", {class: place.bad?.[corner] ? "number wrong" : "number"}, String(reading[`${corner}_mm`]),
          place.bad?.[corner] && ` (${place.off[corner] >= 0 ? "+" : "\u2212"}${Math.abs(place.off[corner]).toFixed(1)})`)),
        h("td", {}, h("input", {type: "checkbox", id: `leave-${point}`, "aria-label": `Leave place ${point} out`, checked: isOut, onchange: () => toggle(point)})));
    })));
}

/** Holes that the machine cut, with the tape's distances between them: the size of everything, and where the tool really is. */
class HolesPart {
  #page;
  #said = h("div", {class: "said", role: "status"});
  #readings;
  #hook;
  #print = h("div");
  #list = h("div", {hidden: true});
  #plan;
  element;
  #shown = {};

  constructor(page) {
    this.#page = page;
    this.#readings = new Readings((text, name) => page.store.change({[HOLES]: bytesOf(text)}, name && `${HOLES} ${name}`), this.#said);
    this.#hook = hookTick(page);
    this.#plan = h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => this.#planned()}, "Plan nine holes"));
    const how = folded("How to measure", (box) => box.append(howToMeasure(HOLES)));
    this.#list.append(h("p", {class: "buttons"},
      h("button", {type: "button", onclick: () => this.#sheet()}, "Show or hide the sheet to print"),
      h("button", {type: "button", onclick: () => download("holes.nc", page.store.folder["holes.nc"])}, "Download the program that cuts them")),
    how.element, this.#print, h("p", {class: "choices"}, this.#hook.element), this.#readings.element);
    this.element = h("section", {}, h("h3", {}, "Holes and a tape"),
      h("p", {}, "Belts alone do not show the scale, nor where the tool really cuts. Nine holes " +
                 "and a tape do, and give the map for compensating programs."),
      this.#plan, this.#list);
  }

  update({folder, view}) {
    const bytes = folder[HOLES];
    const sheet = bytes ? Sheet.of(textOf(bytes)) : null;
    this.#plan.hidden = Boolean(bytes);
    this.#list.hidden = !sheet;
    if (!sheet) return;
    this.#hook.update({view: {...view, sheet: HOLES}});
    this.#readings.draw(sheet, extentOf(folder), "mm");
    const {fit} = this.#page;
    if (this.#shown.bytes === bytes && this.#shown.fit === fit) return;
    this.#shown = {bytes, fit};
    const problems = new Map();
    const about = sheet.filled === 0 || !fit ? [] : [...fit.sentences, ...fit.tables].filter((line) => /hole|tape|distance|Scale/i.test(line));
    for (const line of about) markRow(problems, sheet, line, HOLES);
    this.#readings.mark(problems);
    this.#said.className = fit?.isWrong ? "said bad" : "said";
    this.#said.replaceChildren(...(about.length > 0 ? [sentenceList(about.map(inPage))] : []));
  }

  /** The holes lie over what the log covers: `plan` sets them on a sheet of that size. */
  async #planned() {
    const page = this.#page;
    const template = await runVerb(page, ["start", "."], {files: {}});
    if (template?.code !== DONE) return;
    const machine = jsonOf(template.files["machine.json"]);
    const sheet = bytesOf(JSON.stringify({...machine, name: "Maslow 4", bed: extentOf(page.store.folder)}));
    const plan = await runVerb(page, ["plan", "--machine", "sheet.json", "--holes", "9", "-o", HOLES, "--page", "holes.html", "--gcode", "holes.nc"], {files: {"sheet.json": sheet}});
    if (!plan) return;
    if (plan.code === DONE) page.store.change(plan.files);
    else page.alert(sentencesOf(plan).map(inPage).join(" "));
  }

  #sheet() {
    const bytes = this.#page.store.folder["holes.html"];
    if (this.#print.firstChild || !bytes) this.#print.replaceChildren();
    else this.#print.replaceChildren(reportFrame("The sheet holes.html", "holes.html", bytesOf(sheetInPage(textOf(bytes))), {onDownload: () => download("holes.html", bytes)}));
  }
}

/** The sheet about the commanded places, its middle where the diagonals cross. */
function extentOf(folder) {
  const points = jsonOf(folder[BELTS])?.points ?? [];
  const half = (key) => Math.max(...points.map((point) => Math.abs(point[key] ?? 0)));
  const [x, y] = [half("commanded_x_mm"), half("commanded_y_mm")];
  const whole = (mm, usual) => (mm > 0 ? Math.round(2 * (mm + EDGE_MM)) : usual);
  return {width_mm: whole(x, 2438), height_mm: whole(y, 1219)};
}
