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
      await visit.click("Try an example machine");
      await visit.text(".said", "With this map it misses by");
      await visit.click("See the map and the causes");
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
    test(`storage that is ${name} is said, and the download works, in ${browser}`, async () => {
      const visit = await Visit.to(browser, {prepare});
      try {
        await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
        await visit.type(0, 0, "-1113");
        assert.match(await visit.text(".banner", "keeps nothing"), name === "full" ? /storage is full/ : /private window/);
        await visit.click("Download");
        const folder = folderOf(await visit.downloaded("my-machine.zip"));
        assert.match(new TextDecoder().decode(folder["marks.csv"]), /^1,-1119,-509,-1113,$/m);
      } finally {
        await visit.close();
      }
    });
  }
}

describe("files", () => {
  test("a wrong settings file is told whole, and nothing is lost", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
      await visit.cell(0, 0);
      await visit.click("Machine");
      await visit.upload("#settings", fixture("bad/groundcontrol_wrong_types.ini"));
      const said = await visit.text(".said.problem", "expected");
      assert.match(said, /groundcontrol_wrong_types\.ini: line \d+/);
      await visit.upload("#settings", fixture("gcode/bracket.nc"));
      await visit.text(".said.problem", "bracket.nc");
      const zip = join(temporaryFolder(), "wrong.zip");
      writeFileSync(zip, "this is no zip");
      await visit.upload("#settings", zip);
      await visit.text(".said.problem", "This zip cannot be read");
      await visit.click("Measure");
      assert.equal((await visit.values()).length, 64);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("the zip that is given is taken back", async () => {
    const visit = await Visit.to("chrome");
    try {
      await visit.click("Try an example machine");
      await visit.text(".said", "With this map it misses by about 0.2 mm");
      const before = await visit.values();
      await visit.click("Download");
      const bytes = await visit.downloaded("my-machine.zip");
      const zip = join(temporaryFolder(), "my-machine.zip");
      writeFileSync(zip, bytes);
      await visit.click("Begin anew");
      await visit.upload("#settings", zip);
      await visit.text(".said", "With this map it misses by about 0.2 mm");
      assert.deepEqual(await visit.values(), before);
      assert.deepEqual(Object.keys(folderOf(bytes)).sort(), ["README.txt", "bracket.nc", "groundcontrol.ini", "holes.csv", "holes.html",
        "holes.nc", "machine.json", "map.json", "marks.csv", "marks.html", "marks.nc"]);
    } finally {
      await visit.close();
    }
  });

  test("a program of 5 MB is compensated, shown and given, and can be stopped", async () => {
    const visit = await Visit.to("chrome");
    try {
      const program = join(temporaryFolder(), "relief.nc");
      writeFileSync(program, reliefOf(5e6));
      await visit.click("Try an example machine");
      await visit.text(".said", "With this map it misses by about 0.2 mm");
      await visit.click("Cut");
      await visit.upload("#program", program);
      await visit.text(".busy", "gcode");
      await visit.click("Stop");
      await visit.page.waitForFunction(() => document.querySelector(".busy").hidden);
      await visit.click("Compensate relief.nc");
      await visit.text(".said", "the tool stays within");
      await visit.click("Download relief.true.nc");
      assert.ok((await visit.downloaded("relief.true.nc")).length > 5e6);
      assert.deepEqual(visit.problems, []);
    } finally {
      await visit.close();
    }
  });

  test("an engine that dies is said in a sentence, and loses no reading", async () => {
    const visit = await Visit.to("chrome", {prepare: (page) => page.evaluateOnNewDocument(() => {
      const post = Worker.prototype.postMessage;
      Worker.prototype.postMessage = function (message, ...rest) {
        // A run without words: the worker throws, as it does if the engine dies.
        return post.call(this, message.words?.[0] === "fit" && !globalThis.healthy ? {...message, files: null} : message, ...rest);
      };
    })});
    try {
      await visit.click("Try an example machine");
      await visit.text(".banner.bad", "The engine stopped unexpectedly");
      assert.equal((await visit.values())[0], "-1113");
      await visit.page.evaluate(() => {
        globalThis.healthy = true;
      });
      await visit.type(0, 0, "-1113.5");
      await visit.text(".said", "With this map it misses by");
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
        await visit.click("Try an example machine");
        await visit.text(".said", "With this map it misses by about 0.2 mm");
        await visit.type(11, 1, "-230.5");
        await visit.text("tr.note", "was left out");
        await visit.page.evaluate(axe);
        for (const step of ["Machine", "Measure", "Map and causes", "Cut", "Files"]) {
          await visit.click(step);
          if (step === "Map and causes") {
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

  test("a step begins at its top, also while its picture grows", async () => {
    const visit = await Visit.to("chrome", {width: 400});
    try {
      await visit.click("Try an example machine");
      await visit.text(".said", "With this map it misses by");
      await visit.click("See the map and the causes");
      await visit.text("#step-result .headline", "With this map it misses by");
      assert.equal(await visit.page.evaluate(() => scrollY), 0);
    } finally {
      await visit.close();
    }
  });
});
