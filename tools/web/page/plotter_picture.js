// SPDX-License-Identifier: GPL-3.0-or-later
// The test page of a plotter: crosses, lines, and the measure that is typed in.
import {svg} from "./dom.js";

const WIDTH = 420;
const MARGIN = 34;
/** The lines of the page: its outline, its middle lines, its diagonals. */
const LINES = ["AB", "BC", "CD", "DA", "EG", "HF", "AC", "BD"];

/** The largest bow, as a share of the page's width. */
const LARGEST_BOW = 0.06;

/** The lines as they were drawn, their bows larger by one factor. A bow counts to the left of who walks along the line. */
function bowedLines(measures, at, px, py) {
  const bows = measures.filter(({kind, value_mm: value}) => kind === "bow" && Number.isFinite(value));
  const factor = LARGEST_BOW * WIDTH / Math.max(...bows.map(({value_mm: value}) => Math.abs(value)), 1e-3);
  return bows.map(({from, to, value_mm: value}) => {
    const [x1, y1, x2, y2] = [px(at[from]), py(at[from]), px(at[to]), py(at[to])];
    const share = 2 * factor * value / Math.hypot(x2 - x1, y2 - y1);
    return svg("path", {class: "before", d: `M ${x1} ${y1} Q ${(x1 + x2) / 2 + share * (y2 - y1)} ${(y1 + y2) / 2 - share * (x2 - x1)} ${x2} ${y2}`});
  });
}

/**
 * @param isBowed whether the lines are drawn with the bows that were measured, larger
 * @returns {element, show(measure)}: the measure is drawn thick, the string of a bow with the place across it
 */
export function pagePicture(drawing, isBowed = false) {
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
    LINES.filter(([from, to]) => at[from] && at[to]).map(([from, to]) => line(at[from], at[to], {class: "thin"})), isBowed ? bowedLines(drawing.measures, at, px, py) : [], chosen,
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
