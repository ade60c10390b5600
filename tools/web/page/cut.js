// SPDX-License-Identifier: GPL-3.0-or-later
// The fourth step: a program before and after.
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {download, fileButton, h, svg} from "./dom.js";
import {DRAWING, filledIn, HOLES, isBelts, isPlotter, jsonOf, mapOf, PASTED, roadOf} from "./folder.js";
import {reportFrame} from "./frame.js";
import {inPage} from "./in_page.js";
import {intake} from "./intake.js";
import {readsGcode} from "./plotter_text.js";
import {JOBS, NUMBERS, putAway} from "./result.js";
import {areIn, settingsWords, typedTick} from "./type_in.js";
import {isStopped, verdictBand} from "./verdict.js";

const PROGRAMS = [".nc", ".gcode", ".ngc", ".tap", ".cnc", ".txt"];
/** Programs that drive to the marks; they belong to the lists of marks. */
const SHEETS = ["marks.nc", "holes.nc", "lengths.nc", "five.nc", "page.gcode", "sheet.txt"];
/** The task that a newer program supersedes. */
const TASK = "cut";

/** What the controller holds now, where that is not what it was measured with. */
const nowWords = (folder) => ({plotter: [], chains: settingsWords(folder), belts: folder[PASTED] ? ["--machine", PASTED] : []})[roadOf(folder)];

export const isProgram = (path) => PROGRAMS.some((end) => path.toLowerCase().endsWith(end));

/** Where GroundControl's home is, as somebody typed it; other controllers have none. */
const homeOf = ({folder, view}) => (isBelts(folder) || isPlotter(folder) ? "0,0"
  : (view.home ?? []).map((text) => text.trim().replace(",", ".") || "0").join(",") || "0,0");
const homeWords = (store) => (homeOf(store) === "0,0" ? [] : ["--home", homeOf(store)]);

/** Asked before a program is written, with a picture: GroundControl adds its home to every place that it is sent. */
function homeQuestion(page) {
  const inputs = ["x", "y"].map((axis) => h("input", {id: `home-${axis}`, type: "text", inputmode: "decimal", size: 6, "aria-label": `home ${axis}, mm`,
    onchange: () => page.store.show({home: inputs.map(({value}) => value)})}));
  const middle = h("input", {type: "radio", name: "home", id: "home-middle", onchange: () => page.store.show({home: ["0", "0"]})});
  const elsewhere = h("input", {type: "radio", name: "home", id: "home-elsewhere", onchange: () => inputs[0].focus()});
  const cross = svg("path", {class: "home"});
  const element = h("section", {class: "home-part"}, h("h3", {}, "Where is home?"),
    svg("svg", {viewBox: "-130 -70 260 140", class: "home-picture", role: "img", "aria-label": "The sheet with its middle lines, and home as a cross."},
      svg("rect", {class: "board", x: -120, y: -60, width: 240, height: 120}), svg("path", {class: "axes", d: "M -120 0 H 120 M 0 -60 V 60"}), cross),
    h("div", {}, h("p", {class: "pair"}, middle, h("label", {for: "home-middle"}, "in the sheet's middle")),
      h("p", {class: "pair"}, elsewhere, h("label", {for: "home-elsewhere"}, "elsewhere, since Define Home was used. x, y in mm from the middle:"), inputs)));
  return {
    element,
    /** Whether it still has to be answered. */
    isOpen: ({folder, view}) => roadOf(folder) === "chains" && !view.home,
    update({folder, view}) {
      element.hidden = roadOf(folder) !== "chains";
      middle.checked = view.home?.join() === "0,0";
      elsewhere.checked = Boolean(view.home) && !middle.checked;
      inputs.forEach((input, index) => {
        if (input !== document.activeElement) input.value = view.home?.[index] ?? "";
      });
      const [x, y] = (view.home ?? ["0", "0"]).map((text, index) => Math.max(-1, Math.min(1, Number(text.replace(",", ".")) / [1219, 610][index] || 0)) * [110, 50][index]);
      cross.setAttribute("d", `M ${x - 9} ${-y} h 18 M ${x} ${-y - 9} v 18`);
    },
  };
}

export function cutStep(page) {
  const said = h("div", {class: "said", role: "status"});
  const outcome = h("div");
  const stop = h("div");
  const jobs = h("p", {class: "buttons"});
  const settings = h("p", {class: "hint"});
  const home = homeQuestion(page);
  const open = h("section", {}, h("h3", {}, "Correct a program"),
    h("p", {}, "The program is rewritten for your machine, and run on a simulated controller before you get it."), settings,
    h("p", {class: "buttons"}, fileButton("program", "Open a G-code program", PROGRAMS.join(","), (files) => intake(page, files)), jobs));
  const all = h("div", {hidden: true}, home.element, open, said, outcome);

  /** Of several programs in sequence only the last is processed and shown. */
  let latest = 0;
  /** What the program that is shown was compensated for: home, and whether numbers were in. */
  let madeFor = "";
  let shownJobs = "";
  const now = () => `${homeOf(page.store)} ${areIn(page.store)}`;
  function begin() {
    page.engine.cancel((job) => job.supersede === TASK);
    outcome.replaceChildren();
    said.replaceChildren();
    return ++latest;
  }

  function say(sentences, tone) {
    said.className = `said ${tone}`;
    said.replaceChildren(sentenceList(sentences.map(inPage)));
  }

  /** Why nothing can be compensated now, as elements; empty where it can. */
  function stops({folder, view}) {
    const part = (...children) => [h("section", {}, ...children)];
    const go = (words, step) => h("p", {class: "buttons"}, h("button", {type: "button", class: "main", onclick: () => page.store.show({step})}, words));
    if (isPlotter(folder) && !readsGcode(jsonOf(folder[DRAWING]))) return part(h("p", {},
        "This plotter takes pictures, not programs. It draws them right once the numbers are " +
        "typed in."));
    if (!folder[mapOf(folder)]) return part(h("p", {class: "hint"}, "There is no result yet: measure first."), go("Go to the readings", "measure"));
    if (page.fit && isStopped(page)) return [verdictBand(page)];
    if (view.way === NUMBERS && !areIn(page.store)) {
      return part(h("h3", {}, "Are the numbers in?"), h("p", {},
          "You chose to type numbers in. Programs stay as they are; the remaining error can be " +
          "compensated after that."),
        page.numbers ? typedTick(page, page.numbers) : "", go("Show the numbers", "result"), putAway(page, NUMBERS));
    }
    if (isBelts(folder) && areIn(page.store) && filledIn(folder[HOLES]) === 0) return part(h("p", {},
        "The lines are in the machine: cut your programs as they are. Holes and a tape show the " +
        "remaining error; then programs can be compensated for " +
        "it."), go("Measure nine holes", "measure"));
    return [];
  }

  /** A program from anywhere on the page; it is kept until there is a result. */
  async function take(name, bytes) {
    const {folder} = page.store;
    if (name in folder && (SHEETS.includes(name) || name === "README.txt")) {
      page.say([`${name} is not opened: the machine's folder has a file of that name. Give the program another name.`], true);
      return;
    }
    page.store.change({[name]: bytes});
    const isStoppedHere = stops(page.store).length > 0;
    if (!isStoppedHere || folder[mapOf(folder)]) page.store.show({step: "cut"});
    if (isStoppedHere || home.isOpen(page.store)) page.say([`${name} is a program, and is kept. ${isStoppedHere ?
        "It can be corrected once you have read the " +
        "result." : "Enter where home is, then press its button."}`]);
    else await compensate(name);
  }

  async function compensate(name) {
    const mine = begin();
    const stem = name.replace(/\.[^.]*$/, "");
    const names = {name, truth: `${stem}.true.nc`, report: `${stem}.html`};
    const result = await runVerb(page, ["gcode", "compensate", name, "--map", mapOf(page.store.folder), ...nowWords(page.store.folder), ...homeWords(page.store),
      "-o", names.truth, "--report", names.report, "--force"], {supersede: TASK});
    if (mine !== latest) return;
    if (!result) {
      say([`${name} was not compensated. Open it once more to try again.`], "bad");
      return;
    }
    const isDone = result.code === DONE;
    madeFor = now();
    say(sentencesOf(result), isDone ? "good" : "bad");
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

  async function verify(name, truth, verdict) {
    const result = await runVerb(page, ["gcode", "verify", name, truth, "--map", mapOf(page.store.folder), ...nowWords(page.store.folder), ...homeWords(page.store)]);
    if (!result) return;
    verdict.className = `said ${result.code === DONE ? "good" : "bad"}`;
    verdict.replaceChildren(sentenceList([...result.stdout.split("\n").filter(Boolean), ...sentencesOf(result)]));
  }

  return {
    element: h("div", {}, stop, all), take,
    given: () => done(page.store.folder),
    update() {
      const {folder, view} = page.store;
      if (view.step !== "cut") return;
      const why = stops(page.store);
      stop.replaceChildren(...why);
      all.hidden = why.length > 0;
      settings.textContent = settingsSentence(page.store);
      home.update(page.store);
      open.hidden = home.isOpen(page.store);
      if (outcome.firstChild && madeFor !== now()) {
        begin();
        say(["Home or the machine's numbers have changed since this program was compensated: compensate it again."], "bad");
      }
      const programs = Object.keys(folder).filter((path) => isProgram(path) && !SHEETS.includes(path) && !/\.(true\.nc|txt)$/i.test(path));
      if (shownJobs === programs.join("/")) return;
      shownJobs = programs.join("/");
      jobs.replaceChildren(...programs.map((path) => h("button", {type: "button", onclick: () => compensate(path)}, `Compensate ${path}`)));
    },
  };
}

/** Which numbers a compensated program counts on. */
const settingsSentence = (store) => `The machine must hold ${areIn(store) ? "the numbers that you typed in" : "the numbers that it was measured with"}; the Result step has a tick for that.`;

/** The line of the folded step: the programs that were compensated. */
function done(folder) {
  return Object.keys(folder).filter((path) => path.endsWith(".true.nc")).join(", ");
}
