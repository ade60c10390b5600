// SPDX-License-Identifier: GPL-3.0-or-later
// The page leads: one step is open, the result comes before the statistics, one choice is remembered, causes can be used,
// assumptions stand where they were made, words are explained, and a tape held at its 100 mm mark has a tick.
import assert from "node:assert/strict";
import {describe, test} from "node:test";
import {fitParts} from "../page/measure_words.js";
import {inPage} from "../page/in_page.js";
import {browsers, fixture, Visit} from "./browser.mjs";

const openSteps = (visit) => visit.page.$$eval(".step-body", (bodies) => bodies.filter((body) => body.checkVisibility()).map(({id}) => id));
const given = (visit, step) => visit.page.$eval(`#given-${step}`, (line) => (line.checkVisibility() ? line.textContent : ""));
const settled = (visit) => visit.text("#step-measure .said", "With this map it misses by about");

/** Words that an owner does not see before unfolding something, and the most words of a first screen. */
const STATISTICS = /\b(rms|sigma|residual|held out|stated|nominal|compliance|chebyshev|likeness)\b/i;
const MOST_WORDS_OF_A_RESULT = 60;

for (const browser of browsers) {
  test(`one step is open, the others say what was given, in ${browser}`, async () => {
    const visit = await Visit.to(browser);
    try {
      assert.deepEqual(await openSteps(visit), ["step-machine"]);
      await visit.upload("#settings", fixture("good/groundcontrol_ring.ini"));
      await visit.text("#machine-sled-assumed", "assumed 11.6 kg");
      await visit.text("#machine-tilt-assumed", "assumed 15 degrees");
      await visit.text("ul.assumed", "how far the chain stretches");
      assert.deepEqual(await openSteps(visit), ["step-machine"], "what was assumed is not jumped over");
      await visit.click("On to measuring");
      assert.match(await given(visit, "machine"), /sheet 2438.4 x 1219.2 mm, motors 2978 mm apart; 5 numbers assumed/);
      assert.equal(await given(visit, "measure"), "", "an open step needs no line");
      await visit.click("Machine");
      await visit.page.$eval("#machine-sled", (input) => input.select());
      await visit.page.type("#machine-sled", "12");
      await visit.page.keyboard.press("Tab");
      await visit.page.waitForFunction(() => document.querySelector("#machine-sled-assumed").textContent === "");
      await visit.click("A worn chain");
      await settled(visit);
      await visit.click("See the map and the causes");
      assert.deepEqual(await openSteps(visit), ["step-result"]);
      assert.equal(await given(visit, "measure"), "32 of 32 marks typed in");
      assert.equal(await visit.page.evaluate(() => document.activeElement.id), "title-result", "the focus follows the step that was opened");
      assert.equal(await visit.page.$eval("#title-measure", (title) => title.getAttribute("aria-expanded")), "false");
      await visit.click("Measure");
      assert.deepEqual(await openSteps(visit), ["step-measure"], "a click opens it again");
      assert.match(await given(visit, "result"), /^Your machine misses by about/);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test(`the choice is remembered, and the other put away with the way back, in ${browser}`, async () => {
    const visit = await Visit.to(browser);
    try {
      await visit.click("A worn chain");
      await settled(visit);
      await visit.click("See the map and the causes");
      await visit.text("#step-result h3", "What now? Choose one");
      const first = await visit.page.$eval("#step-result section", (section) => section.innerText);
      assert.doesNotMatch(first, STATISTICS);
      assert.ok(first.split(/\s+/).length <= MOST_WORDS_OF_A_RESULT, `${first.split(/\s+/).length} words: ${first}`);
      assert.ok((await visit.page.$$("#step-result section:first-of-type .errors .before")).length >= 28, "an arrow at each mark");
      await visit.click("Type numbers in");
      await visit.text("#step-result pre", "motorspacingx");
      await visit.text("#step-result .put-away", "Compensating each job is put away: a program compensated for the old numbers comes out wrong");
      await visit.reload();
      await visit.text("#step-result .put-away", "Compensating each job is put away");
      await visit.click("Measure");
      await visit.type(0, 0, "-1113.5");
      await visit.click("Undo");
      await visit.click("Cut");
      await visit.text("#step-cut .put-away", "Compensating each job is put away");
      assert.equal(await visit.page.$eval("#program", (input) => input.checkVisibility()), false);
      await visit.click("Compensate each job instead");
      await visit.page.waitForSelector("#program", {visible: true});
      await settledIn(visit);
      await visit.click("Map and causes");
      await visit.text("#step-result .put-away", "Typing numbers in is put away");
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });
}

/** What a part of the page shows before anything is unfolded, held to the words of a workshop. */
async function assertPlain(visit, selector) {
  const words = (await visit.page.$eval(selector, (part) => part.innerText)).trim().split(/\s+/);
  const first = words.slice(0, MOST_WORDS_OF_A_RESULT).join(" ");
  assert.ok(words.length > 3, `nothing stands in ${selector}`);
  assert.doesNotMatch(first, STATISTICS, selector);
}

/** The map that was made anew after an undo is there. */
const settledIn = (visit) => visit.page.waitForFunction(() => /misses by about/.test(document.querySelector("#given-result").textContent));

describe("in Chromium", () => {
  test("the first words of a diagnosis and of four belts are those of a workshop", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.click("A worn chain");
      await settled(visit);
      await visit.click("See the map and the causes");
      await visit.click("Find the cause");
      await visit.text("#step-result .verdict", "links");
      await assertPlain(visit, "#step-result .verdict");
      await assertPlain(visit, "#step-result .causes");
      await visit.click("Machine");
      await visit.click("A Maslow 4");
      await visit.text("#step-result .verdict", "Most likely");
      await assertPlain(visit, "#belts-first");
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("causes are ranked with what to do, and a map that uses them says what changed", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.click("A chain that jumped a tooth");
      await settled(visit);
      await visit.click("See the map and the causes");
      await visit.click("Find the cause");
      await visit.text("#step-result .verdict", "jumped over teeth");
      await visit.text("#step-result .causes", "tooth skip, left");
      await visit.text("#step-result", "Look for a slack chain");
      await visit.page.waitForSelector("#step-result .causes .picture", {visible: true});
      const arrows = await visit.page.$$eval("#step-result .causes .picture", (pictures) => pictures.map((picture) => picture.querySelectorAll(".before").length));
      assert.ok(arrows.length >= 1 && arrows.every((count) => count >= 28), `arrows in the pictures of the causes: ${arrows}`);
      await visit.text("#step-result .causes .picture figcaption", "what this alone does");
      const ranks = await visit.page.$$eval("#step-result .causes .bar span", (bars) => bars.map((bar) => Number.parseFloat(bar.style.width)));
      assert.deepEqual(ranks, [...ranks].sort((one, other) => other - one));
      assert.ok(ranks.length > 10);
      const used = await visit.text("#use-causes .said", "Found, and used in the map");
      assert.match(used, /the chain jumped over teeth/);
      await visit.click("Build the map without causes");
      const said = await visit.text("#use-causes .said", "Now:");
      const [before, now] = ["Before", "Now"].map((when) => Number(new RegExp(`${when}: .*?With this map it misses by about ([\\d.]+) mm`).exec(said)[1]));
      assert.ok(before < now, `${before} mm with the causes, ${now} mm without`);
      await visit.text("#step-result .verdict", "jumped over teeth");
      await visit.click("Build the map with the causes that are found");
      await visit.text("#step-result .headline", `With this map it misses by about ${before} mm`);
      await visit.click("Measure");
      await visit.type(0, 0, "-1113.5");
      await visit.click("Map and causes");
      await visit.page.waitForFunction(() => !document.querySelector("#step-result .verdict"));
      await visit.click("Undo");
      await visit.text("#step-result .verdict", "jumped over teeth");
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("causes that make the map no better are said, and left out of it", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.click("A worn chain");
      await settled(visit);
      await visit.click("See the map and the causes");
      assert.match(await visit.text("#use-causes .said", "Probable cause"), /the chain's links are worn.*The map already corrects it/);
      await visit.reload();
      await visit.text("#use-causes .said", "Probable cause");
    } finally {
      await visit.close();
    }
  });

  test("a tape held at its 100 mm mark is ticked, and the sentence that asks for it names the tick", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
      assert.equal(await visit.page.$eval("#hook", (tick) => tick.checkVisibility()), false, "marks know of no tape");
      await visit.page.select("#way", "holes.csv");
      const about = await visit.page.$$eval(".list tbody tr[data-row]", (rows) => rows.map((row) => Number(row.lastChild.textContent)));
      for (const [row, mm] of about.entries()) await visit.page.$eval(`tr[data-row="${row}"] input`, (input, value) => {
        input.value = value;
        input.dispatchEvent(new Event("input", {bubbles: true}));
      }, String(mm + 100));
      const said = await visit.text("#step-measure .said.problem", "from 100 mm");
      assert.doesNotMatch(said, /--/);
      await visit.page.click("#hook");
      await visit.text("#step-measure .said:not(.problem)", "Your machine");
      await visit.unfold("How to measure");
      await visit.text(".how figcaption", "Hold the tape's 100 mm mark to the hole, and tick \"from 100 mm\" when you type.");
      await visit.click("Show the sheet to print");
      const frame = await (await visit.page.waitForSelector("iframe")).contentFrame();
      await frame.waitForFunction(() => document.body?.textContent.includes('tick "from 100 mm" when you type'));
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("a dotted word says its meaning on a click and on Enter, and stays on a screen of 400 px", async () => {
    const visit = await Visit.to("chrome", {width: 400});
    try {
      await visit.click("A worn chain");
      await settled(visit);
      const button = await visit.page.waitForSelector("#step-measure .word", {visible: true});
      await button.focus();
      await visit.page.keyboard.press("Enter");
      await visit.text(".meaning", "A table of how far off the machine is");
      const {left, right} = await visit.page.$eval(".meaning", (meaning) => meaning.getBoundingClientRect().toJSON());
      assert.ok(left >= 0 && right <= 400, `${left} to ${right} px`);
      await visit.page.keyboard.press("Escape");
      assert.equal(await visit.page.$eval(".meaning", (meaning) => meaning.checkVisibility()), false);
      await button.click();
      await visit.text(".meaning", "A table");
    } finally {
      await visit.close();
    }
  });

  test("an evening goes by keyboard alone", async () => {
    const visit = await Visit.to("chrome");
    try {
      await press(visit, "A worn chain");
      await settled(visit);
      await press(visit, "See the map and the causes");
      await visit.text("#step-result .headline", "misses by about");
      await press(visit, "Find the cause");
      await visit.text("#step-result .verdict", "links");
      await visit.text("#use-causes .said", "Probable cause");
      await press(visit, "Compensate each job");
      await press(visit, "Open a program to cut");
      await visit.page.waitForSelector("#program", {visible: true});
      assert.equal(await visit.page.evaluate(() => document.activeElement.id), "title-cut");
    } finally {
      await visit.close();
    }
  });
});

/** More than there are places to stop at on a page. */
const MOST_TABS = 200;

/** Goes on by Tab until the button of this text has the focus, and presses Enter. */
async function press(visit, text) {
  await visit.page.waitForFunction((wanted) => [...document.querySelectorAll("button")].some((one) => one.textContent === wanted && one.checkVisibility()), {}, text);
  for (let tab = 0; tab < MOST_TABS; ++tab) {
    if (await visit.page.evaluate((wanted) => document.activeElement.tagName === "BUTTON" && document.activeElement.textContent === wanted, text)) {
      await visit.page.keyboard.press("Enter");
      return;
    }
    await visit.page.keyboard.press("Tab");
  }
  assert.fail(`no Tab leads to the button ${text}`);
}

test("options of the command become words of the page", () => {
  for (const [said, wanted] of [
    ["give 100 mm (hook_offset_mm of the tape, or --hook-offset-mm); 0 if they are right", "tick \"from 100 mm\" if the tape was held at its 100 mm mark; 0 if they are right"],
    ["Assumed: a frame that stands upright, its lower belts pulled (--orientation).", "Assumed: a frame that stands upright, its lower belts pulled (a frame on the floor: choose that under \"How the log is read\")."],
    ["Something (see --that).", "Something."], ["Nothing to change (1.5 mm).", "Nothing to change (1.5 mm)."],
  ]) assert.equal(inPage(said), wanted);
});

test("the headline, the other sentences and the tables of a fit are told apart", () => {
  const parts = fitParts(["a.csv: line 3: odd", "Your machine misses by about 3 mm. With this map it misses by about 0.2 mm.", "It is least sure.", "Settings       stated", "  left motor"]);
  assert.deepEqual(parts, {headline: "Your machine misses by about 3 mm. With this map it misses by about 0.2 mm.",
    sentences: ["a.csv: line 3: odd", "It is least sure."], tables: ["Settings       stated", "  left motor"]});
  assert.equal(fitParts(["Only 3 points"]).headline, null);
});
