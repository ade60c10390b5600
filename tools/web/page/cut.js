// SPDX-License-Identifier: GPL-3.0-or-later
// The fourth step: a program before and after.
import {JOBS, NUMBERS, putAway, waysOf} from "./choice.js";
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {contentOf, download, fileDrop, h, unreadable} from "./dom.js";
import {DRAWING, filledIn, HOLES, isBelts, isPlotter, jsonOf, mapOf, PASTED} from "./folder.js";
import {reportFrame} from "./frame.js";
import {inPage} from "./in_page.js";
import {areTypedIn, settingsWords} from "./numbers.js";
import {readsGcode} from "./plotter_text.js";

const PROGRAMS = [".nc", ".gcode", ".ngc", ".tap", ".cnc", ".txt"];
/** Programs that drive to the marks; they belong to the lists of marks. */
const SHEETS = ["marks.nc", "holes.nc", "lengths.nc", "five.nc", "page.gcode", "sheet.txt"];
/** The task that a newer program supersedes. */
const TASK = "cut";

/** What the controller holds now, where that is not what it was measured with. */
const nowWords = (folder) => (isPlotter(folder) ? [] : !isBelts(folder) ? settingsWords(folder) : folder[PASTED] ? ["--machine", PASTED] : []);
const areIn = (folder) => (isBelts(folder) ? Boolean(folder[PASTED]) : areTypedIn(folder));

const isProgram = (path) => PROGRAMS.some((end) => path.toLowerCase().endsWith(end));

/** Why a file of this name cannot be added to the folder as a program; null if it can. */
function refusalOf(name, folder) {
  if (!isProgram(name)) return `${name} is not opened: a G-code program's name ends in ${PROGRAMS.slice(0, -1).join(", ")} or ${PROGRAMS.at(-1)}.`;
  if (name in folder && (SHEETS.includes(name) || name === "README.txt"))
    return `${name} is not opened: the machine's folder has a file of that name. Give the program another name.`;
  return null;
}

/** Where GroundControl's home is, as somebody typed it; other controllers have none. */
const homeOf = ({folder, view}) => (isBelts(folder) || isPlotter(folder) ? "0,0"
  : (view.home ?? []).map((text) => text.trim().replace(",", ".") || "0").join(",") || "0,0");
const homeWords = (store) => (homeOf(store) === "0,0" ? [] : ["--home", homeOf(store)]);

/** Asked before a program is written: GroundControl adds its home to every place that it is sent. */
function homeFields(page) {
  const inputs = ["x", "y"].map((axis) => h("input", {id: `home-${axis}`, type: "text", inputmode: "decimal", size: 6,
    onchange: () => page.store.show({home: inputs.map(({value}) => value)})}));
  const element = h("p", {class: "choices"}, inputs.map((input, index) =>
    h("span", {class: "pair"}, h("label", {for: input.id}, ["Home is at x, mm", "y, mm"][index]), input)),
  h("span", {class: "hint"}, "0, 0 is the sheet's middle; elsewhere if you have moved it with Define Home"));
  return {
    element,
    update({folder, view}) {
      element.hidden = isBelts(folder) || isPlotter(folder);
      inputs.forEach((input, index) => {
        if (input !== document.activeElement) input.value = view.home?.[index] ?? "0";
      });
    },
  };
}

export function cutStep(page) {
  const said = h("div", {class: "said", role: "status"});
  const outcome = h("div");
  const none = h("p", {class: "hint"}, "There is no map yet: type readings in first.");
  const jobs = h("p", {class: "buttons"});
  const settings = h("p", {class: "hint"});
  const away = h("div");
  const title = h("h3", {}, "Cut a part true");
  const home = homeFields(page);
  const open = h("div", {hidden: true},
    h("section", {}, title,
      h("p", {}, "The program is rewritten so that the machine as it is cuts what was drawn, and run " +
        "on a simulated controller before you get it."),
      settings, home.element,
      fileDrop("program", "Open a G-code program", PROGRAMS.join(","), "Or drop it here.", ([file]) => take(file)), jobs),
    said, outcome);
  const all = h("div", {hidden: true}, away, open);

  /** Of several programs in sequence only the last is processed and shown. */
  let latest = 0;
  /** Whether numbers were typed in when the program that is shown was compensated. */
  let wereTypedIn = false;
  /** Where home was then. */
  let homeWas = "";
  let awayFor = "";
  let shownJobs = "";
  function begin() {
    page.engine.cancel((job) => job.supersede === TASK);
    outcome.replaceChildren();
    said.replaceChildren();
    return ++latest;
  }

  function say(sentences, isProblem) {
    said.className = isProblem ? "said problem" : "said";
    said.replaceChildren(sentenceList(sentences.map(inPage)));
  }

  async function take(file) {
    const mine = begin();
    const name = file.name.replace(/[^\w.-]/g, "_");
    const refused = refusalOf(name, page.store.folder);
    if (refused) {
      say([refused], true);
      return;
    }
    const bytes = await contentOf(file);
    if (mine !== latest) return;
    if (!bytes) {
      say([unreadable(file)], true);
      return;
    }
    page.store.change({[name]: bytes});
    await compensate(name);
  }

  async function compensate(name) {
    const mine = begin();
    const stem = name.replace(/\.[^.]*$/, "");
    const names = {name, truth: `${stem}.true.nc`, report: `${stem}.html`};
    const result = await runVerb(page, ["gcode", "compensate", name, "--map", mapOf(page.store.folder), ...nowWords(page.store.folder), ...homeWords(page.store),
      "-o", names.truth, "--report", names.report, "--force"], {supersede: TASK});
    if (mine !== latest) return;
    if (!result) {
      say([`${name} was not compensated. Open it once more to try again.`], true);
      return;
    }
    const isDone = result.code === DONE;
    wereTypedIn = areIn(page.store.folder);
    homeWas = homeOf(page.store);
    say(sentencesOf(result), !isDone);
    page.store.derive(result.files);
    // Who compensates a program before the choice has chosen.
    if (isDone && !page.store.view.way) page.store.show({way: JOBS});
    if (isDone) show(names, result.files);
  }

  function show({name, truth, report}, files) {
    const verdict = h("div", {class: "said", role: "status"});
    outcome.replaceChildren(h("section", {}, h("h3", {}, name),
      h("p", {class: "buttons"},
        h("button", {type: "button", class: "main", onclick: () => download(truth, files[truth])}, `Download ${truth}`),
        h("button", {type: "button", onclick: () => verify(name, truth, verdict)}, "Verify it once more")),
      verdict,
      files[report] && reportFrame(`${name} before and after`, report, files[report], {onDownload: () => download(report, files[report])})));
  }

  /** What stands here instead of the programs, where there is nothing to compensate. */
  function drawAway(folder, view) {
    const isChosen = view.way === NUMBERS && !areIn(folder);
    const isAllIn = isBelts(folder) && areIn(folder) && filledIn(folder[HOLES]) === 0;
    const key = isChosen ? "chosen" : isAllIn ? "all in" : "";
    open.hidden = key !== "";
    if (awayFor === key) return;
    awayFor = key;
    away.replaceChildren(...(isChosen ? [h("section", {}, putAway(page, waysOf(isBelts(folder)), NUMBERS))]
      : isAllIn ? [h("section", {}, h("p", {}, "The lines are in the machine: cut programs as they are. What is left, holes and a tape show (under Measure); " +
        "then programs can be compensated for it."))] : []));
  }

  async function verify(name, truth, verdict) {
    const result = await runVerb(page, ["gcode", "verify", name, truth, "--map", mapOf(page.store.folder), ...nowWords(page.store.folder), ...homeWords(page.store)]);
    if (!result) return;
    verdict.className = result.code === DONE ? "said" : "said problem";
    verdict.replaceChildren(sentenceList([...result.stdout.split("\n").filter(Boolean), ...sentencesOf(result)]));
  }

  return {
    element: h("div", {}, none, all),
    given: () => done(page.store.folder),
    label: () => (isPlotter(page.store.folder) ? "Draw" : "Cut"),
    update() {
      const {folder, view} = page.store;
      const isOfPictures = isPlotter(folder) && !readsGcode(jsonOf(folder[DRAWING]));
      const ready = Boolean(folder[mapOf(folder)]) && !isOfPictures;
      none.hidden = ready;
      title.textContent = isPlotter(folder) ? "Draw a picture true" : "Cut a part true";
      none.textContent = isOfPictures ? "This plotter is sent pictures, not programs: it draws them true once the lines are typed in."
        : isPlotter(folder) ? "Nothing is found yet: measure the test page first." : isBelts(folder) ? "The anchors are not found yet: paste the log first." : "There is no map yet: type readings in first.";
      all.hidden = !ready;
      drawAway(folder, view);
      settings.textContent = settingsSentence(folder);
      home.update(page.store);
      if (outcome.firstChild && homeWas !== homeOf(page.store)) {
        begin();
        say(["Home was elsewhere when this program was compensated: compensate it again."], true);
      }
      if (outcome.firstChild && wereTypedIn !== areIn(folder)) {
        begin();
        say(["The controller holds other numbers than this program was compensated for: compensate it again."], true);
      }
      const programs = Object.keys(folder).filter((path) => isProgram(path) && !SHEETS.includes(path) && !/\.(true\.nc|txt)$/i.test(path));
      if (shownJobs === programs.join("/")) return;
      shownJobs = programs.join("/");
      jobs.replaceChildren(...programs.map((path) => h("button", {type: "button", onclick: () => compensate(path)}, `Compensate ${path}`)));
    },
  };
}

function settingsSentence(folder) {
  if (isPlotter(folder)) return "It is for the plotter with the numbers that it drew the test page with. Once you have typed the lines in, draw the second page first.";
  if (isBelts(folder)) {
    return areIn(folder) ? "It is for the machine with the lines that you pasted (see Map and causes)."
      : "It is for the machine with the anchors that it had when the log was made. If you have pasted the lines since, say so under Map and causes.";
  }
  return areIn(folder) ? "It is for the controller with the numbers that you typed in (see Map and causes)."
    : "It is for the controller with the settings that it was measured with. If you have typed in the better numbers since, " +
      "say so under Map and causes.";
}

/** The line of the folded step: the programs that were compensated. */
function done(folder) {
  return Object.keys(folder).filter((path) => path.endsWith(".true.nc")).join(", ");
}
