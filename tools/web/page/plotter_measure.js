// SPDX-License-Identifier: GPL-3.0-or-later
// The test page to draw, and the table of what a ruler and a string read on it.
import {download, folded, h} from "./dom.js";
import {DRAWING, isPlotter, jsonOf} from "./folder.js";
import {FEWEST, measuredIn, sheetText} from "./plotter.js";
import {pagePicture} from "./plotter_picture.js";
import {millimetresTyped, wordsOf} from "./plotter_text.js";
import {fitBox} from "./verdict.js";

export function plotterMeasure(page) {
  const files = h("p", {class: "buttons"});
  const how = folded("How to measure", (box) => box.append(h("pre", {tabindex: "0", "aria-label": "What to measure"}, sheetText(page.store.folder))));
  const rows = h("tbody");
  const picture = h("div", {class: "beside"});
  const said = h("div");
  const element = h("div", {hidden: true},
    h("section", {}, h("h3", {}, "Draw the test page"),
      h("p", {}, "Draw it at 100 %, never fitted to the sheet. It has nine crosses and eight lines."), files, how.element),
    h("section", {}, h("h3", {}, "Measure it"),
      h("p", {}, `Lengths with a ruler, from the middle of one cross to the middle of the other. For a bow hold a string from the line's first cross to its last, and measure from the string across to the line: plus where the line lies to the left of who walks from the first to the last. ${FEWEST} measures at least.`),
      h("div", {class: "readings"}, h("div", {class: "table-box"}, h("table", {class: "list"}, h("caption", {}, "Enter goes to the next measure; what is left empty is left out."),
        h("thead", {}, h("tr", {}, h("th", {scope: "col"}, "measure"), h("th", {scope: "col", class: "number"}, "mm"))), rows)),
      h("div", {class: "beside"}, picture, said))));
  let shownFor = null;
  let inputs = [];

  function draw(drawing) {
    const sketch = pagePicture(drawing);
    picture.replaceChildren(sketch.element);
    inputs = drawing.measures.map((measure, index) => h("input", {
      type: "text", inputmode: "text", autocomplete: "off", "aria-label": `${wordsOf(measure)}, mm`,
      onfocus: () => sketch.show(measure),
      oninput: () => page.plotter.typed(index, millimetresTyped(inputs[index].value)),
      onkeydown: (event) => {
        const step = {Enter: 1, ArrowDown: 1, ArrowUp: -1}[event.key];
        if (!step) return;
        event.preventDefault();
        inputs[index + step]?.focus();
      },
      onpaste: (event) => pasted(event, index),
    }));
    rows.replaceChildren(...drawing.measures.map((measure, index) => h("tr", {"data-measure": index}, h("th", {scope: "row"}, wordsOf(measure)), h("td", {}, inputs[index]))));
  }

  /** A column from a spreadsheet fills the rows below. */
  function pasted(event, index) {
    const values = event.clipboardData.getData("text").trim().split(/[\s;]+/);
    if (values.length < 2) return;
    event.preventDefault();
    inputs[index].value = values[0];
    values.slice(0, inputs.length - index).forEach((value, step) => page.plotter.typed(index + step, millimetresTyped(value)));
  }

  return {
    element,
    given() {
      const drawing = jsonOf(page.store.folder[DRAWING]);
      const filled = measuredIn(page.store.folder[DRAWING]);
      return drawing && filled > 0 ? `${filled} of ${drawing.measures.length} measures typed in` : "";
    },
    update() {
      const {folder, view} = page.store;
      const drawing = isPlotter(folder) ? jsonOf(folder[DRAWING]) : null;
      element.hidden = !drawing;
      if (!drawing || view.step !== "measure") return;
      const key = JSON.stringify([drawing.crosses, drawing.measures.map(wordsOf)]);
      if (shownFor !== key) {
        shownFor = key;
        how.forget();
        draw(drawing);
        files.replaceChildren(...["page.gcode", "page.svg", "sheet.txt"].filter((name) => folder[name]).map((name) =>
          h("button", {type: "button", class: name.startsWith("page") ? "main" : "", onclick: () => download(name, page.store.folder[name])}, `Download ${name}`)));
      }
      drawing.measures.forEach(({value_mm: value}, index) => {
        if (document.activeElement !== inputs[index]) inputs[index].value = value ?? "";
        if (typeof value === "string") inputs[index].setAttribute("aria-invalid", "true");
        else inputs[index].removeAttribute("aria-invalid");
      });
      const filled = measuredIn(folder[DRAWING]);
      said.replaceChildren(...(filled > 0 && filled < FEWEST ? [h("p", {class: "hint"}, `${filled} of ${FEWEST} measures at least: type on.`)] : page.fit ? fitBox(page) : []));
    },
  };
}
