// SPDX-License-Identifier: GPL-3.0-or-later
// The table for typing readings, next to the bed. Problems of a cell are the command's messages.
import {bedPicture} from "./bed.js";
import {problemOf} from "./command.js";
import {h} from "./dom.js";
import {inPage} from "./in_page.js";
import {millimetresOf, Sheet, shownIn} from "./sheet.js";

const WORDS = {
  order: "mark", commanded_x_mm: "sent to x", commanded_y_mm: "sent to y", x_mm: "x", y_mm: "y", left_mm: "left chain",
  right_mm: "right chain", from: "from", to: "to", distance_mm: "distance", as_commanded_mm: "about",
};

function wordOf(column, unit) {
  return `${WORDS[column] ?? column}${column.endsWith("_mm") ? ` ${unit}` : ""}`;
}

export class Readings {
  element = h("div", {class: "readings"});
  #sheet = null;
  #unit = "mm";
  #changed;
  #outcome;
  #inputs = [];
  #notes = [];
  #bed = null;
  #active = 0;
  #wrong = new Map();

  /**
   * @param changed(text, name) is called with the whole list and the name of the cell
   * @param outcome the results from the readings, shown below the bed
   */
  constructor(changed, outcome) {
    this.#changed = changed;
    this.#outcome = outcome;
  }

  /** Redraws the list, unless the table itself has just changed it. */
  draw(sheet, bed, unit) {
    if (this.#sheet && this.#sheet.text() === sheet.text() && this.#unit === unit && this.#bed?.of === bedKey(bed)) return;
    this.#sheet = sheet;
    this.#unit = unit;
    const picture = bedPicture(bed, sheet, (row) => this.#inputs[row]?.[0]?.focus());
    this.#bed = {...picture, of: bedKey(bed)};
    const wide = sheet.columns.length + 1;
    this.#inputs = [];
    this.#notes = [];
    const body = h("tbody");
    sheet.rows.forEach((_, row) => body.append(...this.#row(row, wide)));
    this.element.replaceChildren(
      h("div", {class: "table-box"}, h("table", {class: "list"},
        h("caption", {}, `${sheet.rows.length} readings. Arrow keys and Enter move; cells can be pasted from a spreadsheet.`),
        h("thead", {}, h("tr", {}, sheet.columns.map((column) => h("th", {scope: "col"}, wordOf(column, unit))))),
        body)),
      h("div", {class: "beside"}, picture.element, this.#outcome));
    this.#show();
  }

  /** @param problems Map of row -> {column or null, text} */
  mark(problems) {
    this.#wrong = problems;
    this.#show();
  }

  #row(row, wide) {
    const {cells} = this.#sheet.rows[row];
    const name = `row-${row}-note`;
    const inputs = [];
    const line = h("tr", {"data-row": row}, this.#sheet.columns.map((column, index) => {
      const text = this.#sheet.value(row, index);
      if (!this.#sheet.readColumns.includes(index)) {
        const shown = column.endsWith("_mm") ? shownIn(this.#unit, text) : text;
        return index === 0 ? h("th", {scope: "row"}, shown) : h("td", {class: "number"}, shown);
      }
      const input = h("input", {
        type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false",
        "aria-label": `${wordOf(column, this.#unit)}, row ${cells[0]}${column === "distance_mm" ? ` to ${cells[1]}` : ""}`,
        "aria-describedby": name, "data-column": index,
        oninput: () => this.#typed(row, index, input.value),
        onfocus: () => this.#enter(row),
        onkeydown: (event) => this.#key(event, row, inputs.indexOf(input)),
        onpaste: (event) => this.#paste(event, row, inputs.indexOf(input)),
      });
      input.value = shownIn(this.#unit, text);
      inputs.push(input);
      return h("td", {}, input);
    }));
    const note = h("tr", {class: "note", hidden: true}, h("td", {colspan: wide, id: name}));
    this.#inputs.push(inputs);
    this.#notes.push(note);
    return [line, note];
  }

  #typed(row, column, typed) {
    const text = this.#sheet.set(row, column, millimetresOf(typed, this.#unit));
    this.#show();
    this.#changed(text, `${row} ${column}`);
  }

  /** A row that was left half typed is judged only now. */
  #enter(row) {
    const was = this.#active;
    this.#active = row;
    this.#show();
    if (was !== row && this.#isHalf(was)) this.#changed(this.#sheet.text(), null);
  }

  #isHalf(row) {
    const filled = (this.#inputs[row] ?? []).filter(({value}) => value.trim() !== "").length;
    return filled > 0 && filled < this.#inputs[row].length;
  }

  /** Whether a row is being typed of which a number is still missing: it is not judged yet. */
  get isHalfTyped() {
    return this.#isHalf(this.#active) && this.#inputs[this.#active].includes(document.activeElement);
  }

  #key(event, row, column) {
    const input = event.target;
    const isAtEnd = input.selectionStart === input.value.length && input.selectionEnd === input.value.length;
    const isAtStart = input.selectionStart === 0 && input.selectionEnd === 0;
    const isWhole = input.selectionStart === 0 && isAtEndOf(input);
    const moves = {
      ArrowDown: [1, 0], ArrowUp: [-1, 0], Enter: [event.shiftKey ? -1 : 1, 0],
      ArrowRight: isAtEnd || isWhole ? [0, 1] : null, ArrowLeft: isAtStart || isWhole ? [0, -1] : null,
    };
    const move = moves[event.key];
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
    const target = this.#inputs[row + move[0]]?.[column + move[1]];
    event.preventDefault();
    if (!target) return;
    target.focus();
    target.select();
  }

  /** Pastes a block of a spreadsheet from this cell to the right and down; a whole list with its header over this one. */
  #paste(event, row, column) {
    const text = event.clipboardData.getData("text/plain").replace(/\r/g, "").replace(/\n+$/, "");
    if (!/[\n\t]/.test(text)) return;
    event.preventDefault();
    const whole = this.#sheet.withValuesOf(Sheet.of(text.replace(/\t/g, ",")));
    if (whole) {
      this.#changed(whole, null);
      return;
    }
    let list = this.#sheet.text();
    for (const [down, line] of text.split("\n").entries()) {
      for (const [right, cell] of line.split("\t").entries()) {
        const input = this.#inputs[row + down]?.[column + right];
        if (!input) continue;
        input.value = cell.trim();
        list = this.#sheet.set(row + down, Number(input.dataset.column), millimetresOf(cell, this.#unit));
      }
    }
    this.#show();
    this.#changed(list, null);
  }

  #show() {
    for (const [row, note] of this.#notes.entries()) {
      const problem = this.#wrong.get(row);
      note.hidden = problem === undefined;
      note.firstChild.textContent = problem?.text ?? "";
      for (const input of this.#inputs[row]) {
        const isWrong = problem !== undefined && (problem.column === null || problem.column === Number(input.dataset.column));
        if (isWrong) input.setAttribute("aria-invalid", "true");
        else input.removeAttribute("aria-invalid");
      }
    }
    this.#bed?.show({
      active: this.#active, filled: (row) => !this.#sheet.isBlank(row), wrong: (row) => this.#wrong.has(row),
    });
  }
}

function isAtEndOf(input) {
  return input.selectionEnd === input.value.length;
}

function bedKey(bed) {
  return `${bed.width_mm}x${bed.height_mm}`;
}

/** Shows a message at the row that it refers to, by a place in the file or a point's number. */
export function markRow(problems, list, sentence, path) {
  if (!list) return;
  const problem = problemOf(sentence, path);
  if (problem?.line) {
    const cell = list.cellAt(problem.line, problem.column);
    if (cell) problems.set(cell.row, {column: cell.column, text: inPage(problem.text)});
    return;
  }
  const point = /^Point (\d+) /.exec(sentence);
  const between = /\b([A-Z]\d*)-([A-Z]\d*)\b/.exec(sentence);
  const row = point ? list.rowOfPoint(Number(point[1]))
    : between ? list.rows.findIndex(({cells}) => cells[0] === between[1] && cells[1] === between[2]) : -1;
  if (row >= 0 && !problems.has(row)) problems.set(row, {column: null, text: inPage(list.withRows(sentence))});
}
