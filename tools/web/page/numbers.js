// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers to type into the controller, and whether the owner has typed them in. The folder's settings.ini is
// that memory: what the controller holds now, if other than when the map was measured.
import {DONE, printed, runVerb, sentenceList, sentencesOf} from "./command.js";
import {download, h, textOf} from "./dom.js";
import {inPage} from "./in_page.js";

const TYPED_IN = "settings.ini";

/** Of a verb that takes a map: what the controller holds now. */
export const settingsWords = (folder) => (folder[TYPED_IN] ? ["--settings", TYPED_IN] : []);

export const areTypedIn = (folder) => Boolean(folder[TYPED_IN]);

export class Numbers {
  #page;
  #outcome = h("div");
  #typed = h("div", {hidden: true});
  element = h("div", {}, this.#outcome, this.#typed);
  #drawn = null;
  #isShown = false;

  constructor(page) {
    this.#page = page;
  }

  /** The map is another one: the numbers shown are not its numbers. */
  clear() {
    this.#outcome.replaceChildren();
    this.#isShown = false;
  }

  update({folder}) {
    const typed = folder[TYPED_IN] ?? null;
    this.#outcome.hidden = typed !== null;
    this.#typed.hidden = typed === null;
    if (typed === null && !this.#isShown) this.#show();
    if (this.#drawn === typed) return;
    this.#drawn = typed;
    this.#typed.replaceChildren(...(typed === null ? [] : this.#memory(typed)));
  }

  #memory(bytes) {
    return [
      h("p", {class: "said", role: "status"}, "These numbers are in the controller. Programs are compensated, and new points are judged, " +
        "for the machine with these numbers."),
      printed(textOf(bytes), "Numbers in the controller"),
      h("p", {class: "hint"}, "Set new points now, to see that nothing was mistyped. To measure the whole bed again, download this " +
        `folder, begin anew and open ${TYPED_IN}.`),
      h("p", {class: "buttons"},
        h("button", {type: "button", onclick: () => download(TYPED_IN, bytes)}, `Download ${TYPED_IN}`),
        h("button", {type: "button", onclick: () => this.#page.store.change({[TYPED_IN]: null})}, "The controller has its old numbers")),
    ];
  }

  async #show() {
    this.#isShown = true;
    const result = await runVerb(this.#page, ["export", "groundcontrol", "map.json", "-o", TYPED_IN, "--force"]);
    if (!result) return;
    const bytes = result.files[TYPED_IN];
    if (result.code !== DONE || !bytes) {
      this.#outcome.replaceChildren(sentenceList(sentencesOf(result), {class: "said problem"}));
      return;
    }
    // The sentences on the command's own map for these numbers do not concern the page, which keeps one map.
    const sentences = sentencesOf(result).filter((sentence) => !sentence.includes("--map-after"));
    this.#outcome.replaceChildren(printed(textOf(bytes), "Numbers to type in"), sentenceList(sentences.map(inPage)),
      h("p", {}, "Type them in, and say so here once they are in: what is compensated for the old numbers comes out wrong with the new ones."),
      h("p", {class: "buttons"}, h("button", {type: "button", class: "main",
        onclick: () => this.#page.store.change({[TYPED_IN]: bytes})}, "I have typed them in")));
  }
}
