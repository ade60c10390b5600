// SPDX-License-Identifier: GPL-3.0-or-later
// The table of readings, the machine's form, a log instead of them: in Chromium.
import assert from "node:assert/strict";
import {after, before, describe, test} from "node:test";
import {fixture, runNative, temporaryFolder, Visit, writeFolder} from "./browser.mjs";

describe("typing", () => {
  let visit = null;
  before(async () => {
    visit = await Visit.to("chrome");
  });
  after(() => visit.close());

  /** A new machine without readings. */
  async function anew() {
    if (await visit.page.$(".list")) await visit.click("Begin anew");
    await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
    await visit.cell(0, 0);
  }

  test("a block of a spreadsheet is pasted, with its decimal commas", async () => {
    await anew();
    await (await visit.cell(1, 0)).focus();
    await visit.page.evaluate(() => {
      const data = new DataTransfer();
      data.setData("text/plain", "-964,5\t-508\r\n-555,25\t\u2212506,5\r\n");
      document.activeElement.dispatchEvent(new ClipboardEvent("paste", {clipboardData: data, bubbles: true, cancelable: true}));
    });
    assert.deepEqual((await visit.values()).slice(0, 6), ["", "", "-964,5", "-508", "-555,25", "\u2212506,5"]);
    await visit.click("Files");
    assert.equal(await listOf(visit, 3), "2,-969,-509,-964.5,-508\n3,-559,-509,-555.25,-506.5\n");
    await visit.click("Measure");
  });

  test("inches and their fractions become millimetres in the list", async () => {
    await anew();
    await visit.page.select("#unit", "in");
    await visit.type(0, 0, "-43 13/16");
    await visit.type(0, 1, "-20,5");
    assert.equal(await listOf(visit, 2), "1,-1119,-509,-1112.837,-520.7\n");
    await visit.page.select("#unit", "mm");
    assert.deepEqual((await visit.values()).slice(0, 2), ["-1112.837", "-520.7"]);
  });

  test("whatever is typed stays as it is, for the command to judge", async () => {
    await anew();
    await visit.type(0, 0, 'a;b,"c"');
    await visit.type(0, 1, "-508");
    assert.equal(await listOf(visit, 2), '1,-1119,-509,"a;b,""c""",-508\n');
    assert.deepEqual((await visit.values()).slice(0, 2), ['a;b,"c"', "-508"]);
    await visit.text("tr.note", "expected a number in mm from -20000 to 20000 (x_mm)");
  });

  test("undo takes back a cell at a time, redo brings it again", async () => {
    await anew();
    await visit.type(0, 0, "-1113");
    await visit.type(0, 1, "-508");
    await visit.page.keyboard.down("Control");
    await visit.page.keyboard.press("z");
    await visit.page.keyboard.up("Control");
    assert.deepEqual((await visit.values()).slice(0, 2), ["-1113", ""]);
    await visit.click("Undo");
    assert.deepEqual((await visit.values()).slice(0, 2), ["", ""]);
    await visit.click("Redo");
    await visit.click("Redo");
    assert.deepEqual((await visit.values()).slice(0, 2), ["-1113", "-508"]);
  });

  test("too few readings are said in the command's words", async () => {
    await anew();
    await visit.type(0, 0, "-1113");
    await visit.type(0, 1, "-508");
    assert.match(await visit.text(".said", "at least 8"), /marks\.csv: the points: Only 1 point is filled in, and it takes at least 8/);
  });

  test("the row that is typed in is lit on the bed, and a mark that is clicked is typed in", async () => {
    await anew();
    await (await visit.cell(5, 0)).focus();
    assert.equal(await visit.page.$eval("svg.bed .active text", (text) => text.textContent), "6");
    await (await visit.page.$("svg.bed g.mark:nth-of-type(3)")).click();
    const lit = await visit.page.$eval("svg.bed .active text", (text) => text.textContent);
    assert.equal(await visit.page.evaluate(() => document.activeElement.closest("tr").querySelector("th").textContent), lit);
  });

  test("holes and a tape are typed in the same way", async () => {
    await anew();
    await visit.page.select("#way", "holes.csv");
    await visit.page.waitForSelector("svg.bed .distance");
    assert.equal((await visit.values()).length, 20);
  });

  test("a point that is set aside is named with its row where rows before it are empty", async () => {
    if (await visit.page.$(".list")) await visit.click("Begin anew");
    await visit.click("Try an example machine");
    await visit.text(".said", "With this map it misses by about 0.2 mm");
    for (const column of [0, 1]) await visit.type(3, column, " ");
    for (const column of [0, 1]) await visit.type(5, column, " ");
    await visit.type(11, 1, "-230.5");
    await visit.text("tr.note", "Point 10 (row 12) at (2, -230) is off by");
    assert.equal(await visit.page.$eval('tr[data-row="11"] input', (input) => input.getAttribute("aria-invalid")), "true");
    await visit.text(".said", "Point 10 (row 12)");
  });

  test("new points are planned, and say whether the map still holds", async () => {
    await visit.click("Begin anew");
    await visit.click("Try an example machine");
    await visit.text(".said", "With this map it misses by about 0.2 mm");
    await visit.click("See the map and the causes");
    await visit.click("Set new points");
    await visit.page.waitForFunction(() => document.querySelectorAll(".list input").length === 10);
    const READ = [["-1113", "508"], ["1114", "507"], ["-1113", "254"], ["-1112", "-508"], ["1114", "-508"]];
    for (const [row, [x, y]] of READ.entries()) {
      await visit.type(row, 0, x);
      await visit.type(row, 1, y);
    }
    const said = await visit.text(".said", "Measured less map");
    assert.doesNotMatch(said, /\b(rms|sigma|residual|held out|stated|nominal|likeness)\b/i, "words that have to be looked up");
    await visit.click("Download");
    const {folderOf} = await import("../page/zip.js");
    const folder = temporaryFolder();
    writeFolder(folder, folderOf(await visit.downloaded("my-machine.zip")));
    const {stdout} = runNative(["check", "map.json", "five.csv", "--machine", "machine.json"], folder);
    assert.match(stdout, /^The map /);
    assert.ok(said.includes(stdout.split("\n")[0]), `${said} has the verdict ${stdout.split("\n")[0]}`);
    await visit.page.select("#way", "marks.csv");
    await visit.text(".said", "With this map it misses by about 0.2 mm");
  });

  test("a number of the form that cannot be is said at its field", async () => {
    await anew();
    await visit.click("Machine");
    await visit.page.$eval("#machine-sled", (input) => input.select());
    await visit.page.type("#machine-sled", "116000");
    await visit.page.keyboard.press("Tab");
    await visit.text("#machine-sled-note", "expected a number from 0.05 to 200 kg");
    assert.equal(await visit.page.$eval("#machine-sled", (input) => input.getAttribute("aria-invalid")), "true");
  });

  test("nothing was logged", () => assert.deepEqual(visit.problems, []));
});

/** Lines of marks.csv as the page keeps it: the row `line` and, where there is one, the row after it. */
async function listOf(visit, line) {
  await visit.click("Download");
  const {folderOf} = await import("../page/zip.js");
  const folder = folderOf(await visit.downloaded("my-machine.zip"));
  const lines = new TextDecoder().decode(folder["marks.csv"]).split("\n");
  const count = line === 3 ? 2 : 1;
  return `${lines.slice(line - 1, line - 1 + count).join("\n")}\n`;
}
