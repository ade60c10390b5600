// SPDX-License-Identifier: GPL-3.0-or-later
// What the map says of the bed: at each mark an arrow from where the tool should have been to where it was, drawn longer.
import {h, svg} from "./dom.js";

const MARGIN_MM = 110;
/** The longest arrow, as a share of the bed's width: long enough to be seen, short enough to stay at its mark. */
const LONGEST = 0.07;
const FACTORS = [1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 200, 500, 1000];

/** Half the width of an arrow's head, as a share of the bed's width. */
const HEAD = 0.0045;

/** The round factor by which the longest of these errors becomes the longest arrow. */
function factorFor(errors, width) {
  const longest = Math.max(...errors.map(([x, y]) => Math.hypot(x, y)), 1e-3);
  return FACTORS.findLast((factor) => factor * longest <= LONGEST * width) ?? 1;
}

/** An arrow with its head at the tip; one shorter than its head is a dot. */
function arrow(style, {x_mm: x, y_mm: y}, [dx, dy], factor, head) {
  const size = factor * Math.hypot(dx, dy);
  if (size < 2 * head) return svg("circle", {class: style, cx: x, cy: -y, r: head});
  const tail = size - 2 * head;
  return svg("path", {class: style, transform: `translate(${x} ${-y}) rotate(${(Math.atan2(-dy, dx) * 180 / Math.PI).toFixed(1)})`,
    d: `M 0 0 H ${tail.toFixed(1)} V ${-head} L ${size.toFixed(1)} 0 L ${tail.toFixed(1)} ${head} V 0`});
}

/** A bar of a round number of the tool's millimetres, below the bed. */
function scaleBar(bed, factor) {
  const mm = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].findLast((one) => factor * one <= 0.12 * bed.width_mm) ?? 0.1;
  const [x, y] = [-bed.width_mm / 2, bed.height_mm / 2 + 0.5 * MARGIN_MM];
  return svg("g", {class: "scale"}, svg("path", {d: `M ${x} ${y - 15} v 30 v -15 h ${factor * mm} v -15 v 30`}),
    svg("text", {x: x + factor * mm + 20, y: y + 18, "font-size": 0.024 * bed.width_mm}, `${mm} mm`));
}

/**
 * @param bed {width_mm, height_mm}; @param points [{x_mm, y_mm, bad}]; @param before(point), after(point) errors in mm, the second may be null;
 * @param words {label, before, after}: what the picture is, and what its two colours are
 */
export function errorPicture(bed, points, before, after, words) {
  const {width_mm: width, height_mm: height} = bed;
  const good = points.filter(({bad}) => !bad);
  const factor = factorFor(good.map(before), width);
  const head = HEAD * width;
  const picture = svg("svg", {
    class: "errors", role: "img", "aria-label": words.label,
    viewBox: `${-width / 2 - MARGIN_MM} ${-height / 2 - MARGIN_MM} ${width + 2 * MARGIN_MM} ${height + 2 * MARGIN_MM}`,
  }, svg("rect", {class: "board", x: -width / 2, y: -height / 2, width, height}),
  good.map((point) => [arrow("before", point, before(point), factor, head), after && arrow("after", point, after(point), factor, head)]).flat(), after && scaleBar(bed, factor),
  points.filter(({bad}) => bad).map(({x_mm: x, y_mm: y}) => svg("path", {class: "left-out", d: `M ${x - 25} ${-y - 25} l 50 50 m 0 -50 l -50 50`})));
  return h("figure", {class: "picture"}, picture, h("figcaption", {class: "legend"},
    h("span", {class: "key before"}, words.before), h("span", {class: "key after"}, words.after),
    points.length > good.length && h("span", {class: "key left-out"}, "left out")));
}
