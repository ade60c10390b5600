// SPDX-License-Identifier: GPL-3.0-or-later
// What the drawing says: by how much lines bow, which settings are off, the lines to type in, and causes that are no setting.
import {DONE, printed, runVerb, sentenceList, sentencesOf} from "./command.js";
import {rankedCauses, remedies} from "./diagnosis.js";
import {folded, h} from "./dom.js";
import {DRAWING, FOUND, isPlotter, jsonOf} from "./folder.js";
import {report} from "./frame.js";
import {explained} from "./glossary.js";
import {inPage} from "./in_page.js";
import {readsGcode} from "./plotter_text.js";

const DIAGNOSIS = "diagnosis.json";
const SETTINGS = [
  ["pin_spacing_mm", "distance between the pins, mm", (machine) => machine.pin_spacing_mm],
  ["pin_rise_mm", "height of the right pin over the left, mm", (machine) => machine.pin_rise_mm ?? 0],
  ["zero_left_mm", "zero of the left cord, mm", (machine) => machine.zero?.left_mm ?? 0],
  ["zero_right_mm", "zero of the right cord, mm", (machine) => machine.zero?.right_mm ?? 0],
  ["scale_left_mm_per_m", "left cord, counted too long, mm per metre", (machine) => machine.scale?.left_mm_per_m ?? 0],
  ["scale_right_mm_per_m", "right cord, counted too long, mm per metre", (machine) => machine.scale?.right_mm_per_m ?? 0],
];
/** Off by more than chance, as the command says it. */
const OFF_SIGMAS = 3;

export function plotterResult(page) {
  const first = h("div");
  const lines = h("section");
  const causes = h("div");
  const whole = folded("The whole diagnosis", (box) => report(page, DIAGNOSIS, "diagnosis.html", "The diagnosis", box));
  const why = h("section", {}, h("h3", {}, "What no setting explains"), causes, whole.element);
  const none = h("p", {class: "hint"}, "Nothing is found yet: measure the test page first.");
  const element = h("div", {hidden: true}, none, h("section", {id: "plotter-first"}, h("h3", {}, "How true it draws"), first), lines, why);
  let drawn = [];
  return {
    element,
    given: () => page.plotter.said?.sentences[0] ?? "",
    update() {
      const {folder, view} = page.store;
      element.hidden = !isPlotter(folder);
      if (element.hidden || view.step !== "result") return;
      const now = [folder[DRAWING], folder[FOUND], folder[DIAGNOSIS], page.plotter.said];
      none.hidden = Boolean(page.plotter.said);
      first.parentElement.hidden = !page.plotter.said;
      lines.hidden = !folder[FOUND];
      why.hidden = !folder[DIAGNOSIS];
      if (now.every((one, index) => one === drawn[index])) return;
      if (folder[DIAGNOSIS] !== drawn[2]) whole.forget();
      const isNew = folder[FOUND] !== drawn[1];
      drawn = now;
      first.replaceChildren(...firstLook(page));
      if (folder[FOUND] && isNew) drawLines(page, lines);
      const diagnosis = jsonOf(folder[DIAGNOSIS]);
      causes.replaceChildren(...(diagnosis ? [h("p", {class: "verdict"}, explained(inPage(diagnosis.sentence), 2)), ...rankedCauses(diagnosis.hypotheses), ...remedies(diagnosis)] : []));
    },
  };
}

function firstLook(page) {
  const {sentences, isWrong} = page.plotter.said ?? {sentences: [], isWrong: false};
  if (isWrong) return [h("div", {class: "said problem", role: "alert"}, sentenceList(sentences))];
  const [headline, ...more] = sentences;
  const {folder} = page.store;
  const found = jsonOf(folder[FOUND])?.found;
  return [headline && h("p", {class: "headline", role: "status"}, explained(headline)), ...more.map((line) => h("p", {}, explained(line))),
    found && settingsTable(jsonOf(folder[DRAWING]).set.machine, found)].filter(Boolean);
}

function settingsTable(machine, found) {
  const rows = SETTINGS.map(([key, words, asSet]) => ({words, now: asSet(machine), value: found[key].value, sigma: found[key].sigma}));
  return h("div", {class: "table-box"}, h("table", {class: "changes"}, h("caption", {}, "Settings"),
    h("thead", {}, h("tr", {}, ["setting", "as set", "found", "\u00b1", ""].map((title, index) => h("th", {scope: "col", class: index > 0 && index < 4 && "number"}, title)))),
    h("tbody", {}, rows.map(({words, now, value, sigma}) => h("tr", {}, h("th", {scope: "row"}, words),
      ...[now, value, sigma].map((number) => h("td", {class: "number"}, number.toFixed(2).replace("-", "\u2212"))),
      h("td", {}, Math.abs(value - now) > OFF_SIGMAS * sigma ? "off" : ""))))));
}

/** The lines of the controller that hold what was found. */
async function drawLines(page, section) {
  const found = page.store.folder[FOUND];
  const result = await runVerb(page, ["export", "plotter", FOUND], {quiet: true});
  if (!result || page.store.folder[FOUND] !== found) return;
  if (result.code !== DONE) {
    section.replaceChildren(sentenceList(sentencesOf(result).map(inPage)));
    return;
  }
  const copied = h("span", {class: "hint", role: "status"});
  const copy = h("button", {type: "button", onclick: async () => {
    copied.textContent = await navigator.clipboard?.writeText(result.stdout).then(() => "Copied.", () => "Select them and copy.") ?? "Select them and copy.";
  }}, "Copy the lines");
  const isGcode = readsGcode(jsonOf(page.store.folder[DRAWING]));
  section.replaceChildren(h("h3", {}, "Type these in"), printed(result.stdout, "Lines to type in"), h("p", {class: "buttons"}, copy, copied),
    h("p", {}, "Then draw a second page: its lines are straight, or what still bends them is no setting."),
    h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.plotter.secondPage()}, "They are in: the second page")),
    ...(isGcode ? [h("p", {class: "hint"}, "Or leave the plotter's numbers as they are, and have each program rewritten in the next step. Not both: a program that is rewritten for the old numbers is drawn wrong with the new ones.")] : []));
}
