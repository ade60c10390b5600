// SPDX-License-Identifier: GPL-3.0-or-later
// Command lines on the fixtures: every verb, every kind of file.
import {readdirSync, readFileSync} from "node:fs";
import {join, relative} from "node:path";
import {root} from "../test/browser.mjs";

export function filesBelow(folder, under = folder) {
  return readdirSync(folder, {withFileTypes: true}).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? filesBelow(path, under) : [relative(under, path)];
  });
}

export const fixtures = filesBelow(join(root, "fixtures")).sort();
const of = (folder, pattern) => fixtures.filter((path) => path.startsWith(folder) && pattern.test(path)).map((path) => `fixtures/${path}`);

/** The programs of the corpus, which are stored as records, by the path of a file for each: `programs/THEME/NAME.ngc`. */
function programsOf(path) {
  const [theme] = path.split("/").at(-1).split(".");
  const bytes = readFileSync(join(root, path));
  const found = [];
  for (let at = 0; at < bytes.length;) {
    const begin = bytes.indexOf("\n", at) + 1;
    const [, name, count] = bytes.toString("latin1", at, begin).trim().split(" ");
    at = begin + Number(count) + 1;
    found.push([`programs/${theme}/${found.length}_${name.replace(/\W/g, "_")}.ngc`, new Uint8Array(bytes.subarray(begin, at - 1))]);
  }
  return found;
}
export const programs = Object.fromEntries(of("gcode/corpus/", /(?<!generated|follower)\.records$/).flatMap(programsOf));

const CLASSIC = ["--machine", "fixtures/machines/classic.json"];
/** Every verb, in order; a later one may read what an earlier one has written. */
const verbs = [
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
  ["sweep", "fixtures/sweeps/quick.json", "-o", "sweep"],
  ["fit", "fixtures/belts/thirty_one_places.json", "-o", "anchors.json"],
  ["export", "maslow4", "anchors.json"],
  ["import", "optical", "fixtures/good/optical_scan.csv", ...CLASSIC, "-o", "optical.json"],
  ["plan", ...CLASSIC, "--points", "28", "-o", "plan.csv", "--page", "plan.html", "--gcode", "plan.nc"],
  ["plan", ...CLASSIC, "--holes", "9", "-o", "holes.csv"],
  ["gcode", "compensate", "fixtures/gcode/bracket.nc", "--map", "map.json", "-o", "bracket.true.nc", "--report", "bracket.html"],
  ["gcode", "verify", "fixtures/gcode/bracket.nc", "bracket.true.nc", "--map", "map.json"],
  ["gcode", "explain", "fixtures/gcode/bracket.nc:14", "--map", "map.json"],
];

/** For each file of a kind; no job reads the output of another. */
const onFiles = [
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
  ...Object.keys(programs).flatMap((path) => [["gcode", "check", path, "--map", "map.json"],
    ["gcode", "lengths", path, "--map", "map.json"], ["gcode", "compensate", path, "--map", "map.json", "-o", "-"]]),
];

export const jobs = [...verbs, ...onFiles];

/** The kind of a command line: its words with the kinds of files in place of their names. */
function kindOf(words) {
  return words.map((word) => {
    const file = /^(programs\/\w+|fixtures\/.*\/[a-z0-9]+)(?:[_/].*)?\.(\w+)$/.exec(word);
    return file ? `${file[1]}.${file[2]}` : word;
  }).join(" ");
}

/** One file in this number of each kind is used. */
const EVERY = 12;

/** "all"; "few": every verb, and one file in twelve of each kind; "FROM-TO": these job numbers, and every verb. */
export function chosenJobs(which) {
  if (which === "all") return jobs;
  const range = /^(\d+)-(\d+)$/.exec(which);
  if (range) return jobs.filter((_, number) => number < verbs.length || (number >= Number(range[1]) && number < Number(range[2])));
  if (which !== "few") throw new Error(`ANSWERS: found ${which}, expected all, few, or two numbers as in 200-400`);
  const seen = new Map();
  return jobs.filter((words, number) => {
    if (number < verbs.length) return true;
    const kind = kindOf(words);
    seen.set(kind, (seen.get(kind) ?? 0) + 1);
    return seen.get(kind) % EVERY === 1;
  });
}
