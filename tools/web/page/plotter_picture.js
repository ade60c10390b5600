// SPDX-License-Identifier: GPL-3.0-or-later
// The test page of a plotter: crosses, lines, and the measure that is typed in.
import {svg} from "./dom.js";

const WIDTH = 420;
const MARGIN = 34;
/** The lines of the page: its outline, its middle lines, its diagonals. */
const LINES = ["AB", "BC", "CD", "DA", "EG", "HF", "AC", "BD"];

/**
 * @returns {element, show(measure)}: the measure is drawn thick, the string of a bow with the place across it
 */
export function pagePicture(drawing) {
  const at = Object.fromEntries(drawing.crosses.map(({name, x_mm: x, y_mm: y}) => [name, {x, y}]));
  const xs = Object.values(at).map(({x}) => x);
  const ys = Object.values(at).map(({y}) => y);
  const scale = (WIDTH - 2 * MARGIN) / (Math.max(...xs) - Math.min(...xs));
  const height = (Math.max(...ys) - Math.min(...ys)) * scale + 2 * MARGIN;
  const px = ({x}) => MARGIN + (x - Math.min(...xs)) * scale;
  const py = ({y}) => MARGIN + (Math.max(...ys) - y) * scale;
  const line = (from, to, properties) => svg("line", {x1: px(from), y1: py(from), x2: px(to), y2: py(to), ...properties});
  const chosen = svg("g");
  const element = svg("svg", {viewBox: `0 0 ${WIDTH} ${height.toFixed(0)}`, class: "plotter-page", role: "img", "aria-label": "The test page with its nine crosses A to H and M."},
    LINES.filter(([from, to]) => at[from] && at[to]).map(([from, to]) => line(at[from], at[to], {class: "thin"})), chosen,
    Object.entries(at).flatMap(([name, point]) => [
      svg("path", {d: `M${px(point) - 6},${py(point)}h12M${px(point)},${py(point) - 6}v12`, class: "cross"}),
      svg("text", {x: px(point) + 8, y: py(point) - 8}, name)]));
  return {
    element,
    show(measure) {
      const {kind, from, to, middle} = measure ?? {};
      chosen.replaceChildren(...(measure && at[from] && at[to] ? [line(at[from], at[to], {class: kind === "bow" ? "string" : "ruler"})] : []),
        ...(kind === "bow" && at[middle] ? [svg("circle", {cx: px(at[middle]), cy: py(at[middle]), r: 13, class: "across"})] : []));
    },
  };
}
