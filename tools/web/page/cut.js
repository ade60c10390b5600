// SPDX-License-Identifier: GPL-3.0-or-later
// The fourth step: a program before and after.
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {contentOf, download, fileDrop, h, unreadable} from "./dom.js";
import {reportFrame} from "./frame.js";
import {areTypedIn, settingsWords} from "./numbers.js";

const PROGRAMS = [".nc", ".gcode", ".ngc", ".tap", ".cnc", ".txt"];
/** Programs that drive to the marks; they belong to the lists of marks. */
const SHEETS = ["marks.nc", "holes.nc", "lengths.nc", "five.nc"];
/** The task that a newer program supersedes. */
const TASK = "cut";

const isProgram = (path) => PROGRAMS.some((end) => path.toLowerCase().endsWith(end));

/** Why a file of this name cannot be added to the folder as a program; null if it can. */
function refusalOf(name, folder) {
  if (!isProgram(name)) return `${name} is not opened: a G-code program's name ends in ${PROGRAMS.slice(0, -1).join(", ")} or ${PROGRAMS.at(-1)}.`;
  if (name in folder && (SHEETS.includes(name) || name === "README.txt"))
    return `${name} is not opened: the machine's folder has a file of that name. Give the program another name.`;
  return null;
}

export function cutStep(page) {
  const said = h("div", {class: "said", role: "status"});
  const outcome = h("div");
  const none = h("p", {class: "hint"}, "There is no map yet: type readings in first.");
  const jobs = h("p", {class: "buttons"});
  const settings = h("p", {class: "hint"});
  const all = h("div", {hidden: true},
    h("section", {}, h("h2", {}, "Cut a part true"),
      h("p", {}, "The program is rewritten so that the machine as it is cuts what was drawn, and run " +
        "on a simulated controller before you get it."),
      settings,
      fileDrop("program", "Open a G-code program", PROGRAMS.join(","), "Or drop it here.", ([file]) => take(file)), jobs),
    said, outcome);

  /** Of several programs in sequence only the last is processed and shown. */
  let latest = 0;
  /** Whether numbers were typed in when the program that is shown was compensated. */
  let wereTypedIn = false;
  function begin() {
    page.engine.cancel((job) => job.supersede === TASK);
    outcome.replaceChildren();
    said.replaceChildren();
    return ++latest;
  }

  function say(sentences, isProblem) {
    said.className = isProblem ? "said problem" : "said";
    said.replaceChildren(sentenceList(sentences));
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
    const result = await runVerb(page, ["gcode", "compensate", name, "--map", "map.json", ...settingsWords(page.store.folder),
      "-o", names.truth, "--report", names.report, "--force"], {supersede: TASK});
    if (mine !== latest) return;
    if (!result) {
      say([`${name} was not compensated. Open it once more to try again.`], true);
      return;
    }
    const isDone = result.code === DONE;
    wereTypedIn = areTypedIn(page.store.folder);
    say(sentencesOf(result), !isDone);
    page.store.derive(result.files);
    if (isDone) show(names, result.files);
  }

  function show({name, truth, report}, files) {
    const verdict = h("div", {class: "said", role: "status"});
    outcome.replaceChildren(h("section", {}, h("h2", {}, name),
      h("p", {class: "buttons"},
        h("button", {type: "button", class: "main", onclick: () => download(truth, files[truth])}, `Download ${truth}`),
        h("button", {type: "button", onclick: () => verify(name, truth, verdict)}, "Verify it once more")),
      verdict,
      files[report] && reportFrame(`${name} before and after`, report, files[report], {onDownload: () => download(report, files[report])})));
  }

  async function verify(name, truth, verdict) {
    const result = await runVerb(page, ["gcode", "verify", name, truth, "--map", "map.json", ...settingsWords(page.store.folder)]);
    if (!result) return;
    verdict.className = result.code === DONE ? "said" : "said problem";
    verdict.replaceChildren(sentenceList([...result.stdout.split("\n").filter(Boolean), ...sentencesOf(result)]));
  }

  return {
    element: h("div", {}, none, all),
    update() {
      const {folder} = page.store;
      none.hidden = Boolean(folder["map.json"]);
      all.hidden = !folder["map.json"];
      settings.textContent = areTypedIn(folder) ? "It is for the controller with the numbers that you typed in (see Map and causes)."
        : "It is for the controller with the settings that it was measured with. If you have typed in the better numbers since, " +
          "say so under Map and causes.";
      if (outcome.firstChild && wereTypedIn !== areTypedIn(folder)) {
        begin();
        say(["The controller holds other numbers than this program was compensated for: compensate it again."], true);
      }
      const programs = Object.keys(folder).filter((path) => isProgram(path) && !SHEETS.includes(path) && !/\.(true\.nc|txt)$/i.test(path));
      jobs.replaceChildren(...programs.map((path) => h("button", {type: "button", onclick: () => compensate(path)}, `Compensate ${path}`)));
    },
  };
}
