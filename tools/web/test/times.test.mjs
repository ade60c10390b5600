// SPDX-License-Identifier: GPL-3.0-or-later
// Waiting times, reported but not tested: a busy machine is slower.
import {cpSync, readFileSync} from "node:fs";
import {join} from "node:path";
import {performance} from "node:perf_hooks";
import {test} from "node:test";
import {pathToFileURL} from "node:url";
import {built, fixture, root, runNative, temporaryFolder, Visit} from "./browser.mjs";

/** Longer times are not reported: a user would have closed the page. */
const PATIENCE_MS = 30_000;
const MOST_TIMES = 5;

/** The shortest of a few, in seconds: the time on an idle machine. */
async function shortest(times, work) {
  let best = Infinity;
  const until = performance.now() + PATIENCE_MS;
  for (let i = 0; i < times && performance.now() < until; ++i) {
    const begun = performance.now();
    await work();
    best = Math.min(best, (performance.now() - begun) / 1000);
  }
  return best;
}

test("times of the package", async (context) => {
  const {load} = await import(pathToFileURL(join(built, "chaintrue.mjs")).href);
  const chaintrue = await load();
  const folder = temporaryFolder();
  cpSync(fixture("start/marks.csv"), join(folder, "marks.csv"));
  cpSync(fixture("machines/groundcontrol.json"), join(folder, "machine.json"));
  const files = Object.fromEntries(["marks.csv", "machine.json"].map((name) => [name, new Uint8Array(readFileSync(join(folder, name)))]));
  for (const words of [["fit", "marks.csv", "--machine", "machine.json", "-o", "-"],
    ["diagnose", "marks.csv", "--machine", "machine.json", "--noise-length-mm", "0.1", "--noise-position-mm", "0.5", "-o", "-"]]) {
    const native = await shortest(MOST_TIMES, () => runNative(words, folder));
    const here = await shortest(MOST_TIMES, () => chaintrue.run(words, files));
    context.diagnostic(`${words[0]} of 28 points: ${here.toFixed(2)} s, natively ${native.toFixed(2)} s: ${(here / native).toFixed(1)} times`);
  }
});

test("times of the page", async (context) => {
  const say = (what, seconds) => context.diagnostic(`${what}: ${seconds.toFixed(2)} s`);
  let visit = null;
  const since = (begun) => (performance.now() - begun) / 1000;
  try {
    visit = await Visit.to("chrome", {patience: PATIENCE_MS});
    say("from opening the file to usable", await shortest(3, () => visit.reload()));
    let begun = performance.now();
    await visit.click("Try an example machine");
    await visit.text(".said", "With this map it misses by");
    await visit.click("See the map and the causes");
    await visit.text("#step-result .headline", "With this map it misses by");
    say("from the example machine to the result, with two clicks", since(begun));
    begun = performance.now();
    await visit.click("Find the cause");
    await visit.text("#step-result .verdict", "probability");
    say("from there to the verdict", since(begun));
    await visit.unfold("The whole report");
    await visit.report("The map");
    say("from the example machine to the drawn report, with three clicks", since(begun));
    await visit.click("Cut");
    begun = performance.now();
    await visit.upload("#program", join(root, "fixtures/gcode/bracket.nc"));
    await visit.report("bracket.nc before and after");
    say("from a program dropped to its report", since(begun));
    await visit.click("Begin anew");
    begun = performance.now();
    await visit.paste("#paste", readFileSync(fixture("machines/maslow.yaml"), "utf8") + readFileSync(fixture("good/maslow4_log.txt"), "utf8"));
    await visit.text("#step-result .verdict", "Most likely");
    say("from a Maslow 4's log pasted to its verdict", since(begun));
  } catch (problem) {
    context.diagnostic(`what follows was not reached within ${PATIENCE_MS / 1000} s a step: ${problem.message}`);
  } finally {
    await visit?.close();
  }
});
