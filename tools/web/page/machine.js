// SPDX-License-Identifier: GPL-3.0-or-later
// The first step: the machine.
import {DONE, problemOf, runVerb, sentencesOf} from "./command.js";
import {bytesOf, h, textOf} from "./dom.js";
import {BELTS, hasReadings, jsonOf, MARKS, NO_DIAGNOSIS, roadOf} from "./folder.js";
import {explained} from "./glossary.js";
import {inPage} from "./in_page.js";
import {MachineForm} from "./machine_form.js";
import {isWallPlotter} from "./plotter_text.js";
import {startPart} from "./start.js";
import {folderOf} from "./zip.js";

/** The folder of the machine and its sheets in the command; here it is the page's own folder. */
const FOLDER = "my-machine";
const MACHINES = {belts: "four belts", plotter: "a pen", chains: "two chains"};

export function machineStep(page) {
  const form = new MachineForm((machine, name, pointer) => numbersTyped(page, machine, {name, pointer}));
  const others = h("div", {class: "assumed"});
  const pen = h("p", {class: "buttons"}, h("button", {type: "button", onclick: () => wallPlotter(page)}, "It hangs a pen, not a router"));
  const title = h("h3");
  const go = h("button", {type: "button", class: "main", onclick: () => page.store.show({step: page.fit ? "result" : "measure"})});
  const reading = page.belts.readingPart();
  const loaded = h("div", {hidden: true}, h("section", {}, title, h("p", {class: "buttons"}, go), form.element, others, reading, pen));
  const start = startPart(page);
  const other = h("details", {class: "folded", hidden: true}, h("summary", {}, "Another machine, or an example"));
  const element = h("div", {}, start, loaded, other);

  let assumed = null;
  return {
    element,
    given: () => ({belts: () => page.belts.given(), plotter: () => page.plotter.given(), chains: () => given(page.store)})[roadOf(page.store.folder)](),
    update() {
      const {folder, view} = page.store;
      page.belts.update();
      page.plotter.update();
      const road = roadOf(folder);
      const machine = jsonOf(folder["machine.json"]);
      const isLoaded = road !== "chains" || Boolean(machine);
      if (loaded.hidden === isLoaded) {
        (isLoaded ? other : element).append(start);
        other.open = false;
      }
      loaded.hidden = other.hidden = !isLoaded;
      if (!isLoaded) return;
      title.textContent = `Your machine: ${MACHINES[road]}`;
      go.textContent = page.fit ? "Go on with the result" : hasReadings(folder) ? "Go on measuring" : "On to measuring";
      go.hidden = road === "belts" && !folder[BELTS];
      pen.hidden = road === "plotter" || wallPlotterOf(folder) === null;
      reading.hidden = !folder[BELTS];
      form.element.hidden = road !== "chains" || !isComplete(machine);
      let sentences = (view.assumed ?? []).map(capital);
      if (!form.element.hidden) {
        form.draw(machine);
        sentences = form.assume(view.assumed ?? []);
      }
      if (assumed === sentences.join()) return;
      assumed = sentences.join();
      others.replaceChildren(h("ul", {class: "sentences"}, sentences.map((sentence) => h("li", {}, explained(sentence)))));
    },
    marked: (problems) => page.say(form.mark(problems).map(({text}) => text), true),
    cleared: () => form.mark([]),
  };
}

const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
/** Whether the form can show it; the command reports what is missing in it whenever it is used. */
const isComplete = (machine) => Boolean(machine.motors?.left && machine.motors.right && machine.bed);

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
  return page.store.view.isExample || !hasReadings(page.store.folder) ||
    confirm("This replaces the machine and the readings in this page. Undo brings them back until the page is closed.");
}

/** What was chosen for one machine is not for the next. */
const NEW_VIEW = {sheet: MARKS, fitted: MARKS, way: null, hook: false, home: null, noise: undefined, assumed: [], runs: 0, run: null, read: null, done: null, typed: false};

/** Replaces the whole folder by `files`, in one step. */
export function replaceFolder(page, files, step) {
  const gone = Object.fromEntries(Object.keys(page.store.folder).map((path) => [path, null]));
  page.fit = page.numbers = null;
  page.store.change({...gone, ...files});
  page.store.show({...NEW_VIEW, step});
}

/** The file of FluidNC's WallPlotter in the folder, which may hang a pen; null for none. */
const wallPlotterOf = (folder) => Object.keys(folder).find((path) => /\.ya?ml$/i.test(path) && isWallPlotter(textOf(folder[path]))) ?? null;

async function wallPlotter(page) {
  const name = wallPlotterOf(page.store.folder);
  if (name && mayReplace(page)) await page.plotter.takeWallPlotter(name, page.store.folder[name]);
}

/** Sentences on what a settings file does not say, or on what came from it with a doubt, end with the place in machine.json. */
const isAssumption = (sentence) => /\(\/[a-z_/]+\)$/.test(sentence);

export function openZip(page, bytes) {
  let files = null;
  try {
    files = folderOf(bytes);
  } catch (problem) {
    page.say([`This zip cannot be read (${problem.message}). Open one that the button Download has made.`], true);
    return false;
  }
  if (!Object.keys(files).some((path) => ["machine.json", "belts.json", "map.json", "drawing.json"].includes(path))) {
    page.say(["This zip holds no machine.json. Open one that the button Download has made."], true);
    return false;
  }
  replaceFolder(page, files, "measure");
  page.say(["The folder of an earlier evening is open again."]);
  return true;
}

/** `chaintrue start`: the machine and the sheets from a settings file. The step stays open, because it shows what was assumed. */
export async function startFrom(page, name, bytes, step) {
  const isOurs = name === "machine.json";
  const result = await runVerb(page, isOurs ? ["start", name] : ["start", name, FOLDER], {files: {[name]: bytes}});
  if (!result) return false;
  const sentences = sentencesOf(result);
  if (result.code !== DONE) {
    page.say(sentences, true);
    return false;
  }
  const made = Object.entries(result.files).map(([path, content]) => [path.replace(`${FOLDER}/`, ""), content]);
  const assumed = sentences.filter(isAssumption).map((sentence) => sentence.replace(`${name}: `, ""));
  replaceFolder(page, {[name]: bytes, ...Object.fromEntries(made)}, step);
  page.store.show({assumed});
  page.say([`${name} is read. Check its numbers, then go on to measuring.`,
    ...sentences.filter((sentence) => !isAssumption(sentence) && !/ holds the machine and the sheets/.test(sentence)).map(inPage)]);
  return true;
}

export async function fromTemplate(page) {
  if (!mayReplace(page)) return;
  const template = await runVerb(page, ["start", "."], {files: {}});
  if (template?.code !== DONE) return;
  if (await startFrom(page, "machine.json", template.files["machine.json"], "machine")) {
    page.say(["This is a classic Maslow. Put your machine's numbers in; the drawing shows which is which."]);
    document.getElementById("machine-distance")?.focus();
  }
}

/** A number of the form: checked by the command, which plans new sheets if nothing was read yet. */
async function numbersTyped(page, machine, {name, pointer}) {
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
  page.say([]);
  if (!hasReadings(page.store.folder)) page.store.derive(result.files);
}
