// SPDX-License-Identifier: GPL-3.0-or-later
// A list of the command (marks.csv, holes.csv, five.csv) as cells, and back; unchanged parts keep their bytes.

/** The columns that the user fills in, of the first kind of list that has them. */
const READ = [["distance_mm"], ["left_mm", "right_mm"], ["x_mm", "y_mm"]];

const isNote = (line) => line === "" || line.startsWith("#");
/** The cells of a line, quotes included. The pattern matches one more empty cell after the line's end. */
const cellsOf = (line) => line.match(/("(?:[^"]|"")*"|[^,"]*)(?:,|$)/g)
  .slice(0, line.endsWith(",") ? undefined : -1).map((cell) => cell.replace(/,$/, ""));
const quoted = (text) => (/[",]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const unquoted = (cell) => (cell.startsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell);
const isHeader = (cells) => cells.some((cell) => cell.endsWith("_mm"));

/** Larger numbers in a list are positions. */
const LARGEST_ERROR_MM = 60;

export class Sheet {
  /** Rows to fill in: {line (from 0), cells}. */
  rows = [];
  columns = [];
  readColumns = [];
  /** Positions by the name of their row: hole A, or the row's number. */
  places = [];
  #lines;

  /** Null if the text is not in the format of the command's lists. */
  static of(text) {
    const lines = text.split("\n").filter((line) => !isNote(line));
    if (lines.length === 0 || /[";\t\r]/.test(lines[0])) return null;
    if (lines.some((line) => cellsOf(line).join(",") !== line)) return null;
    const sheet = new Sheet(text);
    return sheet.rows.length > 0 ? sheet : null;
  }

  constructor(text) {
    this.#lines = text.split("\n");
    const tables = [];
    this.#lines.forEach((line, index) => {
      if (isNote(line)) return;
      const cells = cellsOf(line);
      if (isHeader(cells)) tables.push({columns: cells, rows: []});
      else tables.at(-1)?.rows.push({line: index, cells});
    });
    for (const wanted of READ) {
      const table = tables.find(({columns}) => wanted.every((column) => columns.includes(column)));
      if (!table) continue;
      this.rows = table.rows;
      this.columns = table.columns;
      this.readColumns = wanted.map((column) => table.columns.indexOf(column));
      break;
    }
    this.places = placesOf(tables);
  }

  text() {
    return this.#lines.join("\n");
  }

  /** Sets a cell; returns the text of the whole list. */
  set(row, column, value) {
    const {line, cells} = this.rows[row];
    cells[column] = quoted(value);
    this.#lines[line] = cells.join(",");
    return this.text();
  }

  /** The text of this list with the readings of another one of the same places, null for other places. */
  withValuesOf(other) {
    const placeOf = (sheet, row) => sheet.columns.flatMap((_, index) => (sheet.readColumns.includes(index) ? [] : [sheet.value(row, index)])).join();
    if (!other || other.columns.join() !== this.columns.join() || other.rows.some((_, row) => !this.rows[row] || placeOf(other, row) !== placeOf(this, row))) return null;
    const changed = new Sheet(this.text());
    for (const row of other.rows.keys()) for (const column of this.readColumns) changed.set(row, column, other.value(row, column));
    return changed.text();
  }

  /** The text with the places added to readings that are errors, not positions; null where they are positions. */
  withPlacesAdded() {
    if (!this.isOfPoints || !this.columns.includes("x_mm")) return null;
    const number = (row, column) => Number(this.value(row, column));
    const rows = this.rows.map((_, row) => row).filter((row) => !this.isBlank(row));
    const isError = (row) => this.readColumns.every((column) => Math.abs(number(row, column)) <= LARGEST_ERROR_MM);
    const isFar = (row) => this.readColumns.some((column) => Math.abs(number(row, column - 2)) > 2 * LARGEST_ERROR_MM);
    if (rows.length < 4 || !rows.every(isError) || !rows.some(isFar)) return null;
    const changed = new Sheet(this.text());
    for (const row of rows) for (const column of this.readColumns) changed.set(row, column, plain(number(row, column) + number(row, column - 2), 3));
    return changed.text();
  }

  value(row, column) {
    return unquoted(this.rows[row].cells[column] ?? "");
  }

  isBlank(row) {
    return this.readColumns.every((column) => (this.rows[row].cells[column] ?? "").trim() === "");
  }

  get filled() {
    return this.rows.filter((_, row) => !this.isBlank(row)).length;
  }

  /** The row and column of a place in the text, given as the command's line and column, from 1. */
  cellAt(line, column) {
    const row = this.rows.findIndex((one) => one.line === line - 1);
    if (row < 0) return null;
    let end = 0;
    for (const [index, cell] of this.rows[row].cells.entries()) {
      end += cell.length + 1;
      if (column <= end) return {row, column: index};
    }
    return {row, column: null};
  }

  /**
   * The command counts the points that are filled in, the user the rows: if the two differ, the row is added to the
   * point's number in the command's messages.
   */
  withRows(sentence) {
    if (!this.isOfPoints) return sentence;
    const beside = (number) => {
      const row = this.rowOfPoint(Number(number));
      return row < 0 || row + 1 === Number(number) ? number : `${number} (row ${row + 1})`;
    };
    return sentence.replace(/\b[Pp]oints? \d+(?:(?:, | and )\d+)*(?![\d.])/g, (found) => found.replace(/\d+/g, beside));
  }

  /** Marks, whose rows are points; distances have the names of their holes. */
  get isOfPoints() {
    return this.columns[0] !== "from";
  }

  /** The row of the n-th point, from 1, of those that are filled in. */
  rowOfPoint(number) {
    let seen = 0;
    return this.rows.findIndex((_, row) => !this.isBlank(row) && ++seen === number);
  }
}

/** Positions: [{name, x, y}] and, for distances, the two names of each row. */
function placesOf(tables) {
  for (const {columns, rows} of tables) {
    const x = ["commanded_x_mm", "x_mm"].map((name) => columns.indexOf(name)).find((index) => index >= 0);
    const y = ["commanded_y_mm", "y_mm"].map((name) => columns.indexOf(name)).find((index) => index >= 0);
    if (x === undefined || y === undefined) continue;
    return rows.map(({cells}, index) => ({
      name: columns[0] === "hole" ? cells[0] : String(index + 1), x: Number(cells[x]), y: Number(cells[y]),
    }));
  }
  return [];
}

const MM_PER_INCH = 25.4;

/**
 * Converts typed text to the list's form: millimetres with a decimal point. A decimal comma, the long minus of a
 * spreadsheet and the fractions of an inch rule are read; other text is unchanged, for the command to report.
 */
export function millimetresOf(typed, unit) {
  const text = typed.trim().replace(/^\u2212/, "-").replace(/^([-+]?\d*),(\d+)$/, "$1.$2");
  if (unit !== "in" || text === "") return text;
  const fraction = /^([-+]?)(?:(\d+)[ -])?(\d+)\/(\d+)$/.exec(text);
  const inches = fraction
    ? (fraction[1] === "-" ? -1 : 1) * (Number(fraction[2] ?? 0) + Number(fraction[3]) / Number(fraction[4]))
    : Number(text.replace(/["\u2033]$/, ""));
  return Number.isFinite(inches) ? plain(inches * MM_PER_INCH, 3) : text;
}

/** A cell of the list in the unit of the table. */
export function shownIn(unit, millimetres) {
  const value = Number(millimetres);
  if (unit !== "in" || millimetres === "" || !Number.isFinite(value)) return millimetres;
  return plain(value / MM_PER_INCH, 4);
}

function plain(value, decimals) {
  return String(Number(value.toFixed(decimals)));
}
