// SPDX-License-Identifier: GPL-3.0-or-later
// The third step: the map's report, the causes, better numbers, the next measurements.
import {DONE, printed, runVerb, sentenceList, sentencesAbout, sentencesOf} from "./command.js";
import {bytesOf, download, h, textOf} from "./dom.js";
import {reportFrame} from "./frame.js";
import {chooseWay, fittedList, NEW_POINTS} from "./measure.js";
import {Numbers} from "./numbers.js";
import {Sheet} from "./sheet.js";

export function resultStep(page) {
  const map = h("div");
  const noise = new NoiseFields(page);
  const causes = h("div");
  const next = h("div");
  const numbers = new Numbers(page);
  const built = h("input", {type: "checkbox", id: "causes", onchange: () => buildOn(page, built.checked)});
  const none = h("p", {class: "hint"}, "There is no map yet: type readings in first.");
  const all = h("div", {hidden: true},
    h("section", {}, h("h2", {}, "How true it cuts"), map),
    h("section", {}, h("h2", {}, "Why does it err?"),
      h("p", {}, "Which of the known causes explains the readings, how sure that is, and what to do."),
      noise.element,
      h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => diagnose(page, noise.words())}, "Find the cause")),
      causes, next,
      h("p", {class: "choices"}, built, h("label", {for: "causes"}, "Build the map on the causes that are sure and make it better"))),
    h("section", {}, h("h2", {}, "Better numbers"),
      h("p", {}, "Typed into the controller once, they take off what settings can. Or compensate each program, which is truer."),
      numbers.element),
    h("section", {}, h("h2", {}, "Later: does it still hold?"),
      h("p", {}, "Chains stretch and zeros slip. A few new points, set where they tell most, say whether the map is still valid."),
      h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => planCheck(page)}, "Set new points"))));
  const seen = {};

  /** Redraws `box` if `path` of the folder has changed. */
  function follow(path, box, draw) {
    const bytes = page.store.folder[path];
    if (seen[path] === bytes) return;
    seen[path] = bytes;
    box.replaceChildren();
    if (bytes) draw(bytes);
  }

  return {
    element: h("div", {}, none, all),
    update() {
      const {folder, view} = page.store;
      none.hidden = Boolean(folder["map.json"]);
      all.hidden = !folder["map.json"];
      if (view.step !== "result") return;
      noise.update(page.store);
      built.checked = Boolean(view.causes);
      numbers.update(page.store);
      follow("map.json", map, () => {
        numbers.clear();
        report(page, "map.json", "map.html", "The map", map);
      });
      follow("diagnosis.html", causes, (bytes) => causes.append(reportFrame("The diagnosis", "diagnosis.html", bytes,
        {onDownload: () => download("diagnosis.html", bytes)})));
      follow("diagnosis.json", next, () => next.append(h("p", {class: "buttons"},
        h("button", {type: "button", onclick: () => planNext(page, next)}, "What to measure next"))));
    },
  };
}

const NOISE = [["--noise-length-mm", "A chain length is good to, mm"], ["--noise-position-mm", "A place that you read is good to, mm"]];

/** The noise stated by the user, one sigma. */
class NoiseFields {
  #page;
  #inputs = NOISE.map(([option]) => h("input", {
    id: option.slice(2), type: "text", inputmode: "decimal", size: 5,
    onchange: () => this.#page.store.show({noise: this.#inputs.map(({value}) => value)}),
  }));
  element = h("p", {class: "choices"}, NOISE.map(([option, label], index) =>
    h("span", {class: "pair"}, h("label", {for: option.slice(2)}, label), this.#inputs[index])));

  constructor(page) {
    this.#page = page;
  }

  update({folder, view}) {
    this.element.hidden = fittedList(view) === "holes.csv";
    for (const [index, input] of this.#inputs.entries()) {
      if (document.activeElement !== input) input.value = view.noise?.[index] ?? usual(folder, NOISE[index][0]);
    }
  }

  words() {
    if (this.element.hidden) return [];
    return this.#inputs.flatMap(({value}, index) => (value.trim() === "" ? [] : [NOISE[index][0], value.trim().replace(",", ".")]));
  }
}

/** The noise that the command's README.txt recommends. */
function usual(folder, option) {
  const readme = folder["README.txt"] ? textOf(folder["README.txt"]) : "";
  return new RegExp(`chaintrue diagnose .*${option} (\\S+)`).exec(readme)?.[1] ?? "";
}

/** The measure step fits the readings again. */
function buildOn(page, causes) {
  const {view} = page.store;
  page.store.show({causes, sheet: fittedList(view)});
}

async function report(page, from, to, title, box) {
  const result = await runVerb(page, ["report", from, "-o", to, "--force"]);
  if (!result) return;
  if (result.code !== DONE) {
    box.replaceChildren(sentenceList(sentencesOf(result), {class: "said problem"}));
    return;
  }
  page.store.derive(result.files);
  const bytes = result.files[to];
  box.replaceChildren(reportFrame(title, to, bytes, {onDownload: () => download(to, bytes)}));
}

async function diagnose(page, noise) {
  const words = ["diagnose", fittedList(page.store.view), "--machine", "machine.json", ...noise, "-o", "diagnosis.json", "--report", "diagnosis.html", "--force"];
  const result = await runVerb(page, words);
  if (!result) return;
  if (result.code !== DONE) {
    page.alert(sentencesAbout(listOf(page), result).join(" "));
    return;
  }
  page.store.derive(result.files);
}

async function planNext(page, box) {
  const result = await runVerb(page, ["plan", fittedList(page.store.view), "--after", "diagnosis.json", "--machine", "machine.json", "-o", "next.csv", "--force"]);
  if (!result) return;
  const rows = result.files["next.csv"] ? textOf(result.files["next.csv"]).split("\n").slice(1).filter((line) => line && !line.startsWith("#")) : [];
  box.replaceChildren(sentenceList(sentencesAbout(listOf(page), result)), ...(rows.length === 0 ? [] : [
    printed(textOf(result.files["next.csv"]), "Places to measure next"),
    h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => addRows(page, result.files["next.csv"])}, "Add them to the list")),
  ]));
}

/** The new lines in the columns of the list; their numbers continue those of the list. */
function addRows(page, bytes) {
  const path = fittedList(page.store.view);
  const list = textOf(page.store.folder[path]);
  const lines = list.split("\n").filter((line) => line !== "");
  const columns = lines.find((line) => !line.startsWith("#")).split(",");
  const [header, ...added] = textOf(bytes).split("\n").filter((line) => line && !line.startsWith("#")).map((line) => line.split(","));
  const rows = added.map((cells) => columns.map((column) => cells[header.indexOf(column)] ?? "").join(","));
  const notes = lines.filter((line) => line.startsWith("#"));
  const kept = lines.filter((line) => !line.startsWith("#"));
  page.store.change({[path]: bytesOf(`${[...kept, ...rows, ...notes].join("\n")}\n`)});
  page.store.show({step: "measure", sheet: path});
}

const listOf = (page) => Sheet.of(textOf(page.store.folder[fittedList(page.store.view)]));

async function planCheck(page) {
  await chooseWay(page, NEW_POINTS);
  if (page.store.folder[NEW_POINTS]) page.store.show({step: "measure"});
}
