// SPDX-License-Identifier: GPL-3.0-or-later
// The third step: the map's report, why the machine errs, better numbers, what to measure next.
import {DONE, printed, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, download, h, textOf} from "./dom.js";
import {reportFrame} from "./frame.js";

export function resultStep(page) {
  const map = h("div");
  const causes = h("div");
  const next = h("div");
  const numbers = h("div");
  const none = h("p", {class: "hint"}, "There is no map yet: type readings in first.");
  const all = h("div", {hidden: true},
    h("section", {}, h("h2", {}, "How true it cuts"), map),
    h("section", {}, h("h2", {}, "Why does it err?"),
      h("p", {}, "Which of the known causes explains the readings, how sure that is, and what to do."),
      noiseFields(page),
      h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => diagnose(page)}, "Find the cause")),
      causes, next),
    h("section", {}, h("h2", {}, "Better numbers"),
      h("p", {}, "Typed into the controller once, they take off what settings can. Or compensate each program, which is truer."),
      h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => exportNumbers(page, numbers)}, "Show the numbers to type in")),
      numbers));
  const seen = {};

  /** Draws `box` anew where `path` of the folder has changed. */
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
      follow("map.json", map, () => {
        numbers.replaceChildren();
        report(page, "map.json", "map.html", "The map", map);
      });
      follow("diagnosis.html", causes, (bytes) => causes.append(reportFrame("The diagnosis", "diagnosis.html", bytes,
        {onDownload: () => download("diagnosis.html", bytes)})));
      follow("diagnosis.json", next, () => next.append(h("p", {class: "buttons"},
        h("button", {type: "button", onclick: () => planNext(page, next)}, "What to measure next"))));
    },
  };
}

/** The noise that a person states; the values at first are those of the command's own README.txt. */
function noiseFields(page) {
  const field = (id, label) => {
    const input = h("input", {id, type: "text", inputmode: "decimal", size: 5});
    return h("span", {class: "pair"}, h("label", {for: id}, label), input);
  };
  return h("p", {class: "choices"}, field("noise-length", "A chain length is good to, mm"),
    field("noise-position", "A place that you read is good to, mm"),
    h("span", {class: "hint"}, page.noiseHint));
}

/** The line of README.txt that begins `chaintrue diagnose`, as words. */
function diagnoseWords(folder) {
  const readme = folder["README.txt"] ? textOf(folder["README.txt"]) : "";
  const line = /^ *chaintrue (diagnose marks\.csv .*)$/m.exec(readme);
  return line ? line[1].split(" ") : ["diagnose", "marks.csv", "--machine", "machine.json"];
}

function noiseWords(folder) {
  const words = diagnoseWords(folder);
  return ["--noise-length-mm", "--noise-position-mm"].flatMap((option) => {
    const input = document.getElementById(option === "--noise-length-mm" ? "noise-length" : "noise-position");
    const typed = input.value.trim().replace(",", ".");
    const usual = words[words.indexOf(option) + 1];
    if (typed === "" && words.includes(option)) input.value = usual;
    const value = typed === "" ? usual : typed;
    return words.includes(option) || typed !== "" ? [option, value] : [];
  });
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

async function diagnose(page) {
  const {folder, view} = page.store;
  const noise = view.sheet === "holes.csv" ? [] : noiseWords(folder);
  const words = ["diagnose", view.sheet, "--machine", "machine.json", ...noise, "-o", "diagnosis.json", "--report", "diagnosis.html", "--force"];
  const result = await runVerb(page, words);
  if (!result) return;
  if (result.code !== DONE) {
    page.alert(sentencesOf(result).join(" "));
    return;
  }
  page.store.derive(result.files);
}

async function planNext(page, box) {
  const result = await runVerb(page, ["plan", page.store.view.sheet, "--after", "diagnosis.json", "--machine", "machine.json", "-o", "next.csv", "--force"]);
  if (!result) return;
  const rows = result.files["next.csv"] ? textOf(result.files["next.csv"]).split("\n").slice(1).filter((line) => line && !line.startsWith("#")) : [];
  box.replaceChildren(sentenceList(sentencesOf(result)),
    rows.length > 0 && printed(textOf(result.files["next.csv"]), "Places to measure next"),
    rows.length > 0 && h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => addRows(page, result.files["next.csv"])},
      "Add them to the list")));
}

/** The new lines in the columns of the list; their numbers go on where the list ends. */
function addRows(page, bytes) {
  const path = page.store.view.sheet;
  const list = textOf(page.store.folder[path]);
  const lines = list.split("\n").filter((line) => line !== "");
  const columns = lines.find((line) => !line.startsWith("#")).split(",");
  const [header, ...added] = textOf(bytes).split("\n").filter((line) => line && !line.startsWith("#")).map((line) => line.split(","));
  const rows = added.map((cells) => columns.map((column) => cells[header.indexOf(column)] ?? "").join(","));
  const notes = lines.filter((line) => line.startsWith("#"));
  const kept = lines.filter((line) => !line.startsWith("#"));
  page.store.change({[path]: bytesOf(`${[...kept, ...rows, ...notes].join("\n")}\n`)});
  page.store.show({step: "measure"});
}

async function exportNumbers(page, box) {
  const result = await runVerb(page, ["export", "groundcontrol", "map.json"]);
  if (!result) return;
  box.replaceChildren(result.stdout !== "" ? printed(result.stdout, "Numbers to type in") : "", sentenceList(sentencesOf(result)));
}
