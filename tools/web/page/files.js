// SPDX-License-Identifier: GPL-3.0-or-later
// The folder's files, one by one, as the command wrote them.
import {download, h} from "./dom.js";

export function filesStep(page) {
  const rows = h("tbody");
  return {
    element: h("section", {}, h("h3", {}, "The folder"),
      h("p", {}, "Everything that this page knows of your machine. The buttons Download and Open above give and take it " +
        "as one zip; the command chaintrue works on the same files."),
      h("div", {class: "table-box"}, h("table", {}, h("thead", {}, h("tr", {}, h("th", {scope: "col"}, "file"),
        h("th", {scope: "col", class: "number"}, "bytes"), h("th", {scope: "col"}, ""))), rows))),
    given: () => {
      const count = Object.keys(page.store.folder).length;
      return count > 0 ? `${count} files` : "";
    },
    update() {
      const {folder, view} = page.store;
      if (view.step !== "files") return;
      rows.replaceChildren(...Object.keys(folder).sort().map((path) => h("tr", {}, h("th", {scope: "row"}, path),
        h("td", {class: "number"}, String(folder[path].length)),
        h("td", {}, h("button", {type: "button", onclick: () => download(path, folder[path])}, "Download"), ))));
    },
  };
}
