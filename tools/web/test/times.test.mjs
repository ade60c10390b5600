// SPDX-License-Identifier: GPL-3.0-or-later
// How long an owner waits, told and not judged: a machine with other work is slower.
import {cpSync, readFileSync} from "node:fs";
import {join} from "node:path";
import {performance} from "node:perf_hooks";
import {test} from "node:test";
import {pathToFileURL} from "node:url";
import {built, fixture, root, runNative, temporaryFolder, Visit} from "./browser.mjs";

/** The shortest of a few, in seconds: what the work takes where nothing else runs. */
async function shortest(times, work) {
  let best = Infinity;
  for (let i = 0; i < times; ++i) {
    const begun = performance.now();
    await work();
    best = Math.min(best, (performance.now() - begun) / 1000);
  }
  return best;
}

test("times", async (context) => {
  const say = (what, seconds, beside = "") => context.diagnostic(`${what}: ${seconds.toFixed(2)} s${beside}`);

  const {load} = await import(pathToFileURL(join(built, "chaintrue.mjs")).href);
  const chaintrue = await load();
  const folder = temporaryFolder();
  cpSync(fixture("start/marks.csv"), join(folder, "marks.csv"));
  cpSync(fixture("machines/groundcontrol.json"), join(folder, "machine.json"));
  const files = Object.fromEntries(["marks.csv", "machine.json"].map((name) => [name, new Uint8Array(readFileSync(join(folder, name)))]));
  for (const words of [["fit", "marks.csv", "--machine", "machine.json", "-o", "-"],
    ["diagnose", "marks.csv", "--machine", "machine.json", "--noise-length-mm", "0.1", "--noise-position-mm", "0.5", "-o", "-"]]) {
    const native = await shortest(5, () => runNative(words, folder));
    const here = await shortest(5, () => chaintrue.run(words, files));
    say(`${words[0]} of 28 points`, here, `, natively ${native.toFixed(2)} s: ${(here / native).toFixed(1)} times`);
  }

  const visit = await Visit.to("chrome");
  say("from opening the file to usable", await shortest(3, () => visit.reload()));
  await visit.upload("#settings", fixture("good/groundcontrol_ring.ini"));
  await visit.cell(0, 0);
  await visit.click("Download");
  await visit.downloaded("my-machine.zip");
  const begun = performance.now();
  await visit.click("Machine");
  await visit.click("Try an example machine");
  await visit.text(".said", "the map leaves");
  await visit.click("See the map and the causes");
  await visit.report("The map");
  say("from the example machine to the drawn report, with two clicks", (performance.now() - begun) / 1000);
  await visit.click("Cut");
  const dropped = performance.now();
  await visit.upload("#program", join(root, "fixtures/gcode/bracket.nc"));
  await visit.report("bracket.nc before and after");
  say("from a program dropped to its report", (performance.now() - dropped) / 1000);
  await visit.close();
});
