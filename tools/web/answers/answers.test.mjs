// SPDX-License-Identifier: GPL-3.0-or-later
// Equal results: every verb on the fixtures, as a package under node and natively. Text, tables and G-code equal to
// the byte; numbers of JSON and of a report's charts to 1e-9 of their size.
//   node --test answers/                       every verb on each kind of file: two minutes
//   ANSWERS=all node --test answers/           all of them
//   ANSWERS=200-400 node --test answers/       those of these numbers, and what they read
import assert from "node:assert/strict";
import {cpSync, existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {describe, test} from "node:test";
import {pathToFileURL} from "node:url";
import {built, root, runNative, temporaryFolder} from "../test/browser.mjs";
import {assertSame, isOfBits, isOfNumbers, largestDifference, RELATIVE} from "./compare.mjs";
import {chosenJobs, filesBelow, fixtures, programs} from "./jobs.mjs";

const {load} = await import(pathToFileURL(join(built, "chaintrue.mjs")).href);
const chaintrue = await load();

describe("the same answers", {concurrency: 1}, () => {
  const folder = temporaryFolder();
  cpSync(join(root, "fixtures"), join(folder, "fixtures"), {recursive: true});
  const inMemory = Object.fromEntries(fixtures.map((path) => [`fixtures/${path}`, new Uint8Array(readFileSync(join(root, "fixtures", path)))]));
  for (const [path, bytes] of Object.entries(programs)) {
    mkdirSync(dirname(join(folder, path)), {recursive: true});
    writeFileSync(join(folder, path), bytes);
    inMemory[path] = bytes;
  }
  const differences = [];

  const chosen = chosenJobs(process.env.ANSWERS ?? "few");
  for (const words of chosen) {
    test(`chaintrue ${words.join(" ")}`, async () => {
      const before = new Map(filesBelow(folder).map((path) => [path, statSync(join(folder, path)).mtimeMs]));
      const wanted = runNative(words, folder);
      // There are many programs, and they are read only by name.
      const read = Object.entries(inMemory).filter(([path]) => !path.startsWith("programs/") || words.includes(path));
      const found = await chaintrue.run(words, Object.fromEntries(read));
      const written = filesBelow(folder).filter((path) => before.get(path) !== statSync(join(folder, path)).mtimeMs);
      // Each verb is compared on the same input: both read what the native command wrote before.
      for (const path of written) inMemory[path] = new Uint8Array(readFileSync(join(folder, path)));
      const place = words.join(" ");
      assertSame(found.stderr, wanted.stderr, `${place}: standard error`);
      assert.equal(found.code, wanted.code, place);
      const ofThis = [];
      if (/^\s*(\{|<!doctype html>)/i.test(wanted.stdout)) ofThis.push(largestDifference(found.stdout, wanted.stdout, place));
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
    context.diagnostic(`${chosen.length} command lines`);
    assert.ok(differences.length > 20, "the comparison has seen numbers");
    rmSync(folder, {recursive: true});
    assert.ok(!existsSync(folder));
  });
});
