// SPDX-License-Identifier: GPL-3.0-or-later
// A V-plotter's evening: settings pasted, the test page's measures typed in, the lines, a slip, and a program drawn true.
import assert from "node:assert/strict";
import {readFileSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {test} from "node:test";
import {isOfPlotter, isWallPlotter, millimetresTyped, readsGcode} from "../page/plotter_text.js";
import {folderOf} from "../page/zip.js";
import {fixture, runNative, temporaryFolder, Visit, writeFolder} from "./browser.mjs";

const MURAL = readFileSync(fixture("plotter/mural.txt"), "utf8");
const DRAWING = JSON.parse(readFileSync(fixture("plotter/mural_drawing.json"), "utf8"));
/** The page that the fixture's values were read on, as nobody has measured it yet. */
const BLANK = JSON.stringify({...DRAWING, measures: DRAWING.measures.map((measure) => ({...measure, value_mm: null}))});
const VALUES = DRAWING.measures.map(({value_mm: value}) => value);

/** The page of the fixture, opened from a file. */
async function openBlank(visit) {
  const path = join(temporaryFolder(), "drawing.json");
  writeFileSync(path, BLANK);
  await visit.upload("#settings", path);
  await visit.text("#step-measure h3", "Measure it");
}

/** The values as a spreadsheet's column, from the first row on. */
async function pasteColumn(visit, values) {
  const first = await visit.page.waitForSelector('tr[data-measure="0"] input', {visible: true});
  await first.focus();
  await visit.page.evaluate((text) => {
    const data = new DataTransfer();
    data.setData("text", text);
    document.activeElement.dispatchEvent(new ClipboardEvent("paste", {clipboardData: data, bubbles: true, cancelable: true}));
  }, values.join("\n"));
}

async function assertNoOptions(visit) {
  const shown = await visit.page.evaluate(() => document.querySelector("main").innerText);
  assert.doesNotMatch(shown, /(^|[\s(])--[a-z]/);
  assert.doesNotMatch(shown, /chaintrue (fit|diagnose|plan|export|import|start)/);
}

test("a plotter's texts are told from a router's", () => {
  const good = (name) => readFileSync(fixture(`good/${name}`), "utf8");
  for (const text of [MURAL, JSON.stringify(DRAWING), good("plottersettings_marlin_log.txt"), good("plottersettings_configuration.h"),
    good("plottersettings_polargraph.properties"), good("plotter_every_key.json")]) assert.ok(isOfPlotter(text));
  for (const text of [good("maslow4_log.txt"), good("groundcontrol_ring.ini"), readFileSync(fixture("machines/maslow.yaml"), "utf8"),
    readFileSync(fixture("machines/classic.json"), "utf8"), good("plottersettings_fluidnc.yaml")]) assert.ok(!isOfPlotter(text));
  assert.ok(isWallPlotter(good("plottersettings_fluidnc.yaml")));
  assert.deepEqual([" 12,5 ", "\u22123.2", "", "x"].map(millimetresTyped), [12.5, -3.2, null, "x"]);
  assert.deepEqual([{set: {firmware: "marlin"}}, {set: {firmware: "mural"}}, null].map(readsGcode), [true, false, false]);
});

test("from a mural's settings and a ruler to the lines and the second page", async () => {
  const visit = await Visit.to("chrome", {patience: 30_000});
  try {
    await visit.paste("#paste", MURAL);
    await visit.text("#step-machine section", "Assumed is a mural");
    await visit.click("On to the test page");
    await visit.click("Download page.svg");
    assert.match(new TextDecoder().decode(await visit.downloaded("page.svg")), /<svg/);
    await visit.page.click("#title-machine");
    await openBlank(visit);
    await (await visit.page.waitForSelector('tr[data-measure="0"] input')).type(String(VALUES[0]));
    await visit.text("#step-measure .said", "1 of 12 measures at least");
    await visit.page.keyboard.press("Enter");
    assert.equal(await visit.page.evaluate(() => document.activeElement.closest("tr").dataset.measure), "1");
    await pasteColumn(visit, VALUES);
    await visit.text("#step-measure .said", "The lines bow by up to 17.9 mm");
    await visit.click("On to the numbers");
    await visit.text("#step-result .headline", "those of the next page bow by up to 0.1 mm");
    const lines = await visit.text("#step-result pre", "top distance");
    await visit.text("#step-result .changes", "zero of the left cord");
    await visit.text("#step-result .causes", "nothing is wrong");
    await assertNoOptions(visit);
    await visit.click("Download");
    const folder = temporaryFolder();
    writeFolder(folder, folderOf(await visit.downloaded("my-machine.zip")));
    assert.equal(lines.trim(), runNative(["export", "plotter", "found.json"], folder).stdout.trim());
    await visit.page.click("#title-cut");
    await visit.text("#step-cut", "This plotter is sent pictures");
    await visit.page.click("#title-result");
    await visit.click("They are in: the second page");
    await visit.page.waitForFunction(() => [...document.querySelectorAll("tr[data-measure] input")].every(({value}) => value === ""));
    // What was drawn with the first numbers comes back.
    await visit.click("Undo");
    await visit.text("#step-measure .said", "The lines bow by up to 17.9 mm");
    assert.deepEqual(visit.problems, []);
  } finally {
    await visit.close();
  }
});

test("a slip is named at the measures, and there are no lines", async () => {
  const visit = await Visit.to("chrome", {patience: 30_000});
  try {
    await openBlank(visit);
    await pasteColumn(visit, VALUES.map((value) => (value / 25.4).toFixed(3)));
    await visit.text("#step-measure .said.problem", "inches");
    await visit.page.click("#title-result");
    await visit.text("#step-result .said.problem", "inches");
    assert.equal(await visit.page.$$eval("#step-result pre", (found) => found.filter((one) => one.checkVisibility()).length), 0);
    assert.deepEqual(visit.problems, []);
  } finally {
    await visit.close();
  }
});

test("a drawing of a plotter with Marlin is opened, and a program drawn true", async () => {
  // The mural's page as one that Marlin commanded: a drawing of another machine, which its fit takes up as settings.
  const folder = temporaryFolder();
  const set = {...DRAWING.set, firmware: "marlin", home: {x_mm: 0, y_mm: -800}, pins_middle: {x_mm: 0, y_mm: 0},
    machine: {...DRAWING.set.machine, motors: "wall", pulley_radius_mm: 0, cord: {compliance_per_n: 0}, gondola: {mass_kg: 0.5}}};
  const at = Object.fromEntries(DRAWING.crosses.map(({name, x_mm: x, y_mm: y}) => [name, [x, y]]));
  const measures = DRAWING.measures.map((measure) => ({...measure, value_mm: measure.kind === "bow" ? 0 : Math.round(10 * Math.hypot(
    at[measure.from][0] - at[measure.to][0], at[measure.from][1] - at[measure.to][1])) / 10 + 0.1}));
  const path = join(folder, "drawn.json");
  writeFileSync(path, JSON.stringify({...DRAWING, set, measures}));
  const program = join(folder, "line.gcode");
  writeFileSync(program, "G21\nG90\nM280 P0 S90\nG0 X-200 Y-500\nM280 P0 S30\nG1 X200 Y-500 F1500\nG1 X200 Y-800\nM280 P0 S90\n");
  const visit = await Visit.to("chrome", {patience: 30_000});
  try {
    await visit.upload("#settings", path);
    await visit.text("#step-measure .said", "The lines bow by up to");
    await visit.click("On to the numbers");
    await visit.text("#step-result", "have each program rewritten");
    await visit.page.click("#title-cut");
    await visit.upload("#program", program);
    await visit.text("#step-cut .said", "the tool stays within");
    await visit.click("Download line.true.nc");
    assert.match(new TextDecoder().decode(await visit.downloaded("line.true.nc")), /M280 P0 S30\nG1 X/);
    assert.deepEqual(visit.problems, []);
  } finally {
    await visit.close();
  }
});
