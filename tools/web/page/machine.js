// SPDX-License-Identifier: GPL-3.0-or-later
// The first step: the machine.
import {isOfBelts} from "./belts_text.js";
import {DONE, problemOf, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, contentOf, fileDrop, h, textOf, unreadable} from "./dom.js";
import {hasReadings, isBelts, isPlotter, jsonOf, MARKS, NO_DIAGNOSIS} from "./folder.js";
import {explained} from "./glossary.js";
import {isOfPlotter, isWallPlotter} from "./plotter_text.js";
import {inPage} from "./in_page.js";
import {MachineForm} from "./machine_form.js";
import {folderOf} from "./zip.js";

/** The folder of the machine and its sheets in the command; here it is the page's own folder. */
const FOLDER = "my-machine";
/** The readings of fixtures/start, and what is wrong with the machine that they are of. */
const EVENINGS = [
  ["worn_chain", "A worn chain"], ["bent_beam", "A beam that bends"], ["long_tape", "A tape that is too long"],
  ["slipped_tooth", "A chain that jumped a tooth"], ["nothing_wrong", "Nothing wrong"], ["maslow4", "A Maslow 4"],
];
const SETTINGS = ".ini,.json,.yaml,.yml,.txt,.h,.properties,.zip";

export function machineStep(page) {
  const said = h("div", {class: "said", role: "status"});
  const form = new MachineForm((machine, name, pointer) => numbersTyped(page, machine, {name, pointer}, say));
  const others = h("ul", {class: "sentences assumed"});
  const pen = h("p", {class: "buttons", hidden: true}, h("button", {type: "button", onclick: () => wallPlotter(page, say)}, "It hangs a pen, not a router"));
  const plotterAssumed = h("div");
  const plotter = h("section", {hidden: true}, h("h3", {}, "A pen plotter"),
    h("p", {}, "It draws a test page; what a ruler reads of it says which of its settings are off."), plotterAssumed,
    h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "measure"})}, "On to the test page")));
  const numbers = h("section", {hidden: true}, h("h3", {}, "Its numbers"),
    h("p", {}, "As the settings state them; what they do not say was assumed, and says so. A few millimetres do for the motors: the " +
      "readings will tell better."), form.element, others,
    h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.store.show({step: "measure"})}, "On to measuring")));
  const element = h("div", {},
    h("section", {}, h("h3", {}, "Your machine"),
      h("p", {}, "From the settings that your machine runs with, this page makes the sheets to measure it, a map of its " +
        "errors from what you read, and programs that it cuts true. Nothing leaves this computer."),
      fileDrop("settings", "Open the machine's settings", SETTINGS,
        "groundcontrol.ini, webcontrol.json, FluidNC's yaml, a machine.json, a Maslow 4's log or maslow.yaml, a pen plotter's settings, or the zip of an earlier evening. Or drop it here.",
        (files) => open(page, files, say), {multiple: true}),
      page.belts.pasteBox(say),
      h("p", {class: "buttons"},
        h("button", {type: "button", onclick: () => example(page, say)}, "Try an example machine"),
        h("button", {type: "button", onclick: () => fromTemplate(page, say)}, "Type the numbers in"))),
    h("section", {}, h("h3", {}, "Example evenings"),
      h("p", {}, "What this page says of a machine with one thing wrong. Each opens with its readings typed in."),
      h("p", {class: "buttons"}, EVENINGS.map(([name, title]) =>
        h("button", {type: "button", onclick: () => openEvening(page, name, say)}, title)))),
    said, page.belts.readingPart(), pen, plotter, numbers);

  function say(sentences, isProblem = false) {
    said.className = isProblem ? "said problem" : "said";
    said.replaceChildren(...(sentences.length > 0 ? [sentenceList(sentences)] : []));
    if (isProblem && sentences.length > 0) said.scrollIntoView({block: "nearest"});
  }

  let assumed = "";
  return {
    element,
    given: () => (isBelts(page.store.folder) ? page.belts.given() : isPlotter(page.store.folder) ? page.plotter.given() : given(page.store)),
    update() {
      const {folder, view} = page.store;
      page.belts.update();
      page.plotter.update();
      plotter.hidden = !isPlotter(folder);
      if (!plotter.hidden) plotterAssumed.replaceChildren(sentenceList((view.assumed ?? []).map((line) => line.charAt(0).toUpperCase() + line.slice(1))));
      pen.hidden = isPlotter(folder) || wallPlotterOf(folder) === null;
      const machine = jsonOf(folder["machine.json"]);
      numbers.hidden = !machine || isBelts(folder) || isPlotter(folder);
      if (numbers.hidden) return;
      try {
        form.draw(machine);
      } catch {
        numbers.hidden = true;  // the command reports what is missing in it whenever it is used
        return;
      }
      const sentences = form.assume(view.assumed ?? []);
      if (assumed === sentences.join("\n")) return;
      assumed = sentences.join("\n");
      others.replaceChildren(...sentences.map((sentence) => h("li", {}, explained(sentence))));
    },
    marked: (problems) => say(form.mark(problems).map(({text}) => text), true),
    cleared: () => form.mark([]),
  };
}

/** The line of the folded step. */
function given({folder, view}) {
  const machine = jsonOf(folder["machine.json"]);
  if (!machine?.motors?.left || !machine.bed) return "";
  const apart = machine.motors.right.x_mm - machine.motors.left.x_mm;
  const assumed = (view.assumed ?? []).filter((sentence) => sentence.includes("assumed")).length;
  return `${machine.name || "A machine"}: sheet ${machine.bed.width_mm} x ${machine.bed.height_mm} mm, motors ${Math.round(apart)} mm apart` +
    (assumed > 0 ? `; ${assumed} number${assumed > 1 ? "s" : ""} assumed` : "");
}

export function mayReplace(page) {
  return !hasReadings(page.store.folder) ||
    confirm("This replaces the machine and the readings in this page. Undo brings them back until the page is closed.");
}

/** What was chosen for one machine is not for the next. */
const NEW_VIEW = {sheet: MARKS, fitted: MARKS, way: null, plain: false, before: null, hook: false, home: null, noise: undefined, assumed: [], runs: 0, run: null};

/** Replaces the whole folder by `files`, in one step. */
export function replaceFolder(page, files, step) {
  const gone = Object.fromEntries(Object.keys(page.store.folder).map((path) => [path, null]));
  page.store.change({...gone, ...files});
  page.store.show({...NEW_VIEW, step});
}

async function open(page, files, say) {
  if (!mayReplace(page)) return;
  const [file] = files;
  const contents = await Promise.all(files.map(contentOf));
  const unread = contents.indexOf(null);
  if (unread >= 0) {
    say([unreadable(files[unread])], true);
    return;
  }
  const [bytes] = contents;
  if (/\.zip$/i.test(file.name)) {
    await openZip(page, bytes, say);
    return;
  }
  const name = file.name.replace(/[^\w.-]/g, "_");
  const text = contents.map(textOf).join("\n");
  if (/^\s*\{/.test(text) && text.includes('"chaintrue_machine"')) {
    await startFrom(page, "machine.json", bytes, say, "machine");
  } else if (isOfPlotter(text)) {
    await page.plotter.take(text, name, say);
  } else if (/\.(txt|log)$/i.test(name) || isOfBelts(text)) {
    await page.belts.take(text, say);
  } else {
    await startFrom(page, name, bytes, say, "machine");
  }
}

/** The file of FluidNC's WallPlotter in the folder, which may hang a pen; null for none. */
const wallPlotterOf = (folder) => Object.keys(folder).find((path) => /\.ya?ml$/i.test(path) && isWallPlotter(textOf(folder[path]))) ?? null;

async function wallPlotter(page, say) {
  const name = wallPlotterOf(page.store.folder);
  if (name && mayReplace(page)) await page.plotter.takeWallPlotter(name, page.store.folder[name], say);
}

/** Sentences on what a settings file does not say, or on what came from it with a doubt, end with the place in machine.json. */
const isAssumption = (sentence) => /\(\/[a-z_/]+\)$/.test(sentence);

export async function openZip(page, bytes, say) {
  let files = null;
  try {
    files = folderOf(bytes);
  } catch (problem) {
    say([`This zip cannot be read (${problem.message}). Open one that the button Download has made.`], true);
    return;
  }
  if (!Object.keys(files).some((path) => ["machine.json", "belts.json", "map.json", "drawing.json"].includes(path))) {
    say(["This zip holds no machine.json. Open one that the button Download has made."], true);
    return;
  }
  replaceFolder(page, files, "measure");
  say([]);
}

/**
 * `chaintrue start`: the machine and the sheets from a settings file. What it assumed is shown at the machine's numbers,
 * so that step stays open where something was.
 */
export async function startFrom(page, name, bytes, say, step) {
  const isOurs = name === "machine.json";
  const result = await runVerb(page, isOurs ? ["start", name] : ["start", name, FOLDER], {files: {[name]: bytes}});
  if (!result) return false;
  const sentences = sentencesOf(result);
  if (result.code !== DONE) {
    say(sentences, true);
    return false;
  }
  const made = Object.entries(result.files).map(([path, content]) => [path.replace(`${FOLDER}/`, ""), content]);
  const assumed = sentences.filter(isAssumption).map((sentence) => sentence.replace(`${name}: `, ""));
  replaceFolder(page, {[name]: bytes, ...Object.fromEntries(made)}, step);
  page.store.show({assumed});
  say(sentences.filter((sentence) => !isAssumption(sentence)).map(inPage));
  return true;
}

async function fromTemplate(page, say) {
  if (!mayReplace(page)) return;
  const template = await runVerb(page, ["start", "."], {files: {}});
  if (template?.code !== DONE) return;
  if (await startFrom(page, "machine.json", template.files["machine.json"], say, "machine")) {
    say(["This is a classic Maslow. Put your machine's numbers in; the drawing shows which is which."]);
    document.getElementById("machine-distance")?.focus();
  }
}

async function example(page, say) {
  if (!mayReplace(page)) return;
  const files = page.example;
  if (!await startFrom(page, "groundcontrol.ini", bytesOf(files["groundcontrol.ini"]), say, "measure")) return;
  page.store.change({"marks.csv": bytesOf(files["marks.csv"]), "bracket.nc": bytesOf(files["bracket.nc"])});
}

async function openEvening(page, name, say) {
  if (!mayReplace(page)) return;
  const {evenings, "groundcontrol.ini": settings} = page.example;
  if (name === "maslow4") {
    await page.belts.take(evenings.maslow4, say);
    return;
  }
  if (!await startFrom(page, "groundcontrol.ini", bytesOf(settings), say, "measure")) return;
  page.store.change({"marks.csv": bytesOf(evenings[name])});
}

/** A number of the form: checked by the command, which plans new sheets if nothing was read yet. */
async function numbersTyped(page, machine, {name, pointer}, say) {
  const bytes = bytesOf(`${JSON.stringify(machine, null, 2)}\n`);
  page.store.show({assumed: (page.store.view.assumed ?? []).filter((sentence) => !sentence.includes(`(${pointer}`))});
  page.store.change({"machine.json": bytes, ...NO_DIAGNOSIS}, name);
  const result = await runVerb(page, ["start", "machine.json"], {files: {"machine.json": bytes}, quiet: true, supersede: "machine"});
  if (!result) return;
  if (result.code !== DONE) {
    page.machine.marked(sentencesOf(result).map((sentence) => problemOf(sentence, "machine.json") ?? {text: sentence}));
    return;
  }
  page.machine.cleared();
  say([]);
  if (!hasReadings(page.store.folder)) page.store.derive(result.files);
}
