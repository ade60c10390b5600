// SPDX-License-Identifier: GPL-3.0-or-later
// Lists as cells and back, and the conversion of typed text.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import {test} from "node:test";
import {fileURLToPath} from "node:url";
import {millimetresOf, Sheet, shownIn} from "../page/sheet.js";
import {folderOf, zipOf} from "../page/zip.js";

const MARKS = readFileSync(join(fileURLToPath(import.meta.url), "../../../../fixtures/start/marks.csv"), "utf8");
const HOLES = "hole,x_mm,y_mm\nA,-839,509\nB,-559,509\n# a note, with a comma\nfrom,to,distance_mm,as_commanded_mm\nA,B,,280\n# the hash\n";

test("a list that is only read stays as it is, to the byte", () => {
  for (const text of [MARKS, HOLES]) assert.equal(Sheet.of(text).text(), text);
});

test("marks have a place and two cells, distances one between two holes", () => {
  const marks = Sheet.of(MARKS);
  assert.deepEqual([marks.rows.length, marks.filled, marks.readColumns], [32, 32, [3, 4]]);
  assert.deepEqual(marks.places[1], {name: "2", x: -969, y: -509});
  const holes = Sheet.of(HOLES);
  assert.deepEqual([holes.rows.length, holes.filled, holes.readColumns], [1, 0, [2]]);
  assert.deepEqual(holes.places.map(({name}) => name), ["A", "B"]);
  assert.equal(holes.set(0, 2, "279.5"), HOLES.replace("A,B,,280", "A,B,279.5,280"));
});

test("the command's lines, columns and points lead to their cells", () => {
  const sheet = Sheet.of(MARKS.replace("1,-1119,-509,-1113,-508", "1,-1119,-509,,"));
  assert.deepEqual(sheet.cellAt(5, 10), {row: 3, column: 3});
  assert.deepEqual(sheet.cellAt(5, 1), {row: 3, column: 0});
  assert.equal(sheet.cellAt(1, 1), null);
  assert.equal(sheet.rowOfPoint(1), 1, "what is blank is no point");
  assert.equal(sheet.rowOfPoint(27), 27);
});

test("a sentence that counts the points says the rows as well, where blanks part the two", () => {
  const whole = Sheet.of(MARKS);
  const gaps = Sheet.of(MARKS.replace(/^(2,-969,-509,).*$/m, "$1,").replace(/^(5,559,-509,).*$/m, "$1,"));
  assert.equal(gaps.filled, 30);
  const said = "Point 9 at (555, -509) was set aside; look at points 1, 3 and 4, of 30 points. It leaves 0.39 mm; points 0.5 mm off are fine.";
  assert.equal(whole.withRows(said), said);
  assert.equal(gaps.withRows(said), "Point 9 (row 11) at (555, -509) was set aside; look at points 1, 3 (row 4) and 4 (row 6), of 30 points. " +
    "It leaves 0.39 mm; points 0.5 mm off are fine.");
  assert.equal(Sheet.of(HOLES).withRows("Point 9"), "Point 9", "distances have names");
});

test("other forms of a list are left alone", () => {
  for (const text of ["", "# nothing\n", MARKS.replaceAll(",", ";"), MARKS.replaceAll("\n", "\r\n"), "a,b\n1,2\n", `${MARKS}2,"1,,\n`])
    assert.equal(Sheet.of(text), null, text.slice(0, 40));
});

test("what is typed becomes millimetres with a point", () => {
  for (const [typed, unit, wanted] of [["12,5", "mm", "12.5"], [" -3 ", "mm", "-3"], ["\u221212.5", "mm", "-12.5"], ["", "in", ""],
    ["1", "in", "25.4"], ["-43 13/16", "in", "-1112.837"], ["1/2", "in", "12.7"], ["20,5", "in", "520.7"], ["4\u2033", "in", "101.6"],
    ["o1", "in", "o1"], ["1.234,5", "mm", "1.234,5"]]) assert.equal(millimetresOf(typed, unit), wanted, `${typed} ${unit}`);
  assert.equal(shownIn("in", "25.4"), "1");
  assert.equal(shownIn("in", "9x7"), "9x7");
});

test("a zip gives its folder back, and none leads out of it", () => {
  const folder = {"machine.json": new Uint8Array([1, 2]), "sub/a.nc": new Uint8Array([3])};
  assert.deepEqual(folderOf(zipOf(folder)), folder);
  assert.deepEqual(zipOf(folder), zipOf({...folder}), "the same folder, the same bytes");
  assert.throws(() => folderOf(zipOf({"../../evil": new Uint8Array([1])})), /out of the folder/);
});
