// SPDX-License-Identifier: GPL-3.0-or-later
// The fourth step: a program before and after.
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {download, fileDrop, h} from "./dom.js";
import {reportFrame} from "./frame.js";

const PROGRAMS = ".nc,.gcode,.ngc,.tap,.cnc,.txt";

export function cutStep(page) {
  const said = h("div", {class: "said", role: "status"});
  const outcome = h("div");
  const none = h("p", {class: "hint"}, "There is no map yet: type readings in first.");
  const jobs = h("p", {class: "buttons"});
  const all = h("div", {hidden: true},
    h("section", {}, h("h2", {}, "Cut a part true"),
      h("p", {}, "The program is rewritten so that the machine as it is cuts what was drawn, for the controller and the " +
        "settings that it was measured with. It is run on a simulated controller before you get it."),
      fileDrop("program", "Open a G-code program", PROGRAMS, "Or drop it here.", ([file]) => take(file)), jobs),
    said, outcome);

  async function take(file) {
    const name = file.name.replace(/[^\w.-]/g, "_");
    page.store.change({[name]: new Uint8Array(await file.arrayBuffer())});
    await compensate(name);
  }

  async function compensate(name) {
    const stem = name.replace(/\.[^.]*$/, "");
    const names = {name, truth: `${stem}.true.nc`, report: `${stem}.html`};
    outcome.replaceChildren();
    said.replaceChildren();
    const result = await runVerb(page, ["gcode", "compensate", name, "--map", "map.json", "-o", names.truth, "--report", names.report, "--force"]);
    if (!result) return;
    const isDone = result.code === DONE;
    said.className = isDone ? "said" : "said problem";
    said.replaceChildren(sentenceList(sentencesOf(result)));
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
    const result = await runVerb(page, ["gcode", "verify", name, truth, "--map", "map.json"]);
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
      const programs = Object.keys(folder).filter((path) => /\.(nc|gcode|ngc|tap|cnc)$/i.test(path) && !/\.true\.nc$/.test(path) &&
        !["marks.nc", "holes.nc", "lengths.nc", "five.nc"].includes(path));
      jobs.replaceChildren(...programs.map((path) => h("button", {type: "button", onclick: () => compensate(path)}, `Compensate ${path}`)));
    },
  };
}
