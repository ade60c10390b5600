// SPDX-License-Identifier: GPL-3.0-or-later
// A fit's sentences as a verdict: the two numbers, the warnings that stop until they are read, and the rest.
import {sentenceList} from "./command.js";
import {h, textOf} from "./dom.js";
import {fittedList, jsonOf} from "./folder.js";
import {explained} from "./glossary.js";
import {Sheet} from "./sheet.js";
import {isWish} from "./wish.js";

const HEADLINE = /^(Your machine (misses|needs)|With these (anchors|lines)|The lines bow)\b/;
const SESSION = /^Changes during the session/;
const STOP = /^Changes during the session|^Do not paste these anchors/;
/** Sentences about single readings, and about what the readings leave undecided. */
const WARNING = /^\S+\.(csv|json|txt|yaml): |was left out|^Left out: |cannot show which/;
const LINK_MM = 6.35;
/** Noise alone makes the error at left-out marks about 2.2 times a coordinate's scatter; twice that is no noise. */
const MOST_SCATTERS = 4.5;

/** The sentences of a fit and its tables, which begin with a title or a row of columns. */
export function fitParts(sentences, isWrong) {
  const end = sentences.findIndex((line) => /^Settings$|\S {3,}\S/.test(line));
  const plain = end < 0 ? sentences : sentences.slice(0, end).concat(sentences.slice(end).filter((line) => WARNING.test(line)));
  return {headline: plain.find((line) => HEADLINE.test(line)) ?? null, sentences: plain.filter((line) => !HEADLINE.test(line)), tables: end < 0 ? [] : sentences.slice(end), isWrong};
}

/** A mark that came out elsewhere when it was measured again, as its reader says it; null for another sentence. */
function twice(sentence, list) {
  const lines = /: line (\d+), column \d+: this mark was also measured at line (\d+)/.exec(sentence)?.slice(1).map(Number);
  if (!lines || !list) return null;
  const [again, first] = lines.map((line) => list.rows.findIndex((row) => row.line === line - 1));
  if (again < 0 || first < 0) return null;
  const off = (row, axis) => Number(list.value(row, list.readColumns[axis])) - Number(list.value(row, list.readColumns[axis] - 2));
  const [x, y] = [0, 1].map((axis) => off(again, axis) - off(first, axis));
  const [by, way] = Math.abs(x) > Math.abs(y) ? [x, x > 0 ? "to the right" : "to the left"] : [y, y > 0 ? "higher" : "lower"];
  const links = Math.round(Math.abs(by) / LINK_MM);
  const isLink = links > 0 && Math.abs(Math.abs(by) - links * LINK_MM) < 0.2 * LINK_MM;
  return `Mark ${again + 1} is mark ${first + 1} again, yet ${Number(Math.abs(by).toFixed(1))} mm ${way}${isLink ? `: about ${links === 1 ? "one link" : `${links} links`}. Did a chain jump?` : ". Is a digit or a minus wrong?"}`;
}

/** What the map's own test at marks left out shows, where that is more than the readings scatter. */
function atLeftOut(map) {
  const {rms_mm: rms, maximum_mm: worst} = map?.accuracy?.blocked?.tool ?? {};
  if (rms === undefined || !(rms > MOST_SCATTERS * map.noise?.position_mm)) return null;
  return `Tested on marks left out of the fit, the map is off by ${rms.toFixed(1)} mm rms and ${worst.toFixed(1)} mm at worst. Your readings scatter by less, so something else is wrong. Find it before you cut.`;
}

/** {tone, headline, warnings, others} of the last fit. */
export function verdictOf(page) {
  const {folder, view} = page.store;
  const {headline, sentences, isWrong} = page.fit ?? {headline: null, sentences: []};
  if (isWrong) return {tone: "bad", headline: null, warnings: sentences, others: []};
  const list = folder["machine.json"] && folder[fittedList(view)] ? Sheet.of(textOf(folder[fittedList(view)])) : null;
  const stops = sentences.filter((line) => STOP.test(line));
  const warnings = [
    ...stops.map((line) => (!SESSION.test(line) ? line : "Something moved while you measured. The " +
                                                         "map below allows for it, but the " +
                                                         "machine may have changed: set the " +
                                                         "chains again, and measure again before " +
                                                         "you rely on this.")),
    ...sentences.filter((line) => WARNING.test(line)).map((line) => twice(line, list) ?? line.replace(/^\S+\.(csv|json): (line \d+, column \d+: |\/\S+: )?/, "")), atLeftOut(jsonOf(folder["map.json"])),
  ].filter(Boolean);
  // A mark with a hint at the wrong digit needs no second sentence.
  const hinted = new Set(warnings.map((line) => /^Mark (\d+) is/.exec(line)?.[1]).filter(Boolean));
  const told = warnings.filter((line) => !hinted.has(/^Point \d+ \(row (\d+)\)|^Point (\d+) at/.exec(line)?.slice(1).find(Boolean)));
  const shown = (line) => STOP.test(line) || WARNING.test(line);
  return {tone: stops.length > 0 ? "bad" : told.length > 0 ? "caution" : "good", headline, warnings: told, others: sentences.filter((line) => !shown(line))};
}

const keyOf = ({warnings}) => warnings.join("\n");
/** Whether warnings stand between the result and the next step. */
export const isStopped = (page, verdict = verdictOf(page)) => verdict.warnings.length > 0 && page.store.view.read !== keyOf(verdict);

/** What stands beside the readings: the verdict, and the way to the result. */
export function fitBox(page) {
  return [verdictBand(page), !page.fit.isWrong && h("p", {class: "buttons"},
    h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "result"})}, "See the result"))].filter(Boolean);
}

/** The band with the verdict, its warnings, and the tick that says they were read. */
export function verdictBand(page, verdict = verdictOf(page)) {
  const {tone, headline, warnings, others} = verdict;
  const wish = others.find(isWish);
  const tick = h("input", {type: "checkbox", class: "read", checked: !isStopped(page, verdict), onchange: () => page.store.show({read: tick.checked ? keyOf(verdict) : null})});
  return h("div", {class: `said ${tone}`, role: "status"}, headline && h("p", {class: "headline"}, explained(headline)),
    wish && h("p", {}, wish), warnings.length > 0 && sentenceList(warnings),
    warnings.length > 0 && !page.fit.isWrong && h("p", {}, h("label", {class: "pair"}, tick,
        "I have read this; continue")));
}
