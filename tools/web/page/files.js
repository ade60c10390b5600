// SPDX-License-Identifier: GPL-3.0-or-later
// The folder's files, one by one, as the command wrote them.
import {download, folded, h} from "./dom.js";

export function filesPart(page) {
  const rows = h("tbody");
  const part = folded("All files of this machine", (box) => {
    box.append(h("p", {}, "The command chaintrue works on the same files. The button Download above gives all of them as one zip."),
      h("div", {class: "table-box"}, h("table", {}, rows)));
    draw();
  });
  function draw() {
    const {folder} = page.store;
    rows.replaceChildren(...Object.keys(folder).sort().map((path) => h("tr", {}, h("th", {scope: "row"}, path),
      h("td", {class: "number"}, `${folder[path].length} bytes`),
      h("td", {}, h("button", {type: "button", onclick: () => download(path, folder[path])}, "Download")))));
  }
  return {element: part.element, update: () => {
    part.element.hidden = Object.keys(page.store.folder).length === 0;
    if (part.element.open) draw();
  }};
}
