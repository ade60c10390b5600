// SPDX-License-Identifier: GPL-3.0-or-later
// The first step: the machine.
import {DONE, problemOf, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, contentOf, fileDrop, h, textOf, unreadable} from "./dom.js";
import {MachineForm} from "./machine_form.js";
import {Sheet} from "./sheet.js";
import {folderOf} from "./zip.js";

/** The folder of the machine and its sheets in the command; here it is the page's own folder. */
const FOLDER = "my-machine";
const SETTINGS = ".ini,.json,.yaml,.yml,.txt,.zip";

export function machineStep(page) {
  const said = h("div", {class: "said", role: "status"});
  const form = new MachineForm((machine, name) => numbersTyped(page, machine, name, say));
  const numbers = h("section", {hidden: true}, h("h2", {}, "Its numbers"),
    h("p", {}, "As the settings state them; what they do not say was assumed. A few millimetres do for the motors: the " +
      "readings will tell better."), form.element);
  const element = h("div", {},
    h("section", {}, h("h2", {}, "Your machine"),
      h("p", {}, "From the settings that your machine runs with, this page makes the sheets to measure it, a map of its " +
        "errors from what you read, and programs that it cuts true. Nothing leaves this computer."),
      fileDrop("settings", "Open the machine's settings", SETTINGS,
        "groundcontrol.ini, webcontrol.json, FluidNC's yaml, a machine.json, a Maslow 4 log, or the zip of an earlier evening. Or drop it here.",
        ([file]) => open(page, file, say)),
      h("p", {class: "buttons"},
        h("button", {type: "button", onclick: () => example(page, say)}, "Try an example machine"),
        h("button", {type: "button", onclick: () => fromTemplate(page, say)}, "Type the numbers in"))),
    said, numbers);

  function say(sentences, isProblem = false) {
    said.className = isProblem ? "said problem" : "said";
    said.replaceChildren(...(sentences.length > 0 ? [sentenceList(sentences)] : []));
    if (isProblem && sentences.length > 0) said.scrollIntoView({block: "nearest"});
  }

  return {
    element,
    update() {
      const file = page.store.folder["machine.json"];
      numbers.hidden = !file;
      if (!file) return;
      try {
        form.draw(JSON.parse(textOf(file)));
      } catch {
        numbers.hidden = true;  // the command reports what is wrong with it whenever it is used
      }
    },
    marked: (problems) => say(form.mark(problems).map(({text}) => text), true),
    cleared: () => form.mark([]),
  };
}

/** True if readings were typed into a list: they are not discarded without a question. */
export function hasReadings(folder) {
  return Object.entries(folder).some(([path, bytes]) => path.endsWith(".csv") && (Sheet.of(textOf(bytes))?.filled ?? 0) > 0);
}

export function mayReplace(page) {
  return !hasReadings(page.store.folder) ||
    confirm("This replaces the machine and the readings in this page. Undo brings them back until the page is closed.");
}

/** Replaces the whole folder by `files`, in one step. */
export function replaceFolder(page, files, step) {
  const gone = Object.fromEntries(Object.keys(page.store.folder).map((path) => [path, null]));
  page.store.change({...gone, ...files});
  page.store.show({step, sheet: "marks.csv"});
}

async function open(page, file, say) {
  if (!mayReplace(page)) return;
  const bytes = await contentOf(file);
  if (!bytes) {
    say([unreadable(file)], true);
    return;
  }
  if (/\.zip$/i.test(file.name)) {
    await openZip(page, bytes, say);
    return;
  }
  const name = file.name.replace(/[^\w.-]/g, "_");
  if (/^\s*\{/.test(textOf(bytes.slice(0, 200))) && textOf(bytes).includes('"chaintrue_machine"')) {
    await startFrom(page, "machine.json", bytes, say);
  } else if (/\.(txt|log)$/i.test(name)) {
    await page.maslow4.open(name, bytes, say);
  } else {
    await startFrom(page, name, bytes, say);
  }
}

export async function openZip(page, bytes, say) {
  let files = null;
  try {
    files = folderOf(bytes);
  } catch (problem) {
    say([`This zip cannot be read (${problem.message}). Open one that the button Download has made.`], true);
    return;
  }
  if (!Object.keys(files).some((path) => ["machine.json", "belts.json", "map.json"].includes(path))) {
    say(["This zip holds no machine.json. Open one that the button Download has made."], true);
    return;
  }
  replaceFolder(page, files, "measure");
  say([]);
}

/** `chaintrue start`: the machine and the sheets from a settings file. */
export async function startFrom(page, name, bytes, say, step = "measure") {
  const isOurs = name === "machine.json";
  const result = await runVerb(page, isOurs ? ["start", name] : ["start", name, FOLDER], {files: {[name]: bytes}});
  if (!result) return false;
  const sentences = sentencesOf(result);
  if (result.code !== DONE) {
    say(sentences, true);
    return false;
  }
  const made = Object.entries(result.files).map(([path, content]) => [path.replace(`${FOLDER}/`, ""), content]);
  replaceFolder(page, {[name]: bytes, ...Object.fromEntries(made)}, step);
  say(sentences);
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
  if (!await startFrom(page, "groundcontrol.ini", bytesOf(files["groundcontrol.ini"]), say)) return;
  page.store.change({"marks.csv": bytesOf(files["marks.csv"]), "bracket.nc": bytesOf(files["bracket.nc"])});
}

/** A number of the form: checked by the command, which plans new sheets if nothing was read yet. */
async function numbersTyped(page, machine, name, say) {
  const bytes = bytesOf(`${JSON.stringify(machine, null, 2)}\n`);
  page.store.change({"machine.json": bytes}, name);
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
