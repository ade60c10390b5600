// SPDX-License-Identifier: GPL-3.0-or-later
// Words of the field, explained where they stand: a dotted word opens its meaning on a tap, a click, Enter or a pointer at rest.
import {h} from "./dom.js";

const MEANINGS = {
  "map": "A table of how far off the machine is at each place of the bed. With it programs can be " +
         "rewritten so that they are cut accurately.",
  "compensate": "To rewrite a program's moves by the map, so that the unchanged machine cuts what " +
                "was drawn.",
  "sled": "The plate with the router on it, which hangs from the chains and slides over the sheet.",
  "sprocket": "The toothed wheel on a motor that the chain runs over.",
  "chain's zero": "The length that the controller assumes for a chain: wrong if the chain was " +
                  "hung one link off.",
  "chain zeros": "The lengths that the controller assumes for the chains: wrong if a chain was " +
                 "hung one link off.",
  "motor positions": "Where the motors' shafts are, counted from the middle of the sheet.",
  "1 sigma": "Two of three measurements are within this of the true value.",
  "ring": "The ring on the sled that the chains' ends run along.",
  "middle lines": "The two lines through the middle of the sheet, one along it and one across. Places count from where they cross.",
  "hook": "The metal end of a tape. It has play, and its own thickness is in what you read.",
  "anchor": "The post at a corner of the frame where a belt begins.",
  "anchors": "The posts at the corners of the frame where the belts begin.",
  "visit": "One stop at a mark; they count in the order in which the machine went there.",
  "probability": "How sure the cause is, from these readings alone.",
  "scale": "The size of everything. Belts that are all too long by one share make a frame that is too large, and nothing contradicts it.",
};

const PATTERN = new RegExp(`\\b(${Object.keys(MEANINGS).sort((one, other) => other.length - one.length).join("|")})\\b`);
/** From the screen's edge. */
const MARGIN_PX = 8;

/** The meaning that is shown. It stands outside of the sentences, so that these can be copied as they are. */
const tip = h("div", {class: "meaning", "aria-hidden": "true", hidden: true});
/** For screen readers: a button is described by its word's meaning, which need not be visible. */
const all = h("div", {hidden: true}, Object.entries(MEANINGS).map(([of, meaning]) => h("span", {id: idOf(of)}, meaning)));
let shown = null;

function idOf(of) {
  return `meaning-${of.replace(/\W/g, "-")}`;
}

function hide() {
  shown?.setAttribute("aria-expanded", "false");
  shown = null;
  tip.hidden = true;
}

function show(button, of) {
  hide();
  tip.textContent = MEANINGS[of];
  tip.hidden = false;
  shown = button;
  button.setAttribute("aria-expanded", "true");
  const {left, bottom} = button.getBoundingClientRect();
  const most = document.documentElement.clientWidth - tip.offsetWidth - MARGIN_PX;
  tip.style.left = `${scrollX + Math.max(MARGIN_PX, Math.min(left, most))}px`;
  tip.style.top = `${scrollY + bottom + 4}px`;
}

addEventListener("keydown", (event) => {
  if (event.key === "Escape") hide();
});
addEventListener("click", (event) => {
  if (shown && event.target !== shown) hide();
});

/** A dotted word with its meaning: on a click, on Enter, and while the pointer is over it. */
function word(of) {
  if (!all.isConnected) document.body.append(tip, all);
  const button = h("button", {type: "button", class: "word", "aria-expanded": "false", "aria-describedby": idOf(of),
    onclick: () => (shown === button && !button.matches(":hover") ? hide() : show(button, of)),
    onmouseenter: () => show(button, of), onmouseleave: hide, onblur: hide}, of);
  return button;
}

/** The nodes of a sentence: the first `most` words of the list in it are dotted. */
export function explained(sentence, most = 1) {
  const at = most > 0 ? PATTERN.exec(sentence) : null;
  if (!at) return [sentence];
  return [sentence.slice(0, at.index), word(at[1]), ...explained(sentence.slice(at.index + at[1].length), most - 1)];
}
