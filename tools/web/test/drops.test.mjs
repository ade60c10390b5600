// SPDX-License-Identifier: GPL-3.0-or-later
// Programs dropped in sequence: the same twice, another while one is processed, after a stop, and wrong ones.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {after, before, describe, test} from "node:test";
import {folderOf} from "../page/zip.js";
import {browsers, fixture, Visit} from "./browser.mjs";
import {reliefOf} from "./relief.mjs";

const BRACKET = "bracket.nc before and after";
/** Large enough that the next program is dropped while this one is processed. */
const LONG_BYTES = 5e6;

/** Drops a file of these bytes on the area for programs. */
function drop(visit, name, bytes) {
  return visit.page.evaluate((called, text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], called));
    document.querySelector("#program").closest(".drop").dispatchEvent(new DragEvent("drop", {dataTransfer: data, bubbles: true, cancelable: true}));
  }, name, bytes.toString());
}

/** Marks the present reports as old, so that the next one found is new. */
const forget = (visit) => visit.page.$$eval("iframe.report", (frames) => frames.forEach((frame) => {
  frame.title = "an old report";
}));

for (const browser of browsers) {
  describe(`programs one after the other in ${browser}`, () => {
    let visit = null;
    const bracket = readFileSync(fixture("gcode/bracket.nc"));
    const relief = reliefOf(LONG_BYTES);
    before(async () => {
      visit = await Visit.to(browser);
      await visit.click("Try an example machine");
      await visit.text(".said", "With this map it misses by about 0.2 mm");
      await visit.click("Cut");
    });
    after(() => visit.close());

    test("the same program dropped again is shown again", async () => {
      for (let time = 0; time < 4; ++time) {
        await forget(visit);
        await drop(visit, "bracket.nc", bracket);
        await visit.report(BRACKET);
        await visit.text(".said", "the tool stays within 0.0439 mm");
      }
      assert.equal((await visit.page.$$("#step-cut iframe.report")).length, 1);
    });

    test("a program that is dropped while another is worked on takes its place", async () => {
      await drop(visit, "relief.nc", relief);
      await visit.text(".busy", "gcode");
      await drop(visit, "bracket.nc", bracket);
      await visit.report(BRACKET);
      await visit.page.waitForFunction(() => document.querySelector(".busy").hidden);
      assert.deepEqual(await visit.page.$$eval("#step-cut h3", (titles) => titles.map((title) => title.textContent)), ["Cut a part true", "bracket.nc"]);
      await visit.text(".said", "the tool stays within 0.0439 mm");
    });

    test("one that was stopped says so, and the next is shown", async () => {
      await drop(visit, "relief.nc", relief);
      await visit.text(".busy", "gcode");
      await visit.click("Stop");
      await visit.text(".said.problem", "relief.nc was not compensated. Open it once more to try again.");
      await drop(visit, "bracket.nc", bracket);
      await visit.report(BRACKET);
    });

    test("what is no program leaves the machine's folder alone", async () => {
      await drop(visit, "marks.csv", "1,2\n");
      await visit.text(".said.problem", "marks.csv is not opened: a G-code program's name ends in .nc");
      await drop(visit, "README.txt", "G0 X1\n");
      await visit.text(".said.problem", "README.txt is not opened: the machine's folder has a file of that name.");
      await visit.page.evaluate(() => {
        File.prototype.arrayBuffer = () => Promise.reject(new DOMException("a folder", "NotFoundError"));
      });
      await drop(visit, "folder.nc", "");
      await visit.text(".said.problem", "folder.nc cannot be read. Open a file, not a folder");
      await visit.click("Download");
      const files = folderOf(await visit.downloaded("my-machine.zip"));
      assert.match(new TextDecoder().decode(files["marks.csv"]), /^order,/);
      assert.equal(files["folder.nc"], undefined);
    });

    test("nothing was logged", () => assert.deepEqual(visit.problems, []));
  });
}

for (const [what, poor, outcome] of [["is begun again in another worker", 1, [".said", "With this map it misses by about 0.2 mm"]],
  ["a second time is said", 2, [".banner.bad", "The engine stopped unexpectedly (Out of memory)"]]]) {
  test(`a run that there is no memory for ${what}`, async () => {
    const visit = await Visit.to("chrome", {prepare: (page) => page.evaluateOnNewDocument((workers) => {
      const Given = Blob;
      const full = "WebAssembly.instantiate = () => Promise.reject(new RangeError('Out of memory'));";
      let made = 0;
      // The worker's source is the only script for which the page makes a Blob: the first few run out of memory.
      globalThis.Blob = class extends Given {
        constructor(parts, options) {
          super(options?.type === "text/javascript" && made++ < workers ? [full, ...parts] : parts, options);
        }
      };
    }, poor)});
    try {
      await visit.click("Try an example machine");
      await visit.text(...outcome);
      if (poor > 1) await visit.click("Try an example machine");
      await visit.text(".said", "With this map it misses by about 0.2 mm");
    } finally {
      await visit.close();
    }
  });
}
