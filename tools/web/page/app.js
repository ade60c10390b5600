// SPDX-License-Identifier: GPL-3.0-or-later
// The page: an owner's evening in steps on one folder. The engine and the example are embedded as data.
import {XzReadableStream} from "xz-decompress";
import {Engine} from "../engine/engine.js";
import {decoded} from "./base85.js";
import {Belts} from "./belts.js";
import {Busy} from "./busy.js";
import {cutStep} from "./cut.js";
import {sentenceList} from "./command.js";
import {download, fileButton, h} from "./dom.js";
import {filesPart} from "./files.js";
import {intake, takeDrops} from "./intake.js";
import {machineStep, mayReplace, replaceFolder} from "./machine.js";
import {measureStep} from "./measure.js";
import {Plotter} from "./plotter.js";
import {resultStep} from "./result.js";
import {Steps} from "./steps.js";
import {Storage} from "./storage.js";
import {Store} from "./store.js";
import {zipOf} from "./zip.js";

/** The same for all machines. */
const STEPS = [["machine", "Machine"], ["measure", "Measure"], ["result", "Result"], ["cut", "Programs"]];

async function unpacked(id) {
  const bytes = decoded(document.getElementById(id).textContent.trim());
  return new Response(new XzReadableStream(new Blob([bytes]).stream())).arrayBuffer();
}

class Page {
  store = new Store();
  storage = new Storage((problem) => {
    this.#unstored.hidden = problem === null;
    this.#unstored.textContent = problem ?? "";
  });
  busy = new Busy(() => this.engine.cancel());
  engine = null;
  example = null;
  #unstored = h("p", {class: "banner", role: "alert", hidden: true});
  #said = h("div", {class: "banner", role: "status", hidden: true});
  /** The last fit of the readings: {headline, sentences, tables, isWrong}, or null. */
  fit = null;
  #steps = null;
  #undo = h("button", {type: "button", onclick: () => this.store.undo()}, "Undo");
  #redo = h("button", {type: "button", onclick: () => this.store.redo()}, "Redo");
  #download = h("button", {type: "button", onclick: () => download("my-machine.zip", zipOf(this.store.folder))}, "Download");
  #anew = h("button", {type: "button", onclick: () => mayReplace(this) && (replaceFolder(this, {}, "machine"), this.say([]))}, "Begin anew");

  /** What was done with what the user gave, or why not; nothing takes it away. */
  say(sentences, isProblem = false) {
    this.#said.className = isProblem ? "banner bad" : "banner";
    this.#said.hidden = sentences.length === 0;
    this.#said.replaceChildren(sentenceList(sentences));
  }

  alert(sentence) {
    this.say([sentence], true);
  }

  async begin() {
    this.example = JSON.parse(document.getElementById("example").textContent);
    this.belts = new Belts(this);
    this.plotter = new Plotter(this);
    this.machine = machineStep(this);
    this.cut = cutStep(this);
    this.files = filesPart(this);
    const made = {machine: this.machine, measure: measureStep(this), result: resultStep(this), cut: this.cut};
    this.#steps = new Steps(STEPS.map(([id, label]) => [id, label, made[id]]), (step) => this.#go(step));
    this.#draw();
    this.#listenToKeys();
    const [source, wasm, kept] = await Promise.all([unpacked("worker"), unpacked("wasm"), this.storage.open()]);
    this.engine = await Engine.of(new TextDecoder().decode(source), wasm);
    if (kept) this.store.restore(kept);
    this.store.listen(() => this.#changed());
    this.#changed();
    document.body.dataset.ready = "true";
  }

  #draw() {
    document.querySelector("header").append(h("div", {class: "tools"}, this.#undo, this.#redo, this.#download,
      fileButton("any", "Open", "", (files) => intake(this, files)), this.#anew));
    document.querySelector("main").replaceChildren(this.#unstored, this.#said, this.busy.element, this.#steps.element, this.files.element);
    takeDrops(this);
  }

  #go(step) {
    this.say([]);
    this.store.show({step});
  }

  #changed() {
    const {folder, view} = this.store;
    this.#steps.update(view.step);
    this.files.update();
    this.#undo.hidden = !this.store.canUndo;
    this.#redo.hidden = !this.store.canRedo;
    this.#download.hidden = this.#anew.hidden = Object.keys(folder).length === 0;
    this.storage.keep({folder, view});
  }

  #listenToKeys() {
    document.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      if (key === "y" || event.shiftKey) this.store.redo();
      else this.store.undo();
    });
  }
}

const page = new Page();
page.begin().catch((problem) => {
  document.querySelector("main").replaceChildren(h("p", {class: "banner bad", role: "alert"},
    `This page cannot start in this browser (${problem.message}). It needs a browser of 2023 or later: Chromium, Chrome, Edge, Firefox or Safari.`));
});
