// SPDX-License-Identifier: GPL-3.0-or-later
// The page: an owner's evening in steps on one folder. The engine and the example are embedded as data.
import {XzReadableStream} from "xz-decompress";
import {Engine} from "../engine/engine.js";
import {decoded} from "./base85.js";
import {Belts} from "./belts.js";
import {Busy} from "./busy.js";
import {cutStep} from "./cut.js";
import {download, h} from "./dom.js";
import {filesStep} from "./files.js";
import {machineStep, mayReplace, openZip, replaceFolder} from "./machine.js";
import {measureStep} from "./measure.js";
import {Plotter} from "./plotter.js";
import {resultStep} from "./result.js";
import {Steps} from "./steps.js";
import {Storage} from "./storage.js";
import {Store} from "./store.js";
import {zipOf} from "./zip.js";

const STEPS = [["machine", "Machine"], ["measure", "Measure"], ["result", "Map and causes"], ["cut", "Cut"], ["files", "Files"]];

async function unpacked(id) {
  const bytes = decoded(document.getElementById(id).textContent.trim());
  return new Response(new XzReadableStream(new Blob([bytes]).stream())).arrayBuffer();
}

class Page {
  store = new Store();
  storage = new Storage((problem) => this.#say("storage", problem));
  busy = new Busy(() => this.engine.cancel());
  engine = null;
  example = null;
  #banners = {storage: h("p", {class: "banner", role: "alert", hidden: true}), problem: h("p", {class: "banner bad", role: "alert", hidden: true})};
  /** The last fit of the readings: {headline, sentences, tables, code}, or null. */
  fit = null;
  #steps = null;
  #undo = h("button", {type: "button", onclick: () => this.store.undo()}, "Undo");
  #redo = h("button", {type: "button", onclick: () => this.store.redo()}, "Redo");
  #zip = h("input", {type: "file", id: "zip", accept: ".zip", hidden: true, onchange: () => this.#opened()});

  alert(sentence) {
    this.#say("problem", sentence);
  }

  async begin() {
    this.example = JSON.parse(document.getElementById("example").textContent);
    this.belts = new Belts(this);
    this.plotter = new Plotter(this);
    this.machine = machineStep(this);
    const made = {machine: this.machine, measure: measureStep(this), result: resultStep(this), cut: cutStep(this), files: filesStep(this)};
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
    const tools = h("div", {class: "tools"}, this.#undo, this.#redo,
      h("button", {type: "button", onclick: () => download("my-machine.zip", zipOf(this.store.folder))}, "Download"),
      h("button", {type: "button", onclick: () => this.#zip.click()}, "Open"), this.#zip,
      h("button", {type: "button", onclick: () => mayReplace(this) && replaceFolder(this, {}, "machine")}, "Begin anew"));
    this.#zip.setAttribute("aria-label", "A zip that Download has made");
    document.querySelector("header").append(tools);
    document.querySelector("main").replaceChildren(this.#banners.storage, this.#banners.problem, this.busy.element, this.#steps.element);
  }

  #go(step) {
    this.#say("problem", null);
    this.store.show({step});
  }

  #changed() {
    const {folder, view} = this.store;
    this.#steps.update(view.step);
    this.#undo.disabled = !this.store.canUndo;
    this.#redo.disabled = !this.store.canRedo;
    this.storage.keep({folder, view});
  }

  #say(which, sentence) {
    const banner = this.#banners[which];
    banner.hidden = sentence === null;
    banner.textContent = sentence ?? "";
  }

  async #opened() {
    const [file] = this.#zip.files;
    this.#zip.value = "";
    if (!file || !mayReplace(this)) return;
    await openZip(this, new Uint8Array(await file.arrayBuffer()), (sentences) => this.#say("problem", sentences[0] ?? null));
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
