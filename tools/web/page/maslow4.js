// SPDX-License-Identifier: GPL-3.0-or-later
// A Maslow 4: from its log to belt lengths, anchors, and the lines to paste.
import {DONE, printed, runVerb, sentenceList, sentencesOf} from "./command.js";
import {h} from "./dom.js";
import {replaceFolder} from "./machine.js";

export class Maslow4 {
  element = h("section", {hidden: true});
  #page;

  constructor(page) {
    this.#page = page;
  }

  async open(name, bytes, say) {
    const read = await runVerb(this.#page, ["import", "maslow4", name, "-o", "belts.json"], {files: {[name]: bytes}});
    if (!read) return;
    if (read.code !== DONE) {
      say(sentencesOf(read), true);
      return;
    }
    const belts = {[name]: bytes, ...read.files};
    const fitted = await runVerb(this.#page, ["fit", "belts.json", "-o", "anchors.json"], {files: belts});
    if (!fitted) return;
    say([...sentencesOf(read), ...sentencesOf(fitted)], fitted.code !== DONE);
    if (fitted.code !== DONE) return;
    replaceFolder(this.#page, {...belts, ...fitted.files}, "machine");
  }

  async update() {
    const anchors = this.#page.store.folder["anchors.json"];
    this.element.hidden = !anchors;
    if (!anchors || this.shown === anchors) return;
    this.shown = anchors;
    const result = await runVerb(this.#page, ["export", "maslow4", "anchors.json"]);
    if (!result) return;
    this.element.replaceChildren(h("h2", {}, "Lines to paste into the Maslow 4"),
      result.stdout ? printed(result.stdout, "Lines to paste") : "", sentenceList(sentencesOf(result)));
  }
}
