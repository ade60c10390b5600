// SPDX-License-Identifier: GPL-3.0-or-later
// The frame with its belts: where the anchors are and how well that is known, the places, and which readings are wrong.
import {h, svg} from "./dom.js";
import {ANCHORS, BELTS, jsonOf} from "./folder.js";
import {leftOut} from "./belts.js";

export const CORNERS = ["tl", "tr", "bl", "br"];
export const CORNER_NAMES = {tl: "top left", tr: "top right", bl: "bottom left", br: "bottom right"};

const MARGIN = 0.07;
/** The largest ellipse, as a share of the frame's width. */
const LARGEST = 0.035;
const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200];

/**
 * What is known of the frame, for picture and table: {anchors, sigmas, places: [{point, isOut, reading, x, y, off, bad}]}, the
 * last four once there are anchors, which are null before; null without belts. The diagnosis counts what the causes do; the
 * fit stands in until it is made.
 */
export function frameOf(folder) {
  const fit = jsonOf(folder[ANCHORS])?.fit;
  const belts = jsonOf(folder[BELTS]);
  if (!belts) return null;
  const out = leftOut(folder);
  if (!fit) return {anchors: null, sigmas: {}, places: belts.points.map((reading, index) => ({point: index + 1, isOut: out.includes(index + 1), reading}))};
  const found = jsonOf(folder["diagnosis.json"])?.belts;
  const {machine, coordinates} = found ?? fit;
  const sigmas = Object.fromEntries(coordinates.map(({coordinate, sigma_mm: sigma}) => [coordinate, sigma]));
  let seen = -1;
  const places = belts.points.map((reading, index) => {
    if (out.includes(index + 1)) return {point: index + 1, isOut: true, reading};
    seen += 1;
    const fitted = fit.places[seen];
    const place = found?.places[seen] ?? fitted;
    if (!place) return {point: index + 1, isOut: false, reading};
    const each = (of) => Object.fromEntries(CORNERS.map((corner) => [corner, of(corner)]));
    return {
      point: index + 1, isOut: false, reading, x: place.x_mm, y: place.y_mm,
      off: each((corner) => (found ? place.after_mm[corner] : fitted[corner].off_mm)),
      bad: each((corner) => (found ? place.bad[corner] : !fitted[corner].counts)),
    };
  });
  return {anchors: machine.anchors, sigmas, places};
}

export const isBad = ({bad}) => Boolean(bad) && CORNERS.some((corner) => bad[corner]);

/** A picture of the frame; `pick(point)` is called on a click on a place. Places that are left out stay where they last were. */
export function beltsPicture({anchors, sigmas, places}, pick, remembered) {
  const xs = CORNERS.map((corner) => anchors[corner].x_mm);
  const ys = CORNERS.map((corner) => anchors[corner].y_mm);
  const [left, right, bottom, top] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const width = right - left;
  const margin = MARGIN * width;
  const unit = width / 100;
  const largest = Math.max(...Object.values(sigmas), 1e-6);
  const factor = FACTORS.findLast((one) => one * largest <= LARGEST * width) ?? 1;
  const known = places.map((place) => (place.x === undefined ? {...place, ...(remembered.get(place.point) ?? commandedAt(place, places))} : place))
    .filter(({x}) => x !== undefined);
  for (const {point, x, y} of known) remembered.set(point, {x, y});
  const tool = middleOf(known) ?? {x: (left + right) / 2, y: (top + bottom) / 2};
  const picture = svg("svg", {class: "frame", role: "img", "aria-label": `The frame with ${known.length} places. A click on a place leaves it out or takes it back.`,
    viewBox: `${left - margin} ${-top - margin} ${width + 2 * margin} ${top - bottom + 2 * margin}`},
  svg("path", {class: "posts", d: `M ${anchors.tl.x_mm} ${-anchors.tl.y_mm} L ${anchors.tr.x_mm} ${-anchors.tr.y_mm} L ${anchors.br.x_mm} ${-anchors.br.y_mm} L ${anchors.bl.x_mm} ${-anchors.bl.y_mm} Z`}),
  CORNERS.map((corner) => svg("line", {class: "belt", x1: anchors[corner].x_mm, y1: -anchors[corner].y_mm, x2: tool.x, y2: -tool.y})),
  CORNERS.map((corner) => anchor(corner, anchors[corner], sigmas, factor, unit)).flat(),
  [...known].sort((one, other) => rank(one) - rank(other)).map((place) => spot(place, pick, unit)));
  const out = known.some(({isOut}) => isOut);
  return h("figure", {class: "picture"}, picture, h("figcaption", {class: "legend"},
    h("span", {class: "key spot"}, "a place"), known.some(isBad) && h("span", {class: "key wrong"}, "a wrong reading"),
    out && h("span", {class: "key left-out"}, "left out by you"),
    h("span", {class: "key ellipse"}, `how well an anchor is known, ${factor} times as large`),
    h("span", {}, "click a place to leave it out")));
}

/** About where a place that was left out before the page was opened lies: as commanded, which counts from elsewhere. */
function commandedAt({reading}, places) {
  const other = places.find(({x, reading: {commanded_x_mm: commanded}}) => x !== undefined && commanded !== undefined);
  if (!other || reading.commanded_x_mm === undefined) return {};
  return {x: other.x + reading.commanded_x_mm - other.reading.commanded_x_mm, y: other.y + reading.commanded_y_mm - other.reading.commanded_y_mm};
}

/** The place in the middle, to which the belts are drawn. */
function middleOf(places) {
  if (places.length === 0) return null;
  const mean = (of) => places.reduce((sum, place) => sum + of(place), 0) / places.length;
  const x = mean((place) => place.x);
  const y = mean((place) => place.y);
  return places.reduce((best, place) => (Math.hypot(place.x - x, place.y - y) < Math.hypot(best.x - x, best.y - y) ? place : best));
}

/** The ellipse of one sigma, as the coordinates have theirs; the origin and the bottom right anchor's height are fixed. */
function anchor(corner, {x_mm: x, y_mm: y}, sigmas, factor, unit) {
  const rx = Math.max(factor * (sigmas[`${corner}_x_mm`] ?? 0), 0.35 * unit);
  const ry = Math.max(factor * (sigmas[`${corner}_y_mm`] ?? 0), 0.35 * unit);
  const above = corner.startsWith("t");
  return [svg("ellipse", {class: "ellipse", cx: x, cy: -y, rx, ry}), svg("circle", {class: "post", cx: x, cy: -y, r: 0.35 * unit}),
    svg("text", {x, y: -y + (above ? -3 : 5.6) * unit, "font-size": 2.8 * unit, "text-anchor": corner.endsWith("l") ? "start" : "end"}, CORNER_NAMES[corner])];
}

/** What is wrong or left out is drawn over what is right. */
const rank = (place) => (isBad(place) || place.isOut ? 1 : 0);

function spot(place, pick, unit) {
  const group = svg("g", {class: ["spot", place.isOut && "out", isBad(place) && "wrong"].filter(Boolean).join(" "), "data-point": place.point,
    transform: `translate(${place.x} ${-place.y})`, onclick: () => pick(place.point)},
  svg("circle", {r: 2.1 * unit}), svg("text", {y: 0.75 * unit, "font-size": 2.1 * unit}, String(place.point)));
  group.append(svg("title", {}, `Place ${place.point}${place.isOut ? ", left out" : isBad(place) ? ", a reading is wrong" : ""}`));
  return group;
}
