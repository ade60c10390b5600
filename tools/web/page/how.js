// SPDX-License-Identifier: GPL-3.0-or-later
// How to measure, drawn: the sheet's middle lines, the square at a mark, the tape and its hook.
import {h, svg} from "./dom.js";
import {HOOK_HELP} from "./in_page.js";

const text = (x, y, words, anchor = "middle") => svg("text", {x, y, "text-anchor": anchor}, words);
const line = (x1, y1, x2, y2, style = "ink") => svg("line", {class: style, x1, y1, x2, y2});

function figure(title, label, words, ...shapes) {
  return h("figure", {class: "how"},
    svg("svg", {viewBox: "0 0 300 170", role: "img", "aria-label": label}, ...shapes),
    h("figcaption", {}, h("b", {}, title), " ", words));
}

function middleLines() {
  return figure("Middle lines.", "A sheet with its two diagonals; through their crossing a line along the sheet and one across it.",
    "Two lines from corner to corner cross in the sheet's middle. Draw one line along the sheet " +
    "and one across it through there: all positions are measured from this crossing.",
    svg("rect", {class: "board", x: 40, y: 20, width: 220, height: 112}),
    line(40, 20, 260, 132, "faint"), line(40, 132, 260, 20, "faint"),
    line(40, 76, 260, 76, "strong"), line(150, 20, 150, 132, "strong"),
    svg("circle", {class: "dot", cx: 150, cy: 76, r: 4}),
    svg("g", {class: "on-board"}, text(162, 94, "0, 0", "start"), text(254, 70, "+x", "end"), text(156, 34, "+y", "start")),
    text(150, 154, "the middle: where the diagonals cross"));
}

function square() {
  return figure("Square.", "A carpenter's square with one leg along a middle line; the other leg reaches the mark, so both distances are read at it.",
    "One leg along a middle line, the other through the mark's centre. Read x along the middle line and y along the leg; left of the middle and below it is minus.",
    line(20, 128, 280, 128, "strong"), line(40, 14, 40, 150, "strong"),
    svg("path", {class: "tool", d: "M 196 128 V 30 H 212 V 112 H 280 V 128 Z"}),
    svg("circle", {class: "mark", cx: 196, cy: 48, r: 6}), text(186, 44, "the mark", "end"),
    line(40, 142, 196, 142, "measure"), text(118, 157, "x"),
    line(182, 48, 182, 128, "measure"), text(173, 92, "y", "end"),
    svg("circle", {class: "dot", cx: 40, cy: 128, r: 4}));
}

function tape() {
  const ticks = Array.from({length: 9}, (_, index) => line(62 + 12 * index, 74, 62 + 12 * index, index === 4 ? 90 : 82, "ink"));
  return figure("Tape.", "A tape between two holes: its 100 mm mark, not its hook, lies at the centre of the first hole.",
    HOOK_HELP,
    svg("rect", {class: "tape", x: 50, y: 74, width: 244, height: 26}), svg("path", {class: "hook", d: "M 52 70 V 108 H 44 V 70 Z"}),
    ...ticks, svg("circle", {class: "mark", cx: 110, cy: 62, r: 8}), svg("circle", {class: "mark", cx: 262, cy: 62, r: 8}),
    line(110, 50, 110, 100, "faint"), line(262, 50, 262, 100, "faint"),
    text(110, 116, "100"), text(48, 126, "hook"), text(110, 40, "first hole"), text(262, 40, "second"),
    line(110, 138, 262, 138, "measure"), text(186, 156, "the distance"));
}

const OF = {"marks.csv": [middleLines, square], "holes.csv": [tape], "lengths.csv": [middleLines], "five.csv": [middleLines, square]};

/** The pictures for a list of readings. */
export function howToMeasure(path) {
  return h("div", {class: "hows"}, (OF[path] ?? []).map((draw) => draw()));
}
