// SPDX-License-Identifier: GPL-3.0-or-later
// A page written by the command, in a frame: it can run its charts, but reach neither this page nor a network.
import {DONE, runVerb, sentenceList, sentencesOf} from "./command.js";
import {download, h, textOf} from "./dom.js";

/** Reports the frame's height, and prints on request: the frame has no origin, so only messages can be exchanged. */
const INSIDE = `<script>
new ResizeObserver(() => parent.postMessage({chaintrueHeight: document.documentElement.getBoundingClientRect().height}, "*"))
  .observe(document.documentElement);
addEventListener("message", (event) => { if (event.data === "chaintrue print") print(); });
</script>`;

const frames = new Set();
addEventListener("message", (event) => {
  for (const frame of frames) {
    if (frame.contentWindow !== event.source) continue;
    const height = Number(event.data?.chaintrueHeight);
    if (height > 0) frame.style.height = `${Math.ceil(height)}px`;
  }
});

/** A page of the command by itself. `title` names it to a screen reader. */
export function drawingFrame(title, bytes) {
  const frame = h("iframe", {title, sandbox: "allow-scripts allow-modals", class: "report"});
  frame.srcdoc = textOf(bytes) + INSIDE;
  for (const other of frames) if (!other.isConnected) frames.delete(other);
  frames.add(frame);
  return frame;
}

/** The same with buttons. */
export function reportFrame(title, name, bytes, {onDownload}) {
  const frame = drawingFrame(title, bytes);
  return h("div", {class: "framed"},
    h("p", {class: "buttons"},
      h("button", {type: "button", onclick: () => frame.contentWindow.postMessage("chaintrue print", "*")}, "Print"),
      h("button", {type: "button", onclick: () => onDownload(name)}, `Download ${name}`)),
    frame);
}

/** The command's report on a file of the folder, in a frame in `box`. */
export async function report(page, from, to, title, box) {
  const result = await runVerb(page, ["report", from, "-o", to, "--force"]);
  if (!result) return;
  if (result.code !== DONE) {
    box.replaceChildren(sentenceList(sentencesOf(result), {class: "said problem"}));
    return;
  }
  page.store.derive(result.files);
  const bytes = result.files[to];
  box.replaceChildren(reportFrame(title, to, bytes, {onDownload: () => download(to, bytes)}));
}
