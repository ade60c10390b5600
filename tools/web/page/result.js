// SPDX-License-Identifier: GPL-3.0-or-later
// The third step, for every machine: verdict, picture, cause, one recommended way, the check; the rest is folded.
import {beltsPicture, frameOf} from "./belts_picture.js";
import {sentenceList} from "./command.js";
import {causesPart} from "./diagnosis.js";
import {folded, h} from "./dom.js";
import {bedOf, BELTS, DRAWING, hasReadings, jsonOf, mapOf, NEW_POINTS, roadOf} from "./folder.js";
import {report} from "./frame.js";
import {chooseWay} from "./measure.js";
import {errorPicture} from "./picture.js";
import {pagePicture} from "./plotter_picture.js";
import {readsGcode} from "./plotter_text.js";
import {Tape} from "./tape.js";
import {areIn, numbersOf, typeInPart} from "./type_in.js";
import {isStopped, verdictBand, verdictOf} from "./verdict.js";
import {isWish} from "./wish.js";

export const NUMBERS = "numbers";
export const JOBS = "jobs";
const WAYS = {
  [NUMBERS]: {title: "Type numbers in", away: "Compensating is switched off: a program " +
                                              "compensated for the old numbers comes out wrong " +
                                              "with the new ones."},
  [JOBS]: {title: "Compensate each program", away: "Typing numbers in is switched off: with other " +
                                                   "numbers in the machine, programs compensated " +
                                                   "for the present ones come out wrong."},
};

/** Why the other way is put away, and the button that takes it instead. */
export function putAway(page, way) {
  const other = way === NUMBERS ? JOBS : NUMBERS;
  return h("p", {class: "put-away"}, `${WAYS[way].away} `,
    h("button", {type: "button", onclick: () => page.store.show({way: other})}, `${WAYS[other].title} instead`));
}

/** The way to recommend and its reason: numbers where they take off about what a map would. */
function recommended(page, {headline, tone}, {rows, leaves}) {
  const road = roadOf(page.store.folder);
  if (tone === "bad") return {way: null, reason: "Measure again first. The result of this session " +
                                                 "may not be valid for the machine as it is now."};
  if (road !== "chains") return {way: NUMBERS, reason: "A few numbers, once: your programs stay as they are."};
  if (/^Your machine needs no map/.test(headline ?? "")) return {way: null, reason: "Cut your programs as they are."};
  const map = Number(/With this map it misses by about ([\d.]+) mm/.exec(headline ?? "")?.[1] ?? NaN);
  if (rows.length > 0 && leaves <= Math.max(1.5 * map, map + 0.1)) return {way: NUMBERS, reason:
      "A few numbers, once: they correct as much as a map would, and your programs stay as they " +
      "are."};
  return {way: JOBS, reason: rows.length > 0 && leaves > 0 ? `Numbers alone would leave ${leaves.toFixed(1)} mm, so let every program be rewritten before it is cut.` : "Every program is rewritten before it is cut."};
}

export function resultStep(page) {
  const none = h("section", {});
  const band = h("div");
  const way = h("section", {id: "way-part"});
  const check = h("section");
  const tape = new Tape(page);
  const causes = causesPart(page);
  const more = h("div");
  const moreFold = h("details", {}, h("summary", {}, "More about these readings"), more, causes.noise);
  const whole = folded("The whole report", (box) => report(page, "map.json", "map.html", "The map", box));
  const all = h("div", {hidden: true}, band, causes.cause, way, tape.element, check,
    h("section", {class: "folds"}, moreFold, causes.folds, whole.element));
  const remembered = new Map();
  let drawn = [];
  let numbersOfMap = null;

  /** The numbers to type in are exported once for each map. */
  async function askNumbers(source) {
    numbersOfMap = source;
    page.numbers = null;
    const numbers = await numbersOf(page);
    if (numbersOfMap !== source) return;
    page.numbers = numbers;
    page.store.show({});
  }

  function drawNone(folder) {
    const isRead = hasReadings(folder);
    none.replaceChildren(h("p", {class: "hint", role: "status"}, page.fit?.isWrong ? "The readings make no result yet:" : isRead && !page.fit ? "Being computed ..." : "There is no result yet: measure first."),
      page.fit?.isWrong ? sentenceList(page.fit.sentences) : "",
      h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.store.show({step: folder["machine.json"] || folder[BELTS] || folder[DRAWING] ? "measure" : "machine"})}, "Go to the readings")));
  }

  function drawWay({folder, view}, verdict) {
    const {numbers} = page;
    if (!numbers) return [h("h3", {}, "What to do"), h("p", {class: "hint"}, "The numbers are being computed ...")];
    const disabled = isStopped(page, verdict);
    const {way: best, reason} = recommended(page, verdict, numbers);
    const isPossible = {[NUMBERS]: numbers.rows.length > 0 || numbers.isWrong, [JOBS]: roadOf(folder) !== "plotter" || readsGcode(jsonOf(folder[DRAWING]))};
    if (disabled || !view.way) {
      return [h("h3", {}, "What to do"), h("p", {}, reason), disabled && h("p", {class: "hint"},
          "First read the warnings above, and tick the box."),
        h("p", {class: "buttons"}, verdict.tone === "bad" && h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "measure"})}, "Measure again"), [best, ...[NUMBERS, JOBS].filter((one) => one !== best)].filter((one) => isPossible[one]).map((one) =>
          h("button", {type: "button", class: one === best ? "main" : "", disabled, onclick: () => page.store.show({way: one})}, WAYS[one].title)))];
    }
    return [h("h3", {}, WAYS[view.way].title), view.way === NUMBERS ? typeInPart(page, numbers)
      : h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "cut"})}, "Open a program")),
    isPossible[JOBS] && putAway(page, view.way)];
  }

  /** How to see whether it was worth it, on every road. */
  function drawCheck({folder}) {
    const [words, title, go] = {
      chains: ["Measure five new marks. They show whether the machine now cuts as computed, and later whether it still does.", "Set five new marks", () => planCheck(page)],
      belts: ["Cut nine holes and tape them. They show where the tool really is, and the scale of " +
              "everything.", "Measure nine holes", () => page.store.show({step: "measure"})],
      plotter: ["Draw a second page with the new numbers. If its lines are still bent, the cause " +
                "is not a setting.", "Draw the second page", () => page.plotter.secondPage()],
    }[roadOf(folder)];
    return [h("h3", {}, "Then check"), h("p", {}, words), h("p", {class: "buttons"}, h("button", {type: "button", class: areIn(page.store) ? "main" : "", onclick: go}, title))];
  }

  function pictureOf(folder, road) {
    if (road === "belts") {
      const known = frameOf(folder);
      return known?.anchors ? beltsPicture(known, (point) => page.belts.toggle(point), remembered) : null;
    }
    if (road === "plotter") {
      return h("figure", {class: "picture"}, pagePicture(jsonOf(folder[DRAWING]), true).element, h("figcaption", {class: "legend"}, h("span", {class: "key before"}, "as drawn, bows made larger")));
    }
    const bed = bedOf(folder);
    const points = (jsonOf(folder["map.json"])?.points ?? []).filter(({as_stated_mm: before, left_out_mm: after}) => before && after);
    return bed && points.length > 0 ? errorPicture(bed, points, ({as_stated_mm: error}) => error, ({left_out_mm: error}) => error, {
      label: "The bed with an arrow at each mark: how far off the tool is there today, and with the map.",
      before: "today", after: "with the map, each mark left out of it in turn"}) : null;
  }

  return {
    element: h("div", {}, none, all),
    given: () => [page.fit?.headline, page.store.view.way && `${WAYS[page.store.view.way].title}.`].filter(Boolean).join(" "),
    update() {
      const {folder, view} = page.store;
      const road = roadOf(folder);
      const source = folder[mapOf(folder)];
      const isReady = Boolean(source && page.fit && !page.fit.isWrong);
      if (view.step !== "result") return;
      all.hidden = !isReady;
      none.hidden = isReady;
      if (!isReady) {
        drawNone(folder);
        drawn = [];
        return;
      }
      const verdict = verdictOf(page);
      causes.update(page.store);
      tape.element.hidden = road !== "belts";
      if (road === "belts") tape.update(page.store);
      whole.element.hidden = road !== "chains";
      const exported = road === "belts" ? folder["diagnosis.json"] ?? source : source;
      if (numbersOfMap !== exported) askNumbers(exported);
      const now = [source, folder["diagnosis.json"], page.fit, view.read, view.way, areIn(page.store), page.numbers];
      if (now.every((one, index) => one === drawn[index])) return;
      if (source !== drawn[0]) whole.forget();
      if (folder[BELTS] === undefined) remembered.clear();
      drawn = now;
      const focused = document.activeElement?.id;
      const picture = pictureOf(folder, road);
      band.replaceChildren(verdictBand(page, verdict), picture ? h("section", {}, picture) : "");
      way.replaceChildren(...drawWay(page.store, verdict).filter(Boolean));
      check.replaceChildren(...drawCheck(page.store));
      more.replaceChildren(sentenceList(verdict.others.filter((line) => !isWish(line))), page.fit.tables.length > 0 ? h("pre", {tabindex: "0"}, page.fit.tables.join("\n")) : "");
      if (focused) document.getElementById(focused)?.focus({preventScroll: true});
    },
  };
}

async function planCheck(page) {
  await chooseWay(page, NEW_POINTS);
  if (page.store.folder[NEW_POINTS]) page.store.show({step: "measure"});
}
