// SPDX-License-Identifier: GPL-3.0-or-later
// No network, wrong files, no storage, large programs, a dead engine, and what axe-core finds.
import assert from "node:assert/strict";
import {createServer} from "node:http";
import {readFileSync, writeFileSync} from "node:fs";
import {createRequire} from "node:module";
import {join} from "node:path";
import {pathToFileURL} from "node:url";
import {describe, test} from "node:test";
import {folderOf} from "../page/zip.js";
import {browsers, built, fixture, temporaryFolder, Visit} from "./browser.mjs";
import {reliefOf} from "./relief.mjs";

/** A document in which a script tries every kind of request. */
async function tryEveryWayOut(server) {
  const image = new Image();
  image.src = `${server}/image`;
  const script = document.createElement("script");
  script.src = `${server}/script`;
  const style = document.createElement("link");
  Object.assign(style, {rel: "stylesheet", href: `${server}/style`});
  const frame = document.createElement("iframe");
  frame.src = `${server}/frame`;
  const media = document.createElement("video");
  media.src = `${server}/media`;
  document.body.append(image, script, style, frame, media);
  navigator.sendBeacon?.(`${server}/beacon`);
  try {
    new WebSocket(server.replace("http", "ws")).onerror = () => {};
    new EventSource(`${server}/events`);
  } catch {
    // An immediate refusal is a refusal as well.
  }
  await fetch(`${server}/fetch`, {mode: "no-cors"}).catch(() => {});
  await new Promise((resolve) => setTimeout(resolve, 1000));
}

/** A server that counts requests. */
async function listening() {
  const asked = [];
  const server = createServer((request, response) => {
    asked.push(request.url);
    response.end();
  });
  server.on("upgrade", (request, socket) => {
    asked.push("websocket");
    socket.destroy();
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {asked, url: `http://127.0.0.1:${server.address().port}`, close: () => server.close()};
}

for (const browser of browsers) {
  test(`nothing reaches a network from the page or from a report, in ${browser}`, async () => {
    const server = await listening();
    const visit = await Visit.to(browser);
    try {
      await visit.page.evaluate(tryEveryWayOut, server.url);
      await visit.click("A worn chain");
      await visit.text("#way-part", "Type numbers in");
      await visit.unfold("The whole report");
      const report = await visit.report("The map");
      await report.evaluate(tryEveryWayOut, server.url);
      assert.deepEqual(server.asked, []);
      // The attempts are effective: without the policy they reach the server.
      const open = join(temporaryFolder(), "open.html");
      writeFileSync(open, "<!DOCTYPE html><title>open</title><body></body>");
      await visit.page.goto(pathToFileURL(open).href);
      await visit.page.evaluate(tryEveryWayOut, server.url);
      assert.ok(server.asked.length >= 5, `only these arrived without a policy: ${server.asked}`);
    } finally {
      await visit.close();
      server.close();
    }
  });

  for (const [name, prepare] of Object.entries({
    "forbidden": (page) => page.evaluateOnNewDocument(() => {
      indexedDB.open = () => {
        throw new DOMException("denied", "SecurityError");
      };
    }),
    "full": (page) => page.evaluateOnNewDocument(() => {
      IDBObjectStore.prototype.put = () => {
        throw new DOMException("full", "QuotaExceededError");
      };
    }),
  })) {
    test(`storage that is ${name} is reported, and the download works, in ${browser}`, async () => {
      const visit = await Visit.to(browser, {prepare});
      try {
        await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
        await visit.type(0, 0, "-1113");
        assert.match(await visit.text(".banner", "keeps nothing"), name === "full" ? /storage is full/ : /private window/);
        const folder = await visit.folder();
        assert.match(new TextDecoder().decode(folder["marks.csv"]), /^1,-1119,-509,-1113,$/m);
      } finally {
        await visit.close();
      }
    });
  }
}

describe("files", () => {
  test("all problems of a wrong settings file are reported, and nothing is lost", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
      await visit.cell(0, 0);
      await visit.upload("#any", fixture("bad/groundcontrol_wrong_types.ini"));
      assert.match(await visit.text(".banner.bad", "expected"), /groundcontrol_wrong_types\.ini: line \d+/);
      assert.equal((await visit.values()).length, 64);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("the zip that is given is taken back", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.click("A worn chain");
      await visit.text("#step-result .said", "With this map it misses by about 0.2 mm");
      await visit.text("#step-result .cause", "links");
      const before = await visit.values();
      await visit.click("Download");
      const bytes = await visit.downloaded("my-machine.zip");
      const zip = join(temporaryFolder(), "my-machine.zip");
      writeFileSync(zip, bytes);
      await visit.click("Begin anew");
      await visit.upload("#settings", zip);
      await visit.text("#step-measure .said", "With this map it misses by about 0.2 mm");
      assert.deepEqual(await visit.values(), before);
      assert.deepEqual(Object.keys(folderOf(bytes)).sort(), ["README.txt", "bracket.nc", "diagnosis.json", "groundcontrol.ini", "holes.csv", "holes.html",
        "holes.nc", "machine.json", "map.json", "marks.csv", "marks.html", "marks.nc"]);
    } finally {
      await visit.close();
    }
  });

  test("a program of 5 MB can be stopped, gives way to the next one, and is compensated", async () => {
    const visit = await Visit.to("chrome");
    try {
      const program = join(temporaryFolder(), "relief.nc");
      writeFileSync(program, reliefOf(5e6));
      await visit.click("A worn chain");
      await visit.text("#way-part", "Type numbers in");
      await visit.click("Programs");
      await visit.page.click("#home-middle");
      await visit.upload("#program", program);
      await visit.text(".busy", "gcode");
      await visit.click("Stop");
      await visit.text("#step-cut .said.bad", "relief.nc was not compensated. Open it once more to try again.");
      await visit.click("Compensate relief.nc");
      await visit.text(".busy", "gcode");
      await visit.drop({"other.nc": readFileSync(fixture("gcode/bracket.nc"), "utf8")});
      await visit.report("other.nc before and after");
      await visit.page.waitForFunction(() => document.querySelector(".busy").hidden);
      assert.equal((await visit.page.$$("#step-cut iframe.report")).length, 1);
      await visit.drop({"README.txt": "G0 X1\n"});
      await visit.text(".banner.bad", "README.txt is not opened: the machine's folder has a file of that name.");
      await visit.click("Compensate relief.nc");
      await visit.text("#step-cut .said", "the tool stays within");
      await visit.click("Download relief.true.nc");
      assert.ok((await visit.downloaded("relief.true.nc")).length > 5e6);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("a dead engine is reported and loses no reading", async () => {
    const visit = await Visit.to("chrome", {prepare: (page) => page.evaluateOnNewDocument(() => {
      const post = Worker.prototype.postMessage;
      Worker.prototype.postMessage = function (message, ...rest) {
        // A run without words: the worker throws, as it does if the engine dies.
        return post.call(this, message.words?.[0] === "fit" && !globalThis.healthy ? {...message, files: null} : message, ...rest);
      };
    })});
    try {
      await visit.click("A worn chain");
      await visit.text(".banner.bad", "The engine stopped unexpectedly");
      await visit.click("Measure");
      assert.equal((await visit.values())[0], "-1125.5");
      await visit.page.evaluate(() => {
        globalThis.healthy = true;
      });
      await visit.type(0, 0, "-1124.5");
      await visit.text("#step-measure .said", "With this map it misses by");
    } finally {
      await visit.close();
    }
  });
});

describe("for everybody", () => {
  const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

  for (const [width, dark] of [[1280, false], [400, true]]) {
    test(`axe-core finds nothing serious, and nothing stands out of the screen, at ${width} px ${dark ? "dark" : "light"}`, async () => {
      const visit = await Visit.to("chrome", {width, dark});
      try {
        await visit.click("A worn chain");
        await visit.text("#step-result .said", "With this map it misses by about 0.2 mm");
        await visit.click("Measure");
        await visit.type(11, 1, "-230.5");
        await visit.text("tr.note", "rather than -230.5");
        await visit.page.evaluate(axe);
        for (const step of ["Machine", "Measure", "Result", "Programs"]) {
          await visit.click(step);
          if (step === "Result") {
            await visit.unfold("The whole report");
            await visit.report("The map");
          }
          const found = await visit.page.evaluate(() => axe.run(document, {iframes: false}));
          const serious = found.violations.filter(({impact}) => impact === "serious" || impact === "critical");
          assert.deepEqual(serious.map(({id, nodes}) => `${id}: ${nodes[0].html}`), [], step);
          const over = await visit.page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
          assert.equal(over, 0, `${step} is ${over} px wider than the screen`);
        }
      } finally {
        await visit.close();
      }
    });
  }

  test("an evening goes by keyboard alone, a word says its meaning, and a step begins at its top", async () => {
    const visit = await Visit.to("chrome", {width: 400});
    try {
      await press(visit, "A worn chain");
      await visit.text("#way-part button", "Type numbers in");
      const word = await visit.page.waitForSelector("#step-result .word", {visible: true});
      await word.focus();
      await visit.page.keyboard.press("Enter");
      await visit.text(".meaning", "A table of how far off the machine is");
      const {left, right} = await visit.page.$eval(".meaning", (meaning) => meaning.getBoundingClientRect().toJSON());
      assert.ok(left >= 0 && right <= 400, `${left} to ${right} px`);
      await visit.page.keyboard.press("Escape");
      assert.equal(await visit.page.$eval(".meaning", (meaning) => meaning.checkVisibility()), false);
      await press(visit, "Compensate each program");
      await press(visit, "Open a program");
      await visit.page.waitForSelector("#home-middle", {visible: true});
      assert.equal(await visit.page.evaluate(() => document.activeElement.id), "title-cut");
      assert.equal(await visit.page.evaluate(() => scrollY), 0);
    } finally {
      await visit.close();
    }
  });
});

/** More than there are places to stop at on a page. */
const MOST_TABS = 200;

/** Goes on by Tab until the button of this name has the focus, and presses Enter. */
async function press(visit, name) {
  for (let tab = 0; tab < MOST_TABS; ++tab) {
    if (await visit.page.evaluate((wanted) => document.activeElement.tagName === "BUTTON" && (document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent) === wanted, name)) {
      await visit.page.keyboard.press("Enter");
      return;
    }
    await visit.page.keyboard.press("Tab");
  }
  assert.fail(`no Tab leads to the button ${name}`);
}
