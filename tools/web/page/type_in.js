// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers for the machine: its own label, old and new value, a button to copy each, and the tick that says they are in.
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {bytesOf, h, textOf} from "./dom.js";
import {ANCHORS, BELTS, filledIn, FOUND, HOLES, isBelts, isPlotter, jsonOf, PASTED} from "./folder.js";
import {inPage} from "./in_page.js";

const TYPED_IN = "settings.ini";
/** GroundControl's and WebControl's labels of their settings. */
const LABELS = {
  motorspacingx: "Distance Between Motors", motoroffsety: "Motor Offset Height in MM", rotationradius: "Rotation Radius for Triangular Kinematics",
  chainsagcorrection: "Chain Sag Correction Value for Triangular Kinematics", leftchaintolerance: "Chain Tolerance, Left Chain",
  rightchaintolerance: "Chain Tolerance, Right Chain", topbeamtilt: "Top Beam Tilt", sledwidth: "Distance Between Sled Mounting Points",
  sledheight: "Vertical Distance Sled Mounts to Cutter", sledcg: "Center Of Gravity", chainoversprocket: "Top/Bottom Chain Feed", kinematicstype: "Kinematics Type",
};
const CORNERS = {tl: "Top left", tr: "Top right", bl: "Bottom left", br: "Bottom right"};

/** For a verb that takes a map: what the controller holds now. */
export const settingsWords = (folder) => (folder[TYPED_IN] ? ["--settings", TYPED_IN] : []);
export const areIn = ({folder, view}) => (isPlotter(folder) ? Boolean(view.typed) : Boolean(folder[isBelts(folder) ? PASTED : TYPED_IN]));

/** The anchors with the causes taken off, or those that holes were fitted with. */
const sourceOf = (folder) => (isPlotter(folder) ? FOUND : !isBelts(folder) ? "map.json"
  : (jsonOf(folder["diagnosis.json"])?.causes ?? []).length > 0 && filledIn(folder[HOLES]) === 0 ? "diagnosis.json" : ANCHORS);

/** {rows: [{label, now, will, copy}], sentences, files} of an export. */
function rowsOf(folder, {stdout, stderr}) {
  if (isBelts(folder)) {
    const {machine} = jsonOf(folder[BELTS]);
    return stdout.split("\n").map((line) => /\/([tb][lr])([XYZ])=(-?[\d.]+)$/.exec(line)).filter(Boolean).map(([, corner, axis, will]) => ({
      label: `${CORNERS[corner]} ${axis}`, now: machine.anchors?.[corner]?.[`${axis.toLowerCase()}_mm`]?.toFixed(2), will, copy: `$/kinematics/MaslowKinematics/${corner}${axis}=${will}`}));
  }
  if (isPlotter(folder)) {
    const old = Object.keys(folder).filter((path) => /\.(txt|h|properties|ya?ml)$/.test(path)).flatMap((path) => textOf(folder[path]).split("\n"));
    return stdout.split("\n").filter((line) => line.trim() !== "").map((line) => {
      const label = /^(.*?[:=]|\S+)\s*/.exec(line.trim())[0];
      const was = old.find((one) => one.trim().startsWith(label));
      return {label: label.replace(/[:=]\s*$/, ""), now: was?.trim().slice(label.length), will: line.trim().slice(label.length), copy: line.trim()};
    });
  }
  return stderr.split("\n").map((line) => /^(\S+) changes from (\S+) to ([-\d.]+)/.exec(line)).filter(Boolean)
    .map(([, key, now, will]) => ({label: LABELS[key] ?? key, now, will, copy: will}));
}

const wordsOf = (folder) => (isBelts(folder) ? ["maslow4", sourceOf(folder)] : isPlotter(folder) ? ["plotter", FOUND]
  : ["groundcontrol", "map.json", "-o", TYPED_IN, "--force"]);

/** What there is to type in; null where the command was stopped. `leaves` is the error that it leaves, mm, where the command says it. */
export async function numbersOf(page) {
  const {folder} = page.store;
  const result = await runVerb(page, ["export", ...wordsOf(folder)], {quiet: true, supersede: "numbers"});
  if (!result || page.store.folder[sourceOf(folder)] !== folder[sourceOf(folder)]) return null;
  const sentences = sentencesOf(result);
  const about = sentences.find((line) => line.startsWith("With today's settings"));
  return {
    isWrong: result.code !== DONE, rows: result.code === DONE ? rowsOf(folder, result) : [], file: result.files?.[TYPED_IN],
    leaves: Number(/with these numbers ([\d.]+)/.exec(about)?.[1] ?? NaN),
    sentences: sentences.filter((line) => !/ changes from \S+ to |^With today's settings|--map-after/.test(line)).map(inPage),
  };
}

const negative = ({rows}) => rows.filter(({label, will}) => label.includes("Tolerance") && Number(will) < 0).map(({label, will}) =>
  `${label} becomes ${will}: a chain shorter than a new one. Check the tape or the square that you measured with before you type this in.`);

function copyButton(words, text) {
  const button = h("button", {type: "button", class: "small", onclick: async () => {
    button.textContent = await navigator.clipboard?.writeText(text).then(() => "Copied", () => "Select and copy") ?? "Select and copy";
  }}, words);
  return button;
}

/** The tick that switches the map. `file` is a controller's settings with the numbers. */
export function typedTick(page, {file}) {
  const tick = h("input", {type: "checkbox", class: "typed", checked: areIn(page.store), onchange: () => setTyped(page, tick.checked, file)});
  return h("p", {}, h("label", {class: "pair"}, tick, "I have typed these in"));
}

function setTyped(page, is, file) {
  const {folder} = page.store;
  if (isPlotter(folder)) return page.store.show({typed: is});
  if (!isBelts(folder)) return page.store.change({[TYPED_IN]: is ? file ?? null : null});
  const machine = jsonOf(folder[sourceOf(folder)]).belts?.machine;
  return page.store.change({[PASTED]: is ? machine ? bytesOf(`${JSON.stringify({...jsonOf(folder[BELTS]), machine}, null, 2)}\n`) : folder[sourceOf(folder)] : null});
}

export function typeInPart(page, numbers) {
  const {rows, sentences, isWrong} = numbers;
  if (isWrong || rows.length === 0) return h("div", {class: isWrong ? "said bad" : ""}, sentenceList(sentences));
  const warnings = negative(numbers);
  return h("div", {}, warnings.length > 0 && h("div", {class: "said caution"}, sentenceList(warnings)),
    h("div", {class: "table-box"}, h("table", {class: "changes"}, h("thead", {}, h("tr", {}, ["setting", "now", "new", ""].map((title) => h("th", {scope: "col"}, title)))),
      h("tbody", {}, rows.map(({label, now, will, copy}) => h("tr", {}, h("th", {scope: "row"}, label), h("td", {class: "number"}, now ?? ""), h("td", {class: "number"}, h("b", {}, will)), h("td", {}, copyButton("Copy", copy))))))),
    rows.every(({now}) => now === undefined) && h("p", {class: "hint"}, "The machine's present numbers are not known. Open its settings as well, and they stand here."),
    h("p", {class: "buttons"}, copyButton("Copy all", rows.map(({label, copy}) => (copy.includes(label) || /[$=:]/.test(copy) ? copy : `${label}: ${copy}`)).join("\n"))),
    sentenceList(sentences), typedTick(page, numbers));
}
