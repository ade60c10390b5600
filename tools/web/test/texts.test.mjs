// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that owners paste, told apart, and the command's sentences in the page's words.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {test} from "node:test";
import {isOfBelts, splitPasted} from "../page/belts_text.js";
import {inPage} from "../page/in_page.js";
import {isOfPlotter, isWallPlotter, millimetresTyped, readsGcode} from "../page/plotter_text.js";
import {Sheet} from "../page/sheet.js";
import {fixture} from "./browser.mjs";

const read = (path) => readFileSync(fixture(path), "utf8");
const [LOG, YAML] = [read("good/maslow4_log.txt"), read("machines/maslow.yaml")];

test("settings and log of four belts are separated in one text, in any order", () => {
  assert.deepEqual(splitPasted(LOG), {yaml: null, log: LOG});
  for (const both of [YAML + LOG, LOG + YAML, `${YAML}\r\n\r\n${LOG.replaceAll("\n", "\r\n")}`]) {
    const {yaml, log} = splitPasted(both);
    assert.deepEqual(log.trim().split("\n"), LOG.trim().split("\n").filter((line) => line !== ""));
    assert.match(yaml, /^ {4}tlX: -27\.6$/m);
    assert.doesNotMatch(yaml, /CLBM|MSG/);
  }
  assert.deepEqual([splitPasted(YAML).log, splitPasted(" \n").log], [null, null]);
  assert.ok(isOfBelts(YAML) && isOfBelts(LOG) && !isOfBelts("kinematics:\n  WallPlotter:\n"));
});

test("distinguishes a plotter's texts from a router's", () => {
  for (const path of ["plotter/mural.txt", "plotter/mural_drawing.json", "good/plottersettings_marlin_log.txt", "good/plottersettings_configuration.h",
    "good/plottersettings_polargraph.properties", "good/plotter_every_key.json"]) assert.ok(isOfPlotter(read(path)), path);
  for (const path of ["good/maslow4_log.txt", "good/groundcontrol_ring.ini", "machines/maslow.yaml", "machines/classic.json", "good/plottersettings_fluidnc.yaml"])
    assert.ok(!isOfPlotter(read(path)), path);
  assert.ok(isWallPlotter(read("good/plottersettings_fluidnc.yaml")));
  assert.deepEqual([" 12,5 ", "\u22123.2", "", "x"].map(millimetresTyped), [12.5, -3.2, null, "x"]);
  assert.deepEqual([{set: {firmware: "marlin"}}, {set: {firmware: "mural"}}, null].map(readsGcode), [true, false, false]);
});

test("a list takes the readings of another one of the same places, and errors become positions", () => {
  const marks = Sheet.of(read("start/marks.csv"));
  const worn = Sheet.of(read("start/worn_chain.csv"));
  assert.equal(marks.withValuesOf(worn), worn.text());
  assert.equal(marks.withValuesOf(Sheet.of("order,commanded_x_mm,commanded_y_mm,x_mm,y_mm\n1,0,0,1,2\n")), null, "of another place");
  assert.equal(marks.withPlacesAdded(), null);
  const list = (cells) => Sheet.of(`order,commanded_x_mm,commanded_y_mm,x_mm,y_mm\n${[1, 2, 3, 4].map((mark) => `${mark},${300 * mark},-200,${cells}`).join("\n")}\n`);
  assert.match(list("1.5,-2").withPlacesAdded(), /^1,300,-200,301\.5,-202\n2,600/m);
});

test("options of the command become words of the page", () => {
  for (const [said, wanted] of [
    ["give 100 mm (hook_offset_mm of the tape, or --hook-offset-mm); 0 if they are right", "tick \"from 100 mm\" if the tape was held at its 100 mm mark; 0 if they are right"],
    ["Something (see --that).", "Something."], ["Nothing to change (1.5 mm).", "Nothing to change (1.5 mm)."],
  ]) assert.equal(inPage(said), wanted);
});
