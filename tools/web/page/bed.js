// SPDX-License-Identifier: GPL-3.0-or-later
// The bed next to the table: the positions of the rows, with the current one marked.
import {svg} from "./dom.js";

const MARGIN_MM = 60;
const RADIUS_MM = 52;

/** @param bed {width_mm, height_mm}; @param sheet a Sheet; @param pick(row) is called on a click */
export function bedPicture(bed, sheet, pick) {
  const width = bed.width_mm;
  const height = bed.height_mm;
  const picture = svg("svg", {
    class: "bed", role: "img", "aria-label": "The bed with the places to measure",
    viewBox: `${-width / 2 - MARGIN_MM} ${-height / 2 - MARGIN_MM} ${width + 2 * MARGIN_MM} ${height + 2 * MARGIN_MM}`,
  });
  picture.append(svg("rect", {class: "board", x: -width / 2, y: -height / 2, width, height}));
  picture.append(svg("path", {class: "axes", d: `M ${-width / 2} 0 H ${width / 2} M 0 ${-height / 2} V ${height / 2}`}));
  const named = Object.fromEntries(sheet.places.map((place) => [place.name, place]));
  const spots = apart(sheet.places);
  const isDistances = !sheet.isOfPoints;
  const items = sheet.rows.map((row, index) =>
    isDistances ? distance(named[row.cells[0]], named[row.cells[1]], index) : mark(spots[index], index));
  for (const [index, item] of items.entries()) {
    if (!item) continue;
    item.addEventListener("click", () => pick(index));
    picture.append(item);
  }
  if (isDistances) picture.append(...sheet.places.map((place) => hole(place)));
  return {
    element: picture,
    /** Rows that are filled in, and rows with a problem. */
    show({active, filled, wrong}) {
      for (const [index, item] of items.entries()) {
        if (!item) continue;
        item.setAttribute("class", [item.dataset.kind, index === active && "active", filled(index) && "filled",
          wrong(index) && "wrong"].filter(Boolean).join(" "));
      }
      if (items[active]) picture.append(items[active]);
    },
  };
}

/** Where marks are drawn: one that is measured again stands beside the first. */
function apart(places) {
  const drawn = [];
  for (const place of places) {
    let {x} = place;
    while (drawn.some((other) => Math.hypot(other.x - x, other.y - place.y) < 1.7 * RADIUS_MM)) x += RADIUS_MM * (place.x > 0 ? -1 : 1);
    drawn.push({...place, x});
  }
  return drawn;
}

function mark(place, index) {
  if (!place || !Number.isFinite(place.x)) return null;
  return svg("g", {"data-kind": "mark", transform: `translate(${place.x} ${-place.y})`},
    svg("circle", {r: RADIUS_MM}), svg("text", {y: 19}, String(index + 1)));
}

function distance(from, to, index) {
  if (!from || !to) return null;
  return svg("g", {"data-kind": "distance", "data-row": index},
    svg("line", {x1: from.x, y1: -from.y, x2: to.x, y2: -to.y}));
}

function hole(place) {
  return svg("g", {class: "hole", transform: `translate(${place.x} ${-place.y})`},
    svg("circle", {r: RADIUS_MM}), svg("text", {y: 19}, place.name));
}
