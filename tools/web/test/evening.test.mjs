// SPDX-License-Identifier: GPL-3.0-or-later
// An owner's evening, typed and clicked: from the settings file to the verified program, in every installed browser.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import {describe, test} from "node:test";
import {folderOf} from "../page/zip.js";
import {browsers, fixture, runNative, temporaryFolder, Visit, writeFolder} from "./browser.mjs";

const READINGS = readFileSync(fixture("start/marks.csv"), "utf8").trim().split("\n").slice(1).map((line) => line.split(",").slice(3));
const ROW_OF_SLIP = 11;

/**
 * The estimator stops at a step below 3e-3 of a sigma (grid/estimation/estimate.cpp), and sigmas are tenths of a
 * millimetre: digits beyond a hundredth of that are not guaranteed.
 */
const SETTLED_MM = 1e-6;

/** Numbers equal to 1e-9 of their size or to the estimator's tolerance; all else equal. */
export function assertAlike(found, wanted, place = "") {
  if (typeof wanted === "number" && typeof found === "number") {
    assert.ok(Math.abs(found - wanted) <= Math.max(1e-9 * Math.abs(wanted), SETTLED_MM), `${place}: ${found}, natively ${wanted}`);
  } else if (wanted !== null && typeof wanted === "object") {
    assert.deepEqual(Object.keys(found), Object.keys(wanted), place);
    for (const key of Object.keys(wanted)) assertAlike(found[key], wanted[key], `${place}/${key}`);
  } else if (!(typeof wanted === "string" && /\b[0-9a-f]{64}\b/.test(wanted))) {  // a hash of digits
    assert.equal(found, wanted, place);
  }
}

for (const browser of browsers) {
  describe(`an evening in ${browser}`, () => {
    test("from the settings file to the verified program", async () => {
      const visit = await Visit.to(browser);
      try {
        await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
        await typeReadings(visit);
        await slipAndMend(visit);
        await visit.reload();
        assert.deepEqual(await visit.values(), READINGS.flat(), "a reload loses nothing");
        await visit.text(".said", "With this map it misses by about 0.2 mm");
        await visit.click("See the map and the causes");
        await visit.text("#step-result .headline", "With this map it misses by about 0.2 mm");
        await visit.unfold("The whole report");
        await visit.report("The map");
        await visit.click("Find the cause");
        await visit.text("#step-result .verdict", "Most likely");
        await visit.unfold("The whole diagnosis");
        const diagnosis = await visit.report("The diagnosis");
        assert.match(await diagnosis.$eval("main", (main) => main.textContent), /links/);
        await visit.click("What to measure next");
        await visit.text("#step-result .sentences", "measur");
        await visit.click("Type numbers in");
        assert.match(await visit.text("#step-result pre", "motorspacingx"), /rotationradius/);
        await visit.click("Compensate each job instead");
        await cutAPart(visit);
        await typeNumbersIn(visit);
        await cutWithThem(visit);
        await compareFolder(visit);
        assert.deepEqual(visit.problems, []);
      } finally {
        await visit.close();
      }
    });
  });
}

/** What the first line says of each example evening. */
const EVENINGS = [
  ["A worn chain", "With this map it misses by about 0.2 mm"], ["A beam that bends", "With this map it misses by about 0.2 mm"],
  ["A tape that is too long", "With this map it misses by about 0.2 mm"], ["A chain that jumped a tooth", "was measured twice"],
  ["Nothing wrong", "Your machine needs no map"],
];

test("example evenings open with a click, and a wish is held against them", async () => {
  const visit = await Visit.to(browsers[0]);
  try {
    for (const [title, said] of EVENINGS) {
      await visit.click("Machine");
      await visit.click(title);
      await visit.text(".said", said);
    }
    await visit.click("Machine");
    await visit.click("A Maslow 4");
    await visit.text("#step-result .headline", "your machine misses by about");
    await visit.click("Machine");
    await visit.click("A worn chain");
    await visit.text(".said", "With this map it misses by about");
    const wish = await visit.page.waitForSelector("#wish", {visible: true});
    await wish.type("0,5");
    await visit.page.keyboard.press("Tab");
    await visit.text(".said", "You wish for 0.5 mm: reached.");
    await visit.click("See the map and the causes");
    await visit.text("#step-result .wish", "You wish for 0.5 mm: reached.");
    assert.deepEqual(visit.problems, []);
  } finally {
    await visit.close();
  }
});

/** From cell to cell by keyboard only; every third number with a comma. */
async function typeReadings(visit) {
  await (await visit.cell(0, 0)).focus();
  for (const [row, [x, y]] of READINGS.entries()) {
    await visit.page.keyboard.type(row % 3 === 0 ? x.replace(".", ",") : x);
    await visit.page.keyboard.press("ArrowRight");
    await visit.page.keyboard.type(y);
    if (row + 1 === READINGS.length) break;
    await visit.page.keyboard.press("Enter");
    await visit.page.keyboard.press("ArrowLeft");
  }
  await visit.text(".said", "With this map it misses by about 0.2 mm");
}

async function slipAndMend(visit) {
  await visit.type(ROW_OF_SLIP, 1, "-23o.5");
  await visit.text("tr.note", "found -23o.5, expected a number in mm from -20000 to 20000 (y_mm)");
  await visit.type(ROW_OF_SLIP, 1, "-230.5");
  await visit.text("tr.note", "Point 12 at (2, -230) is off by");
  assert.equal(await visit.page.$eval(`tr[data-row="${ROW_OF_SLIP}"] input`, (input) => input.getAttribute("aria-invalid")), "true");
  await visit.type(ROW_OF_SLIP, 1, READINGS[ROW_OF_SLIP][1]);
  await visit.page.waitForFunction(() => document.querySelectorAll("tr.note:not([hidden])").length === 0);
  // All marks are restored before the page is left.
  await visit.text(".said", "With this map it misses by about 0.2 mm");
}

async function cutAPart(visit) {
  await visit.click("Cut");
  await visit.upload("#program", fixture("gcode/bracket.nc"));
  await visit.text(".said", "the tool stays within 0.0439 mm of the path");
  await visit.report("bracket.nc before and after");
  await visit.click("Verify it once more");
  await visit.text(".said", "holds: the tool strays at most 0.0439 mm");
  await visit.click("Download bracket.true.nc");
  visit.program = await visit.downloaded("bracket.true.nc");
}

/** Which of the two ways was taken outlives a reload, and what was compensated for the old numbers is put away. */
async function typeNumbersIn(visit) {
  await visit.click("Map and causes");
  await visit.click("Type numbers in instead");
  await visit.click("I have typed them in");
  await visit.click("Cut");
  await visit.text("#step-cut .said", "compensate it again");
  assert.equal(await visit.page.$("#step-cut iframe"), null);
  await visit.reload();
  await visit.click("Map and causes");
  await visit.text("#step-result .said", "These numbers are in the controller");
  assert.match(await visit.text("#step-result pre", "motorspacingx"), /rotationradius/);
}

async function cutWithThem(visit) {
  await visit.click("Cut");
  await visit.text("#step-cut .hint", "with the numbers that you typed in");
  await visit.click("Compensate bracket.nc");
  await visit.text("#step-cut .said", "settings.ini holds other settings than the map was measured with");
  await visit.click("Verify it once more");
  await visit.text("#step-cut .said", "holds: the tool strays at most");
}

/** The page's downloads are the command's output, and equal those of the native command. */
async function compareFolder(visit) {
  await visit.click("Download");
  const files = folderOf(await visit.downloaded("my-machine.zip"));
  const folder = temporaryFolder();
  writeFolder(folder, files);
  const text = (bytes) => new TextDecoder().decode(bytes);
  const cut = runNative(["gcode", "compensate", "bracket.nc", "--map", "map.json", "-o", "bracket.true.nc", "--force"], folder);
  assert.equal(cut.code, 0, cut.stderr);
  assert.equal(text(visit.program), readFileSync(join(folder, "bracket.true.nc"), "utf8"), "the program, byte for byte");
  const typed = runNative(["gcode", "compensate", "bracket.nc", "--map", "map.json", "--settings", "settings.ini", "-o", "typed.nc"], folder);
  assert.equal(typed.code, 0, typed.stderr);
  assert.equal(text(files["bracket.true.nc"]), readFileSync(join(folder, "typed.nc"), "utf8"), "the one for the numbers typed in");
  const fit = runNative(["fit", "marks.csv", "--machine", "machine.json", "-o", "map.json", "--force"], folder);
  assert.equal(fit.code, 0, fit.stderr);
  assertAlike(JSON.parse(text(files["map.json"])), JSON.parse(readFileSync(join(folder, "map.json"), "utf8")), "map.json");
}
