// SPDX-License-Identifier: GPL-3.0-or-later
// A verb of the command on the page's folder, and its messages.
import {NotFinished} from "../engine/engine.js";
import {h} from "./dom.js";

/** Exit codes of the command, as in docs and --help. */
export const DONE = 0;
export const CHECK_FAILED = 1;

/**
 * Runs a verb in the folder. The files that it wrote are in `files` of the answer, not yet in the folder.
 * @returns {code, stdout, stderr, files}, or null if it was stopped or died, with a message.
 */
export async function runVerb(page, words, {quiet = false, supersede, files = page.store.folder} = {}) {
  const task = quiet ? null : page.busy.begin(words.slice(0, 2).filter((word) => !word.includes(".")).join(" "));
  try {
    return await page.engine.run(words, files, {onProgress: (text) => task?.say(text), supersede});
  } catch (problem) {
    if (!(problem instanceof NotFinished)) throw problem;
    if (!problem.isCancelled) page.alert(problem.message);
    return null;
  } finally {
    task?.end();
  }
}

/** The messages of a run for the user, without the next command. */
export function sentencesOf(result) {
  return result.stderr.split("\n").filter((line) => line !== "" && !line.startsWith("Next: "));
}

/** The same for a run on a list: points named by number get their rows. */
export function sentencesAbout(list, result) {
  return sentencesOf(result).map((sentence) => list?.withRows(sentence) ?? sentence);
}

/** {place, text} of a problem with a file: `marks.csv: line 5, column 10: found ...`. */
export function problemOf(sentence, file) {
  if (!sentence.startsWith(`${file}: `)) return null;
  const text = sentence.slice(file.length + 2);
  const at = /^line (\d+)(?:, column (\d+))?: /.exec(text);
  if (at) return {line: Number(at[1]), column: Number(at[2] ?? 1), text: text.slice(at[0].length)};
  const pointer = /^(\/[^:]*): /.exec(text);
  return pointer ? {pointer: pointer[1], text: text.slice(pointer[0].length)} : {text};
}

export function sentenceList(sentences, properties = {}) {
  return h("ul", {class: "sentences", ...properties}, sentences.map((sentence) => h("li", {}, sentence)));
}

/** Text of a run that prints a table: its standard output. */
export function printed(text, label) {
  return h("pre", {tabindex: "0", "aria-label": label}, text);
}
