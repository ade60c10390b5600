// SPDX-License-Identifier: GPL-3.0-or-later
// What the map says of the bed: at each mark an arrow from where the tool should have been to where it was, drawn longer.
import {h, svg} from "./dom.js";

const MARGIN_MM = 110;
/** The longest arrow, as a share of the bed's width: long enough to be seen, short enough to stay at its mark. */
const LONGEST = 0.055;
const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

const length = ([x, y]) => Math.hypot(x, y);

/** The round factor by which the longest of these errors becomes the longest arrow. */
function factorFor(errors, width) {
  const longest = Math.max(...errors.map(length), 1e-3);
  return FACTORS.findLast((factor) => factor * longest <= LONGEST * width) ?? 1;
}

function arrow(style, {x_mm: x, y_mm: y}, [dx, dy], factor) {
  const to = [x + factor * dx, -(y + factor * dy)];
  return svg("g", {class: style}, svg("line", {x1: x, y1: -y, x2: to[0], y2: to[1]}), svg("circle", {cx: to[0], cy: to[1], r: 13}));
}

/**
 * @param bed {width_mm, height_mm}; @param points [{x_mm, y_mm, bad}]; @param before(point), after(point) errors in mm;
 * @param words {label, before, after}: what the picture is, and what its two colours are
 */
export function errorPicture(bed, points, before, after, words) {
  const {width_mm: width, height_mm: height} = bed;
  const good = points.filter(({bad}) => !bad);
  const factor = factorFor(good.map(before), width);
  const picture = svg("svg", {
    class: "errors", role: "img", "aria-label": words.label,
    viewBox: `${-width / 2 - MARGIN_MM} ${-height / 2 - MARGIN_MM} ${width + 2 * MARGIN_MM} ${height + 2 * MARGIN_MM}`,
  }, svg("rect", {class: "board", x: -width / 2, y: -height / 2, width, height}),
  good.map((point) => [arrow("before", point, before(point), factor), arrow("after", point, after(point), factor)]).flat(),
  points.filter(({bad}) => bad).map(({x_mm: x, y_mm: y}) => svg("path", {class: "left-out", d: `M ${x - 25} ${-y - 25} l 50 50 m 0 -50 l -50 50`})));
  return h("figure", {class: "picture"}, picture, h("figcaption", {class: "legend"},
    h("span", {class: "key before"}, words.before), h("span", {class: "key after"}, words.after),
    points.length > good.length && h("span", {class: "key left-out"}, "left out"),
    h("span", {}, `arrows ${factor} times as long as the errors`)));
}
