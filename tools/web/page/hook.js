// SPDX-License-Identifier: GPL-3.0-or-later
// The tick for a tape that was held at its 100 mm mark: every reading is longer by that.
import {h} from "./dom.js";
import {fittedList, HOLES} from "./folder.js";
import {HOOK_LABEL} from "./in_page.js";

/** Of a verb that takes distances. */
export const hookOption = ({view}) => (view.hook ? ["--hook-offset-mm", "100"] : []);
/** The same of a verb that takes the list that is fitted: no other list knows of a tape. */
export const hookWords = (store) => (fittedList(store.view) === HOLES ? hookOption(store) : []);

export function hookTick(page) {
  const tick = h("input", {type: "checkbox", id: "hook", onchange: () => page.store.show({hook: tick.checked})});
  const element = h("span", {class: "pair"}, tick, h("label", {for: "hook"}, HOOK_LABEL),
    h("span", {class: "hint"}, "the tape's 100 mm mark was held to the hole, not its hook"));
  return {
    element,
    update({view}) {
      element.hidden = view.sheet !== HOLES;
      tick.checked = Boolean(view.hook);
    },
  };
}
