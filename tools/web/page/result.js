// SPDX-License-Identifier: GPL-3.0-or-later
// The third step: the two numbers and their picture, the one choice, the causes, and whether it still holds later.
import {beltsResult} from "./belts_result.js";
import {Choice, JOBS, NUMBERS, waysOf} from "./choice.js";
import {sentenceList} from "./command.js";
import {causesPart} from "./diagnosis.js";
import {folded, h} from "./dom.js";
import {bedOf, isBelts, isPlotter, jsonOf, NEW_POINTS} from "./folder.js";
import {report} from "./frame.js";
import {explained} from "./glossary.js";
import {chooseWay} from "./measure.js";
import {Numbers} from "./numbers.js";
import {errorPicture} from "./picture.js";
import {plotterResult} from "./plotter_result.js";
import {wishSaid} from "./wish.js";

export function resultStep(page) {
  const first = h("div");
  const whole = folded("The whole report", (box) => report(page, "map.json", "map.html", "The map", box));
  const numbers = new Numbers(page);
  const choice = new Choice(page, isBelts, {[NUMBERS]: numbers.element, [JOBS]: jobsPart(page)});
  const causes = causesPart(page);
  const none = h("p", {class: "hint"}, "There is no map yet: type readings in first.");
  const all = h("div", {hidden: true},
    h("section", {}, h("h3", {}, "How true it cuts"), first, whole.element),
    choice.element,
    causes.element,
    h("section", {}, h("h3", {}, "Later: does it still hold?"),
      h("p", {}, "Chains stretch and zeros slip. A few new points, set where they tell most, say whether the map is still valid."),
      h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => planCheck(page)}, "Set new points"))));
  const ofBelts = beltsResult(page);
  const ofPlotter = plotterResult(page);
  let shown = {};

  return {
    element: h("div", {}, none, all, ofBelts.element, ofPlotter.element),
    given: () => (isBelts(page.store.folder) ? ofBelts.given() : isPlotter(page.store.folder) ? ofPlotter.given() : given(page)),
    label: () => (isPlotter(page.store.folder) ? "Numbers and causes" : "Map and causes"),
    update() {
      const {folder, view} = page.store;
      ofBelts.update();
      ofPlotter.update();
      const ready = !isBelts(folder) && !isPlotter(folder) && Boolean(folder["map.json"]);
      none.hidden = ready || isBelts(folder) || isPlotter(folder);
      all.hidden = !ready;
      if (!ready || view.step !== "result") return;
      choice.update(page.store);
      if (view.way === NUMBERS) numbers.update(page.store);
      causes.update(page.store);
      if (shown.map === folder["map.json"] && shown.fit === page.fit) return;
      if (shown.map !== folder["map.json"]) {
        numbers.clear();
        whole.forget();
      }
      shown = {map: folder["map.json"], fit: page.fit};
      first.replaceChildren(...firstLook(page));
    },
  };
}

/** The line of the folded step: the two numbers and the choice. */
function given(page) {
  const {folder, view} = page.store;
  if (!folder["map.json"]) return "";
  return [page.fit?.headline ?? "There is a map.", view.way && `${waysOf(false)[view.way].title}.`].filter(Boolean).join(" ");
}

function firstLook(page) {
  const {folder} = page.store;
  const {headline, sentences} = page.fit ?? {headline: null, sentences: []};
  const wish = wishSaid(sentences);
  const more = sentences.filter((line) => line !== wish);
  const map = jsonOf(folder["map.json"]);
  const bed = bedOf(folder);
  const points = (map?.points ?? []).filter(({as_stated_mm: before, left_out_mm: after}) => before && after);
  return [
    headline && h("p", {class: "headline"}, explained(headline)),
    wish && h("p", {class: "wish"}, wish),
    bed && points.length > 0 && errorPicture(bed, points, ({as_stated_mm: error}) => error, ({left_out_mm: error}) => error, {
      label: "The bed with an arrow at each mark: how far off the tool is there today, and with the map.",
      before: "as it is today", after: "with the map, each mark by a map made without it",
    }),
    more.length > 0 && h("details", {}, h("summary", {}, "More about these readings"), sentenceList(more)),
  ].filter(Boolean);
}

function jobsPart(page) {
  return h("div", {}, h("p", {}, "Open a program in the next step. It comes back compensated and checked on a simulated controller."),
    h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "cut"})}, "Open a program to cut")));
}

async function planCheck(page) {
  await chooseWay(page, NEW_POINTS);
  if (page.store.folder[NEW_POINTS]) page.store.show({step: "measure"});
}
