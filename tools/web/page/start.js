// SPDX-License-Identifier: GPL-3.0-or-later
// The first screen: what calibration does to a part, three tiles for three kinds of machine, and examples that open at their result.
import {bytesOf, fileButton, h, svg} from "./dom.js";
import {intake, pasted} from "./intake.js";
import {fromTemplate, mayReplace, startFrom} from "./machine.js";
import {errorPicture} from "./picture.js";
import {pagePicture} from "./plotter_picture.js";
import {Sheet} from "./sheet.js";

/** Readings of fixtures/start, and what is wrong with the machine that they are of. */
const EXAMPLES = [
  ["worn_chain", "A worn chain"], ["bent_beam", "A beam that bends"], ["long_tape", "A tape that is too long"],
  ["slipped_tooth", "A chain that jumped a tooth"], ["nothing_wrong", "Nothing wrong"], ["maslow4", "A Maslow 4"], ["plotter", "A pen plotter"],
];
const BED = {width_mm: 2438.4, height_mm: 1219.2};

/** A rectangle as drawn, dashed, and as it is cut; the error is drawn many times too large. */
function part(words, cut, style) {
  return h("figure", {}, svg("svg", {viewBox: "0 0 200 110", class: "part", role: "img", "aria-label": words},
    svg("rect", {class: "drawn", x: 30, y: 20, width: 140, height: 70}), svg("path", {class: style, d: cut})), h("figcaption", {}, words));
}

function tile(page, title, where, {id, label, accept, paste, more}) {
  const box = paste && h("textarea", {id: paste.id, rows: 3, spellcheck: "false", autocomplete: "off", "aria-label": paste.label, placeholder: paste.label,
    onpaste: () => setTimeout(() => read(), 0)});
  const read = () => box.value.trim() !== "" && intake(page, [pasted(box.value)]);
  return h("section", {class: "tile"}, h("h3", {}, title), h("p", {class: "hint"}, where),
    h("p", {class: "buttons"}, fileButton(id, label, accept, (files) => intake(page, files)), more), box,
    box && h("p", {class: "buttons"}, h("button", {type: "button", onclick: read}, "Read the box")));
}

export function startPart(page) {
  return h("div", {class: "start"},
    h("section", {class: "hero"}, part("Today: the part comes out bowed and out of square.", "M 26 26 Q 100 8 176 14 Q 166 56 178 96 Q 100 84 24 88 Q 34 56 26 26 Z", "bad"),
      part("Calibrated: the part is what you drew.", "M 30 20 H 170 V 90 H 30 Z", "good"),
      h("div", {}, h("p", {}, "chaintrue finds out why a hanging router or plotter is off, and corrects it. It takes an hour, a sheet, and a tape or a square."),
        h("p", {class: "hint"}, "Open the machine's settings, measure what it did, read the " +
                                "result, then type in a few numbers or let your programs be " +
                                "corrected. Nothing leaves this computer."))),
    h("div", {class: "tiles"},
      tile(page, "Two chains", "Maslow classic. groundcontrol.ini is in your home folder; WebControl keeps webcontrol.json in .WebControl there.",
        {id: "settings", label: "Open the settings", accept: ".ini,.json,.yaml,.yml,.zip", more: h("button", {type: "button", onclick: () => fromTemplate(page)}, "Type the numbers in")}),
      tile(page, "Four belts", "Maslow 4. maslow.yaml is in the machine's own file list; the log is what its terminal shows while it finds its anchors.",
        {id: "belts-files", label: "Open log and maslow.yaml", accept: ".txt,.log,.yaml,.yml,.zip", paste: {id: "paste", label: "or paste both here, in any order"}}),
      tile(page, "A pen", "V-plotter. A mural shows three numbers; Marlin answers M503; Polargraph keeps a properties file.",
        {id: "plotter-files", label: "Open its settings", accept: ".txt,.h,.properties,.yaml,.yml,.json,.zip", paste: {id: "paste-plotter", label: "or paste them here"}})),
    h("section", {}, h("h3", {}, "Or look at an example"), h("div", {class: "gallery"}, EXAMPLES.map(([name, title]) =>
      h("button", {type: "button", "aria-label": title, onclick: () => openExample(page, name)}, thumbnail(page.example, name), title)))));
}

/** What was read on the example, small. */
function thumbnail({examples, drawing}, name) {
  if (name === "plotter") return pagePicture(JSON.parse(drawing), true).element;
  if (name === "maslow4") {
    return svg("svg", {viewBox: "0 0 200 120", "aria-hidden": "true"}, svg("rect", {class: "board", x: 20, y: 14, width: 160, height: 92}),
      svg("path", {class: "belts", d: "M 20 14 L 180 106 M 180 14 L 20 106"}), svg("circle", {class: "sled", cx: 100, cy: 60, r: 15}));
  }
  const sheet = Sheet.of(examples[name]);
  const points = sheet.rows.map((_, row) => {
    const [x, y, readX, readY] = [1, 2, 3, 4].map((column) => Number(sheet.value(row, column)));
    return {x_mm: x, y_mm: y, error: [readX - x, readY - y]};
  });
  return errorPicture(BED, points, ({error}) => error, null, {label: ""}).firstChild;
}

async function openExample(page, name) {
  if (!mayReplace(page)) return;
  const {examples, drawing, "groundcontrol.ini": settings, "bracket.nc": program} = page.example;
  if (name === "maslow4") await page.belts.take(examples.maslow4);
  else if (name === "plotter") await page.plotter.take(drawing, "drawing.json");
  else if (await startFrom(page, "groundcontrol.ini", bytesOf(settings), "machine")) page.store.change({"marks.csv": bytesOf(examples[name]), "bracket.nc": bytesOf(program)});
  page.say([]);
  page.store.show({step: "result", isExample: true});
}
