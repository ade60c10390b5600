// SPDX-License-Identifier: GPL-3.0-or-later
// The three roads from the first screen to programs or numbers, and what must stop an owner on the way.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import {test} from "node:test";
import {browsers, fixture, runNative, temporaryFolder, Visit, writeFolder} from "./browser.mjs";

const read = (path) => readFileSync(fixture(path), "utf8");
const textOf = (bytes) => new TextDecoder().decode(bytes);
const MARKS = read("start/marks.csv");
const READINGS = MARKS.trim().split("\n").slice(1).map((line) => line.split(",").slice(3));
const MASLOW4 = read("machines/maslow.yaml") + read("good/maslow4_log.txt");
const DRAWING = JSON.parse(read("plotter/mural_drawing.json"));
const VALUES = DRAWING.measures.map(({value_mm: value}) => value);
/** Words that an owner does not see before unfolding something. */
const STATISTICS = /\b(sigma|residual|held out|nominal|compliance|chebyshev|likeness)\b/i;
const MOST_FOLDS = 6;

/** One visit for each test, closed after it; nothing may be logged. */
function walk(name, browser, script, options) {
  test(`${name}, in ${browser}`, async () => {
    const visit = await Visit.to(browser, options);
    try {
      await script(visit);
      assert.deepEqual(visit.problems, []);
    } catch (problem) {
      problem.message += `\nThe page shows:\n${await visit.page.evaluate(() => document.querySelector("main").innerText)}`;
      throw problem;
    } finally {
      await visit.close();
    }
  });
}

/** Nothing stands out of the screen, nor grows beyond its column, at the widths of a phone, a tablet and two screens. */
async function assertFits(visit, what) {
  for (const width of [390, 800, 1280, 1920]) {
    await visit.page.setViewport({width, height: 900});
    const [over, bed] = await visit.page.evaluate(() => [document.documentElement.scrollWidth - document.documentElement.clientWidth,
      document.querySelector("svg.bed")?.getBoundingClientRect().width ?? 0]);
    assert.equal(over, 0, `${what} at ${width} px`);
    assert.ok(bed < 620, `${what} at ${width} px: the bed has ${bed} px`);
  }
  await visit.page.setViewport({width: 1280, height: 900});
}

/** What stands there before anything is unfolded is in an owner's words, without options of the command. */
async function assertPlain(visit) {
  const shown = await visit.page.evaluate(() => document.querySelector("main").innerText);
  assert.doesNotMatch(shown, STATISTICS);
  assert.doesNotMatch(shown, /(^|[\s(])--[a-z]|chaintrue (fit|diagnose|plan|export|import)/);
  const folds = await visit.page.$$eval("#step-result .folds > details", (found) => found.filter((one) => one.checkVisibility()).length);
  assert.ok(folds <= MOST_FOLDS, `${folds} folded sections`);
}

const result = async (visit, cause) => {
  await visit.text("#step-result .cause", cause);
  await visit.text("#way-part button", "Type numbers in");
};
const isDisabled = (visit, text) => visit.page.$$eval("#way-part button", (buttons, wanted) => buttons.find((one) => one.textContent === wanted).disabled, text);
const invalid = (visit) => visit.page.$$eval("[aria-invalid]", (cells) => cells.length);

/** The folder of the page in a folder of the native command. */
async function nativeFolder(visit) {
  const folder = temporaryFolder();
  const files = await visit.folder();
  writeFolder(folder, Object.fromEntries(Object.entries(files).filter(([path]) => !path.includes("/"))));
  return {folder, files};
}

for (const browser of browsers) {
  walk("the first screen shows three machines, where their files are, and examples", browser, async (visit) => {
    assert.deepEqual(await visit.page.$$eval(".tile h3", (titles) => titles.map((title) => title.textContent)), ["Two chains", "Four belts", "A pen"]);
    for (const where of ["groundcontrol.ini is in your home folder", "maslow.yaml is in the machine's own file list", "Marlin answers M503"]) await visit.text(".tile", where);
    assert.equal((await visit.page.$$(".hero svg.part")).length, 2, "a part before and after");
    assert.equal((await visit.page.$$(".gallery svg")).length, 7);
    const tools = await visit.page.$$eval("header button", (buttons) => buttons.filter((one) => one.checkVisibility()).map((one) => one.textContent));
    assert.deepEqual(tools, [], "nothing to undo or to download yet");
    assert.deepEqual(await visit.page.$$eval(".step h2", (titles) => titles.map((title) => title.textContent)), ["Machine", "Measure", "Result", "Programs"]);
    await assertFits(visit, "the first screen");
  });

  walk("two chains: from the settings file to numbers that are typed in, a program and a check", browser, async (visit) => {
    await visit.upload("#settings", fixture("good/groundcontrol_ring.ini"));
    await visit.text(".banner", "groundcontrol_ring.ini is read");
    await visit.text("#machine-sled-assumed", "assumed 11.6 kg");
    assert.equal(await visit.page.$eval(".tiles", (tiles) => tiles.checkVisibility()), false, "the machine has taken the place of the first screen");
    await assertFits(visit, "the machine");
    await visit.click("On to measuring");
    await typeReadings(visit);
    await visit.text("#step-measure .said.good", "With this map it misses by about 0.2 mm");
    await visit.type(11, 1, "-230.5");
    await visit.text("tr.note", "is it -250.5 rather than -230.5?");
    await visit.text("#step-measure .said.caution", "Mark 12 is 20 mm from");
    await visit.click("Undo");
    await visit.text("#step-measure .said.good", "With this map");
    await assertFits(visit, "the readings");
    await visit.reload();
    assert.deepEqual(await visit.values(), READINGS.flat(), "a reload loses nothing");
    await visit.click("See the result");
    await result(visit, "links");
    await assertPlain(visit);
    assert.ok((await visit.page.$$("#step-result .errors .before")).length >= 28, "an arrow at each mark");
    await visit.text("#step-result .scale", "mm");
    await assertFits(visit, "the result");
    await visit.click("Type numbers in");
    const rows = await visit.text("#way-part .changes", "Distance Between Motors");
    assert.match(rows, /Chain Tolerance, Right Chain0\.170\.\d+Copy/, "label, old, new and a button");
    await visit.click("Programs");
    await visit.text("#step-cut", "Are the numbers in?");
    await visit.page.click("#step-cut .typed");
    await visit.text("#step-cut", "Where is home?");
    assert.equal(await visit.page.$eval("#program", (input) => input.checkVisibility()), false, "home is asked first");
    await visit.page.click("#home-middle");
    await visit.upload("#program", fixture("gcode/bracket.nc"));
    await visit.text("#step-cut .said", "the tool stays within");
    await visit.report("bracket.nc before and after");
    await visit.click("Verify it once more");
    await visit.text("#step-cut .said", "holds: the tool strays at most");
    await assertFits(visit, "a program");
    await compareChains(visit);
    await visit.click("Result");
    await visit.click("Set five new marks");
    await visit.page.waitForFunction(() => document.querySelectorAll(".list input").length === 10);
    for (const [row, [x, y]] of [["-1113", "508"], ["1114", "507"], ["-1113", "254"], ["-1112", "-508"], ["1114", "-508"]].entries()) {
      await visit.type(row, 0, x);
      await visit.type(row, 1, y);
    }
    await visit.page.keyboard.press("Tab");
    await visit.text("#step-measure .said", "The map ");
    assert.match(await visit.text("#step-measure button.main"), /Go on to your programs|Measure the whole bed again/);
    await assertFits(visit, "a check");
  }, {patience: 90_000});

  walk("a chain that jumped a tooth stops until it is read", browser, async (visit) => {
    await visit.click("A chain that jumped a tooth");
    await result(visit, "skipped teeth");
    await visit.text("#step-result .said.bad", "Mark 32 is mark 1 again, yet 6 mm lower: about one link. Did a chain jump?");
    await visit.text("#way-part", "Measure again first");
    assert.ok(await isDisabled(visit, "Type numbers in") && await isDisabled(visit, "Compensate each program"));
    await visit.click("Programs");
    await visit.text("#step-cut .said.bad", "Something moved while you measured");
    assert.equal(await visit.page.$eval("#program", (input) => input.checkVisibility()), false);
    await visit.page.click("#step-cut .read");
    await visit.text("#step-cut", "Where is home?");
    await visit.reload();
    await visit.click("Result");
    await visit.page.waitForFunction(() => document.querySelector("#step-result .read")?.checked);
    await visit.click("Compensate each program");
    await visit.text(".put-away", "with other numbers in the machine");
    await visit.click("Measure");
    await visit.type(0, 0, "-1095");
    await visit.page.keyboard.press("Tab");
    await visit.page.waitForFunction(() => document.querySelector("#step-measure .read")?.checked === false, {}, "another warning is read anew");
  });

  walk("a tape that is too long asks which of two causes it is; nothing wrong asks for nothing", browser, async (visit) => {
    await visit.click("A tape that is too long");
    await visit.text("#step-result .said.caution", "cannot show which");
    await visit.text("#way-part button", "Type numbers in");
    assert.ok(await isDisabled(visit, "Type numbers in"));
    await visit.click("Machine");
    await visit.unfold("Another machine, or an example");
    await visit.click("Nothing wrong");
    await visit.text("#step-result .said.good", "needs no map");
    await visit.text("#way-part", "Cut your programs as they are");
    await visit.text("#step-result .cause", "as large as the scatter of the readings");
    assert.doesNotMatch(await visit.text("#step-result .cause"), /Type in/);
  });

  walk("four belts: from one paste to numbers, places left out, a wish, holes and a program", browser, async (visit) => {
    await visit.paste("#paste", MASLOW4);
    await result(visit, "Most likely");
    assert.match(await visit.text("#step-result .headline"), /^Your machine misses by about 2\.5 mm\. With these anchors it misses by about 0\.1 mm\./);
    await assertPlain(visit);
    await visit.click("Type numbers in");
    await visit.text("#way-part .changes", "Top left X");
    await assertFits(visit, "the result");
    const {folder} = await nativeFolder(visit);
    for (const line of runNative(["export", "maslow4", "diagnosis.json"], folder).stdout.trim().split("\n")) await visit.text("#way-part .changes", line.split("=")[1]);
    await visit.page.type("#tape-tl-br", "3720");
    await visit.page.keyboard.press("Tab");
    await visit.text("#step-result", "was the tape held at its 100 mm mark?");
    await visit.click("Undo");
    await visit.click("Measure");
    await visit.page.type("#belts-wish", "0,5");
    await visit.page.keyboard.press("Tab");
    await visit.click("Result");
    await visit.text("#step-result .said", "Your target is 0.5 mm: reached");
    await visit.click("Measure");
    await visit.page.click("#leave-7");
    await visit.text("#step-measure tr.out th", "7");
    assert.equal(textOf((await visit.folder())["without.txt"]), "7");
    await visit.click("Plan nine holes");
    await visit.text("#step-measure .list");
    const about = await visit.page.$$eval("#step-measure .list tbody tr[data-row]", (rows) => rows.map((row, place) => Number(row.lastChild.textContent) + 0.2 * (place % 4)));
    await visit.paste('#step-measure tr[data-row="0"] input', about.join("\n"));
    await visit.text("#step-measure .said.bad", "Do not paste these anchors");
    await visit.click("Programs");
    await visit.page.click("#step-cut .read");
    await visit.click("Compensate each program instead");
    await visit.upload("#program", fixture("gcode/bracket.nc"));
    await visit.text("#step-cut .said", "the tool stays within");
    assert.match(textOf((await visit.folder())["anchors.json"]), /"scale"/);
  });

  walk("four belts: one wrong reading stops until it is read, and maslow.yaml waits for its log", browser, async (visit) => {
    await visit.paste("#paste", read("machines/maslow.yaml"));
    await visit.text(".banner", "maslow.yaml is read. Now open or paste");
    await visit.drop({"log.txt": read("good/maslow4_log.txt").replace("{bl:2344.38", "{bl:2324.38")});
    await visit.text("#step-result .said.caution", "is it 2342.38 rather than 2324.38?");
    await visit.text("#way-part button", "Type numbers in");
    assert.ok(await isDisabled(visit, "Type numbers in"));
    assert.deepEqual(await visit.page.$$eval("#step-result .spot.wrong", (spots) => spots.map(({dataset}) => dataset.point)), ["30"]);
    await visit.drop({"notes.log": "G0 X1\nG1 Y2\n"});
    await visit.text(".banner", "is a program, and is kept");
    assert.equal(visit.questions, 0, "nothing was replaced so far");
    await visit.drop({"groundcontrol.ini": read("good/groundcontrol_ring.ini")});
    await visit.text(".banner", "groundcontrol.ini is read");
    assert.equal(visit.questions, 1, "a machine with its readings is replaced after a question");
  });

  walk("a pen: from a mural's settings and a ruler to numbers and the second page", browser, async (visit) => {
    await visit.paste("#paste-plotter", read("plotter/mural.txt"));
    await visit.text("#step-machine", "Assumed: a mural");
    await visit.click("On to measuring");
    await visit.click("Download page.svg");
    assert.match(textOf(await visit.downloaded("page.svg")), /<svg/);
    await visit.drop({"drawing.json": JSON.stringify({...DRAWING, measures: DRAWING.measures.map((measure) => ({...measure, value_mm: null}))})});
    const first = 'tr[data-measure="0"] input';
    await visit.paste(first, VALUES.map((value) => (value / 25.4).toFixed(3)).join("\n"));
    await visit.text("#step-measure .said.bad", "inches");
    await visit.paste(first, VALUES.join("\n"));
    await visit.text("#step-measure .said.good", "The lines bow by up to 17.9 mm");
    await visit.click("See the result");
    await result(visit, "Settings are off");
    assert.equal((await visit.page.$$("#step-result .plotter-page .before")).length, 8, "eight bowed lines");
    await assertPlain(visit);
    await assertFits(visit, "the result");
    await visit.click("Type numbers in");
    const shown = await visit.text("#way-part .changes", "top distance");
    const {folder} = await nativeFolder(visit);
    for (const line of runNative(["export", "plotter", "found.json"], folder).stdout.trim().split("\n")) assert.ok(shown.includes(line.split(": ")[1]), line);
    await visit.click("Programs");
    await visit.text("#step-cut", "This plotter takes pictures");
    await visit.click("Result");
    await visit.click("Draw the second page");
    await visit.page.waitForFunction(() => [...document.querySelectorAll("tr[data-measure] input")].every(({value}) => value === ""));
  });

  walk("whatever is dropped is sorted and said, and a file of no use names what is expected", browser, async (visit) => {
    for (const [name, text, said] of [["empty.yaml", " \n", "empty.yaml is empty. Expected: groundcontrol.ini"], ["page.svg", "<svg xmlns='x'/>", "page.svg is a picture"],
      ["notes.txt", "buy chain oil", "notes.txt is neither settings nor readings nor a program"], ["marks.csv", MARKS, "Open its settings first"],
      ["a.ini", "nonsense\n", "expected [a section] or key = value"], ["wrong.zip", "no zip", "This zip cannot be read"]]) {
      await visit.drop({[name]: text});
      await visit.text(".banner.bad", said);
    }
    await visit.drop({"marks.csv": MARKS, "bracket.nc": read("gcode/bracket.nc"), "groundcontrol.ini": read("good/groundcontrol_ring.ini")});
    await visit.text("#step-measure .said.good, #step-cut .said.good, .banner", "bracket.nc is a program, and is kept");
    await visit.click("Measure");
    assert.deepEqual(await visit.values(), READINGS.flat(), "settings, readings and a program at once");
  });
}

/** Cell by cell with the keyboard alone, every third number with a comma; a half-typed row is not judged, the first half of the list is pasted. */
async function typeReadings(visit) {
  await (await visit.cell(0, 0)).focus();
  await visit.page.keyboard.type(READINGS[0][0].replace(".", ","));
  await new Promise((done) => setTimeout(done, 800));
  assert.equal(await invalid(visit), 0, "a half-typed row is not red");
  await visit.page.keyboard.press("ArrowRight");
  await visit.page.keyboard.type(READINGS[0][1]);
  await visit.paste('tr[data-row="1"] input', "1\t2");
  await visit.click("Undo");
  const errors = MARKS.trim().split("\n").map((line, row) => (row === 0 ? line : line.split(",").map((cell, column) => (column > 2 ? (Number(cell) - Number(line.split(",")[column - 2])).toFixed(1) : cell)).join(",")));
  await visit.paste('tr[data-row="0"] input', errors.join("\n"));
  await visit.text("#step-measure .said.caution", "look like errors");
  await visit.click("They are errors: add the places that were sent");
  await visit.text("#step-measure .said.good", "With this map");
  await visit.paste('tr[data-row="0"] input', MARKS);
  assert.deepEqual(await visit.values(), READINGS.flat(), "the project's own list can be pasted");
}

/** The program for the numbers typed in is that of the native command, byte for byte, and the map the same to the estimator's tolerance. */
async function compareChains(visit) {
  const {folder, files} = await nativeFolder(visit);
  const typed = runNative(["gcode", "compensate", "bracket.nc", "--map", "map.json", "--settings", "settings.ini", "-o", "typed.nc"], folder);
  assert.equal(typed.code, 0, typed.stderr);
  assert.equal(textOf(files["bracket.true.nc"]), readFileSync(join(folder, "typed.nc"), "utf8"));
  const fit = runNative(["fit", "marks.csv", "--machine", "machine.json", "-o", "native.json"], folder);
  assert.equal(fit.code, 0, fit.stderr);
  const rms = (text) => JSON.parse(text).accuracy.blocked.tool.rms_mm;
  // The estimator stops at 3e-3 of a sigma of tenths of a millimetre.
  assert.ok(Math.abs(rms(textOf(files["map.json"])) - rms(readFileSync(join(folder, "native.json"), "utf8"))) < 1e-6);
}
