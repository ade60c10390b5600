// SPDX-License-Identifier: GPL-3.0-or-later
// The package under node: the results of a run.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import {test} from "node:test";
import {pathToFileURL} from "node:url";
import {built, fixture} from "./browser.mjs";

const {load} = await import(pathToFileURL(join(built, "chaintrue.mjs")).href);
const chaintrue = await load();
const bytesOf = (path) => new Uint8Array(readFileSync(fixture(path)));
const given = {"grid.json": bytesOf("grids/seven_by_four.json"), "bracket.nc": bytesOf("gcode/bracket.nc")};

test("a run gives the files that it wrote, those that it left as they were before among them, and none that it only read", async () => {
  const fit = ["fit", "grid.json", "-o", "map.json", "--force"];
  const first = await chaintrue.run(fit, given);
  assert.equal(first.code, 0, first.stderr);
  assert.deepEqual(Object.keys(first.files), ["map.json"]);
  const again = await chaintrue.run(fit, {...given, ...first.files});
  assert.deepEqual(again.files, first.files);
  const query = await chaintrue.run(["query", "map.json", "100", "200"], {...given, ...first.files});
  assert.deepEqual([query.code, query.files], [0, {}]);
});

test("folders are given and come back", async () => {
  const {code, files, stderr} = await chaintrue.run(["start", "set/machine.json"], {"set/machine.json": bytesOf("machines/groundcontrol.json")});
  assert.equal(code, 0, stderr);
  assert.ok(Object.keys(files).includes("set/marks.csv"), Object.keys(files).join(" "));
});

test("standard input is read, and exit codes come back", async () => {
  const piped = await chaintrue.run(["fit", "-", "-o", "-"], {}, {stdin: given["grid.json"]});
  assert.equal(piped.code, 0, piped.stderr);
  assert.ok(JSON.parse(piped.stdout));
  const wrong = await chaintrue.run(["fit", "-", "-o", "-"], {}, {stdin: new TextEncoder().encode("{}")});
  assert.equal(wrong.code, 3, wrong.stderr);
  assert.deepEqual(wrong.files, {});
});
