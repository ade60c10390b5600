// SPDX-License-Identifier: GPL-3.0-or-later
// Four belts: one box for log and settings, the frame and the verdict, places left out, a taped distance, lines, holes, cut.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {describe, test} from "node:test";
import {isOfBelts, splitPasted} from "../page/belts_text.js";
import {folderOf} from "../page/zip.js";
import {browsers, fixture, runNative, temporaryFolder, Visit, writeFolder} from "./browser.mjs";

const LOG = readFileSync(fixture("good/maslow4_log.txt"), "utf8");
const YAML = readFileSync(fixture("machines/maslow.yaml"), "utf8");
const PLACES = 31;
/** One reading of the log, and the same read 20 mm short: 80 times what its readings scatter by. */
const [RIGHT, WRONG, WRONG_PLACE] = ["{bl:2344.38", "{bl:2324.38", 30];
const textOf = (bytes) => new TextDecoder().decode(bytes);
const verdict = (visit) => visit.text("#step-result .verdict", "Most likely");

/** What is visible has no option of the command in it. */
async function assertNoOptions(visit) {
  const shown = await visit.page.evaluate(() => document.querySelector("main").innerText);
  assert.doesNotMatch(shown, /(^|[\s(])--[a-z]/);
  assert.doesNotMatch(shown, /chaintrue (fit|diagnose|plan|export|import)/);
}

async function folderNow(visit) {
  await visit.click("Download");
  return folderOf(await visit.downloaded("my-machine.zip"));
}

test("settings and log are told apart in one text, in any order", () => {
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

for (const browser of browsers) {
  test(`from one paste to the lines and a program cut true, in ${browser}`, async () => {
    const visit = await Visit.to(browser);
    try {
      await visit.paste("#paste", YAML + LOG);
      await verdict(visit);
      assert.match(await visit.text("#step-result .headline"), /^Your machine misses by about 2\.5 mm\. With these lines it misses by about 0\.1 mm\./);
      assert.equal((await visit.page.$$("#step-result .frame .spot")).length, PLACES);
      assert.deepEqual([(await visit.page.$$("#step-result .frame .belt")).length, (await visit.page.$$("#step-result .frame .ellipse")).length], [4, 4]);
      await visit.text("#step-result .causes", "belt stretch");
      await assertNoOptions(visit);
      await visit.click("Paste the lines");
      const lines = await visit.text("#step-result pre", "$/kinematics");
      const changes = await visit.text("#step-result .changes", "will be");
      assert.match(lines, /^\$\/kinematics\/MaslowKinematics\/tlX=-?\d+\.\d\d$/m);
      assert.match(changes, /top left x-27\.6/, "what is in force comes from maslow.yaml");
      const files = await folderNow(visit);
      const folder = temporaryFolder();
      writeFolder(folder, files);
      const native = runNative(["export", "maslow4", "diagnosis.json"], folder);
      assert.equal(lines.trim(), native.stdout.trim());
      await visit.click("Compensate each job instead");
      await visit.click("Open a program to cut");
      await visit.upload("#program", fixture("gcode/bracket.nc"));
      await visit.text("#step-cut .said", "the tool stays within");
      await visit.report("bracket.nc before and after");
      await assertNoOptions(visit);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });
}

describe("in Chromium", () => {
  test("a wish is held against the lines to paste", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.paste("#paste", YAML + LOG);
      await verdict(visit);
      await visit.click("Measure");
      await visit.page.type("#belts-wish", "0,5");
      await visit.page.keyboard.press("Tab");
      await visit.click("Map and causes");
      await visit.text("#step-result .wish", "You wish for 0.5 mm: reached. How large everything comes out only a taped distance can say.");
      await visit.click("Measure");
      await visit.page.$eval("#belts-wish", (input) => input.select());
      await visit.page.type("#belts-wish", "0.1");
      await visit.page.keyboard.press("Tab");
      await visit.click("Map and causes");
      await visit.text("#step-result .wish", "You wish for 0.1 mm: not reached");
      await assertNoOptions(visit);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("maslow.yaml alone waits for the log, and a log alone for maslow.yaml", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.upload("#settings", fixture("machines/maslow.yaml"));
      await visit.text(".said", "Now paste what the machine printed");
      await visit.paste("#paste", LOG);
      await verdict(visit);
      assert.match(textOf((await folderNow(visit))["belts.json"]), /"x_mm": -27\.6/);
      await visit.click("Begin anew");
      await visit.paste("#paste", LOG);
      await verdict(visit);
      assert.match(await visit.text("#step-result .headline"), /^With these lines your machine misses by about/, "what it misses by today nobody knows");
      await visit.click("Paste the lines");
      await visit.text("#step-result", "What is in force is not known: paste maslow.yaml");
      await visit.click("Machine");
      const assumed = await visit.text("#step-machine section", "How the log is read");
      assert.match(assumed, /Assumed: an arm of 123\.4 mm/);
      await assertNoOptions(visit);
      await visit.paste("#paste", YAML);
      await visit.text("#step-result .headline", "Your machine misses by about 2.5 mm");
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("a text that is no log is refused with what was expected, and nothing is lost", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.paste("#paste", YAML + LOG);
      await verdict(visit);
      await visit.click("Machine");
      await visit.paste("#paste", "G0 X1\nG1 Y2\n");
      await visit.text(".said.problem", "expected a log of Find Anchors");
      assert.equal(textOf((await folderNow(visit))["log.txt"]).trim(), LOG.trim());
    } finally {
      await visit.close();
    }
  });

  test("a wrong reading is marked in table and picture, and its place left out and taken back by click, key and undo", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.paste("#paste", YAML + LOG.replace(RIGHT, WRONG));
      await verdict(visit);
      const wrong = () => visit.page.$$eval(".step-body:not([hidden]) .spot.wrong", (spots) => spots.map(({dataset}) => Number(dataset.point)));
      assert.deepEqual(await wrong(), [WRONG_PLACE]);
      await visit.click("Measure");
      assert.match(await visit.text("#step-measure tr.wrong td.wrong"), /^2324\.38 \(\u221219\.\d\)$/);
      await visit.page.focus(`#leave-${WRONG_PLACE}`);
      await visit.page.keyboard.press("Space");
      await visit.text("#step-measure .spot.out", String(WRONG_PLACE));
      await visit.page.waitForFunction(() => document.querySelectorAll("#step-measure .spot.wrong").length === 0);
      assert.equal(textOf((await folderNow(visit))["without.txt"]), "30");
      await visit.click("Undo");
      await visit.page.waitForFunction(() => document.querySelectorAll("#step-measure .spot.wrong").length === 1);
      await visit.page.$eval('#step-measure .spot[data-point="7"]', (spot) => spot.dispatchEvent(new MouseEvent("click", {bubbles: true})));
      await visit.text("#step-measure tr.out th", "7");
      await visit.page.waitForFunction(() => document.querySelectorAll("#step-measure .spot.wrong").length === 1);
      await visit.reload();
      await visit.text("#step-measure .spot.out", "7");
      const files = await folderNow(visit);
      const folder = temporaryFolder();
      writeFolder(folder, files);
      const native = runNative(["fit", "belts.json", "--without", "7", "-o", "native.json"], folder);
      assert.equal(native.code, 0, native.stderr);
      const tl = (bytes) => JSON.parse(bytes).fit.machine.anchors.tl.x_mm;
      // The estimator stops at a hundredth of a sigma of some tenths of a millimetre.
      assert.ok(Math.abs(tl(textOf(files["anchors.json"])) - tl(readFileSync(`${folder}/native.json`))) < 1e-3);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("a taped distance gives the scale, one that was held at its 100 mm mark is refused at its box", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.paste("#paste", YAML + LOG);
      await verdict(visit);
      await visit.text("#step-result", "How large everything comes out is not known yet");
      await visit.page.type("#tape-tl-br", "3720");
      await visit.page.keyboard.press("Tab");
      await visit.text("#tape-note", "was the tape held at its 100 mm mark?");
      assert.equal(await visit.page.$eval("#tape-tl-br", (input) => input.getAttribute("aria-invalid")), "true");
      await visit.page.$eval("#tape-tl-br", (input) => input.select());
      await visit.page.type("#tape-tl-br", "3620,0");
      await visit.page.keyboard.press("Tab");
      await verdict(visit);
      await visit.page.waitForFunction(() => !document.querySelector("#step-result").innerText.includes("is not known yet"));
      assert.equal(JSON.parse(textOf((await folderNow(visit))["belts.json"])).distances[0].distance_mm, 3620);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("holes are planned over what was measured, typed in, and part of the map that cuts", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.paste("#paste", YAML + LOG);
      await verdict(visit);
      await visit.click("Measure");
      await visit.click("Plan nine holes");
      await visit.text("#step-measure .list");
      const about = await visit.page.$$eval("#step-measure .list tbody tr[data-row]", (rows) => rows.map((row) => Number(row.lastChild.textContent)));
      assert.ok(about.length >= 15 && Math.max(...about) < 2400, `${about.length} distances on what the log covers, ${Math.max(...about)} mm at most`);
      for (const [row, mm] of about.entries()) await visit.page.$eval(`#step-measure .list tr[data-row="${row}"] input`, (input, value) => {
        input.value = value;
        input.dispatchEvent(new Event("input", {bubbles: true}));
      }, String(mm));
      await visit.text("#step-measure .said", "distances");
      await visit.click("Cut");
      await visit.upload("#program", fixture("gcode/bracket.nc"));
      await visit.text("#step-cut .said", "the tool stays within");
      assert.match(textOf((await folderNow(visit))["anchors.json"]), /"scale"/);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("lines that are pasted are remembered, and nothing is left to compensate", async () => {
    const visit = await Visit.to("chrome", {width: 400, dark: true});
    try {
      await visit.click("A Maslow 4");
      await verdict(visit);
      await visit.click("Paste the lines");
      const keys = await visit.page.$$eval("#step-result .legend span", (spans) => spans.map((span) => span.getBoundingClientRect().toJSON()));
      assert.ok(keys.length >= 3);
      for (const [index, one] of keys.entries()) for (const other of keys.slice(index + 1)) {
        assert.ok(one.bottom <= other.top || one.right <= other.left, `a legend lies over another: ${JSON.stringify([one, other])}`);
      }
      await visit.click("I have pasted them");
      await visit.text("#step-result .said", "These lines are in the machine");
      await visit.reload();
      await visit.text("#step-result .said", "These lines are in the machine");
      for (const step of ["Machine", "Measure", "Map and causes", "Cut", "Files"]) {
        await visit.click(step);
        const over = await visit.page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
        assert.equal(over, 0, `${step} is ${over} px wider than the screen`);
      }
      await visit.click("Cut");
      await visit.text("#step-cut", "cut programs as they are");
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });
});
