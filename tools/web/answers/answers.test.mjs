// SPDX-License-Identifier: GPL-3.0-or-later
// The same answers: every verb on the fixtures, under node as a package and natively. Text, tables and G-code equal to
// the byte; numbers of JSON and of a report's charts to 1e-9 of their size.
import assert from "node:assert/strict";
import {cpSync, existsSync, readdirSync, readFileSync, rmSync, statSync} from "node:fs";
import {join, relative} from "node:path";
import {describe, test} from "node:test";
import {pathToFileURL} from "node:url";
import {built, root, runNative, temporaryFolder} from "../test/browser.mjs";

/** What other libraries of the C standard's functions may move a number by, of its size. */
const RELATIVE = 1e-9;
/** What is zero but for rounding has no size of its own: a millionth of a micrometre, of a hundredth of a percent. */
const ABSOLUTE = 1e-9;
/** The digits that a map's coefficients are written with: the last of them may round to either side. */
const WRITTEN_DIGITS = 7;

const {load} = await import(pathToFileURL(join(built, "chaintrue.mjs")).href);
const chaintrue = await load();

function filesBelow(folder, under = folder) {
  return readdirSync(folder, {withFileTypes: true}).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? filesBelow(path, under) : [relative(under, path)];
  });
}

const fixtures = filesBelow(join(root, "fixtures")).sort();
const of = (folder, pattern) => fixtures.filter((path) => path.startsWith(folder) && pattern.test(path)).map((path) => `fixtures/${path}`);

const CLASSIC = ["--machine", "fixtures/machines/classic.json"];
/** Command lines one after the other; a later one may read what an earlier one has written. */
const jobs = [
  ["--help-all"],
  ["--version"],
  ["formats", "--all", "formats"],
  ["effects"],
  ["start"],
  ["fit", "fixtures/grids/seven_by_four.json", "-o", "map.json", "--verbose"],
  ["fit", "fixtures/grids/seed_001.csv", "--surface", "direct", "-o", "direct.json"],
  ["fit", "fixtures/holes/nine_holes.json", "-o", "holes_map.json", "--json"],
  ["fit", "fixtures/grids/seven_by_four.json", "--with", "fixtures/holes/nine_holes.json", "-o", "both.json"],
  ["query", "map.json", "100", "200", "-1000", "-450", "5000", "0"],
  ["query", "map.json", "--inverse", "1700", "1800"],
  ["report", "map.json", "-o", "map.html"],
  ["report", "map.json", "--certificate", "-o", "certificate.html"],
  ["diagnose", "fixtures/grids/seven_by_four.json", "-o", "diagnosis.json", "--report", "diagnosis.html"],
  ["diagnose", "fixtures/holes/nine_holes.json", "-o", "holes_diagnosis.json"],
  ["plan", "fixtures/grids/seven_by_four.json", "--after", "diagnosis.json"],
  ["plan", "--check", "map.json", "-o", "five.csv"],
  ["check", "map.json", "fixtures/grids/five_new_points.json"],
  ["export", "groundcontrol", "fixtures/machines/groundcontrol.json"],
  ["simulate", ...CLASSIC, "--grid", "7x5", "--repeats", "6", "--length-noise-mm", "0.2", "--position-noise-mm", "0.3",
    "--effect", "chain_pitch_error:left:elongation=0.0012", "-o", "worn.json"],
  ["diagnose", "worn.json", "-o", "worn_diagnosis.json"],
  ["simulate", ...CLASSIC, "--holes", "9", "--distances", "20", "--draw-settings", "-o", "simulated_holes.json"],
  ["square", "--map", "map.json", "--size-mm", "900", "--gcode", "square.nc"],
  ["passes", ...CLASSIC, "--passes", "2", "--seed", "1"],
  ["sweep", "fixtures/sweeps/quick.json", "-o", "sweep"],
  ["fit", "fixtures/belts/thirty_one_places.json", "-o", "anchors.json"],
  ["export", "maslow4", "anchors.json"],
  ["import", "optical", "fixtures/good/optical_scan.csv", ...CLASSIC, "-o", "optical.json"],
  ["plan", ...CLASSIC, "--points", "28", "-o", "plan.csv", "--page", "plan.html", "--gcode", "plan.nc"],
  ["plan", ...CLASSIC, "--holes", "9", "-o", "holes.csv"],
  ...of("machines/", /\.json$/).flatMap((path) => [["effects", "chain_sag", "--machine", path],
    ["simulate", "--machine", path, "--grid", "3x3", "-o", "-"]]),
  ...of("good/", /groundcontrol_.*\.ini$/).map((path) => ["import", "groundcontrol", path, "-o", "-"]),
  ...of("good/", /maslow4_.*\.txt$/).map((path) => ["import", "maslow4", path, "-o", "-"]),
  ...of("good/", /grid_.*\.(csv|json)$/).map((path) => ["fit", path, ...CLASSIC, "-o", "-"]),
  ...of("good/", /(machine|diagnosis|belts|anchors|holes)_/).map((path) => ["report", path, "-o", "-"]),
  ...of("bad/", /groundcontrol_.*\.ini$/).map((path) => ["import", "groundcontrol", path, "-o", "-"]),
  ...of("bad/", /maslow4_.*\.txt$/).map((path) => ["import", "maslow4", path, "-o", "-"]),
  ...of("bad/", /optical_.*\.csv$/).map((path) => ["import", "optical", path, ...CLASSIC, "-o", "-"]),
  ...of("bad/", /grid_.*\.(csv|json)$/).map((path) => ["fit", path, ...CLASSIC, "-o", "-"]),
  ...of("bad/", /(holes|belts)_.*\.(csv|json)$/).map((path) => ["fit", path, ...CLASSIC, "-o", "-"]),
  ...of("bad/", /machine_.*\.json$/).map((path) => ["simulate", "--machine", path, "--grid", "3x3", "-o", "-"]),
  ...of("bad/", /(anchors|diagnosis|points)_/).map((path) => ["report", path, "-o", "-"]),
  ...of("gcode/corpus/", /\.(nc|ngc|gcode|tap)$/).flatMap((path) => [["gcode", "check", path, "--map", "map.json"],
    ["gcode", "lengths", path, "--map", "map.json"], ["gcode", "compensate", path, "--map", "map.json", "-o", "-"]]),
  ["gcode", "compensate", "fixtures/gcode/bracket.nc", "--map", "map.json", "-o", "bracket.true.nc", "--report", "bracket.html"],
  ["gcode", "verify", "fixtures/gcode/bracket.nc", "bracket.true.nc", "--map", "map.json"],
  ["gcode", "explain", "fixtures/gcode/bracket.nc:14", "--map", "map.json"],
];

const NUMBER = /-?\d+\.?\d*(?:[eE][-+]?\d+)?/g;
/** A hash over text whose last digits differ is another one. */
const withoutHashes = (text) => text.replace(/(?<![\w.])[0-9a-f]{16}(?![\w.])/g, "(hash)");

/** Equal texts, or the first lines that differ: the whole of a report is too long to be told. */
function assertSame(found, wanted, place) {
  if (found === wanted) return;
  const [a, b] = [found.split("\n"), wanted.split("\n")];
  const differing = a.findIndex((line, index) => line !== b[index]);
  const at = differing < 0 ? a.length : differing;
  assert.fail(`${place}: line ${at + 1} is ${JSON.stringify(a[at]?.slice(0, 300))}, natively ${JSON.stringify(b[at]?.slice(0, 300))}`);
}

/** A text without its numbers; lists of these are broken into lines by their digits. */
const wordsOf = (text) => text.replaceAll(NUMBER, "#").replaceAll(/#,\s+(?=#)/g, "#, ");

const decimalsOf = (text) => /^-?\d+\.(\d+)$/.exec(text)?.[1].length ?? 0;
const digitsOf = (text) => text.replace(/[eE].*/, "").replace(/^-?[0.]*/, "").replace(".", "").length;

/** Whether two texts are one number, written in few digits, that was rounded to neighbours. */
function isRoundedApart(a, b) {
  if (Math.max(digitsOf(a), digitsOf(b)) !== WRITTEN_DIGITS) return false;
  const step = 10 ** -Math.max(decimalsOf(a), decimalsOf(b));
  // A thousandth more: the two are not exact in binary.
  return Math.abs(Number(a) - Number(b)) <= 1.001 * step;
}

/** Texts whose numbers alone may differ, and these within the bounds; the largest difference found. */
function largestDifference(found, wanted, place) {
  const [a, b] = [withoutHashes(found), withoutHashes(wanted)];
  assertSame(wordsOf(a), wordsOf(b), place);
  const numbers = a.match(NUMBER) ?? [];
  let largest = {size: 0, place};
  for (const [order, {0: digits, index}] of [...b.matchAll(NUMBER)].entries()) {
    if (numbers[order] === digits || isRoundedApart(numbers[order], digits)) continue;
    const [is, was] = [Number(numbers[order]), Number(digits)];
    const size = Math.abs(is - was) / Math.abs(was);
    if (Math.abs(is - was) <= ABSOLUTE || size <= largest.size) continue;
    const line = b.slice(0, index).split("\n").length;
    largest = {size, place: `${place}: line ${line}: ${numbers[order]}, natively ${digits}`};
  }
  return largest;
}

const isOfNumbers = (path) => /(\.json|\.html|\/results\.csv)$/.test(path);
/** A sweep's own store, whose numbers are bits; what people read of it is compared in the reports. */
const isOfBits = (path) => path.endsWith(".cells");

describe("the same answers", {concurrency: 1}, () => {
  const folder = temporaryFolder();
  cpSync(join(root, "fixtures"), join(folder, "fixtures"), {recursive: true});
  const inMemory = Object.fromEntries(fixtures.map((path) => [`fixtures/${path}`, new Uint8Array(readFileSync(join(root, "fixtures", path)))]));
  const differences = [];

  for (const words of jobs) {
    test(`chaintrue ${words.join(" ")}`, async () => {
      const before = new Map(filesBelow(folder).map((path) => [path, statSync(join(folder, path)).mtimeMs]));
      const wanted = runNative(words, folder);
      // The corpus is large, and nobody reads it but by name.
      const read = Object.entries(inMemory).filter(([path]) => !path.startsWith("fixtures/gcode/corpus/") || words.includes(path));
      const found = await chaintrue.run(words, Object.fromEntries(read));
      const written = filesBelow(folder).filter((path) => before.get(path) !== statSync(join(folder, path)).mtimeMs);
      // Each verb is compared on the same input: what the native command wrote is what both read next.
      for (const path of written) inMemory[path] = new Uint8Array(readFileSync(join(folder, path)));
      const place = words.join(" ");
      assertSame(found.stderr, wanted.stderr, `${place}: standard error`);
      assert.equal(found.code, wanted.code, place);
      const ofThis = [];
      if (/^\s*\{/.test(wanted.stdout)) ofThis.push(largestDifference(found.stdout, wanted.stdout, place));
      else assertSame(found.stdout, wanted.stdout, `${place}: standard output`);
      assert.deepEqual(Object.keys(found.files).sort(), written.sort(), place);
      for (const path of written) {
        if (isOfBits(path)) {
          assert.equal(found.files[path].length, statSync(join(folder, path)).size, `${place}: ${path}: its size`);
          continue;
        }
        const [is, was] = [new TextDecoder().decode(found.files[path]), readFileSync(join(folder, path), "utf8")];
        if (isOfNumbers(path)) ofThis.push(largestDifference(is, was, `${place}: ${path}`));
        else assertSame(is, was, `${place}: ${path}`);
      }
      differences.push(...ofThis);
      for (const {size, place: where} of ofThis) assert.ok(size <= RELATIVE, `${where}: it differs by ${size.toExponential(1)} of its size`);
    });
  }

  test("the largest difference", (context) => {
    const sorted = differences.sort((a, b) => b.size - a.size);
    for (const {size, place} of sorted.slice(0, 5)) context.diagnostic(`${size.toExponential(1)}  ${place}`);
    assert.ok(differences.length > 50, "the comparison has seen files");
    rmSync(folder, {recursive: true});
    assert.ok(!existsSync(folder));
  });
});
