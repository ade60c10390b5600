// SPDX-License-Identifier: GPL-3.0-or-later
// The command's sentences name its options and verbs; the page has boxes, ticks and steps for these.

/** The hook's tick sits above the table of distances. */
export const HOOK_LABEL = "from 100 mm";
export const HOOK_HELP = `Hold the tape's 100 mm mark to the hole, and tick "${HOOK_LABEL}" when you type.`;

const ON_SHEETS = [/fit with --hook-offset-mm 100/g, `tick "${HOOK_LABEL}" when you type`];
const OPTIONS = [
  [/, or enter the offset \(--hook-offset-mm\)\./g, `. ${HOOK_HELP}`],
  [/enter \d+ mm \(hook_offset_mm of the tape, or --hook-offset-mm\)/g, `tick "${HOOK_LABEL}" if the tape was held at its 100 mm mark`],
  [/--hook-offset-mm \d+/g, `the tick "${HOOK_LABEL}"`],
  [/--hook-offset-mm/g, `the tick "${HOOK_LABEL}"`],
  [/ \(older ones are slanted: --lengths belt_and_arm\)/g, " (older ones are slanted: choose that under \"How the log is read\")"],
  [/ \(--lengths belt_and_arm\)/g, " (choose that under \"How the log is read\")"],
  [/ \(--orientation\)/g, " (a frame on the floor: choose that under \"How the log is read\")"],
  [/--settings maslow\.yaml supplies them, with the arm and the heights\./g, "maslow.yaml supplies them, with the arm and the heights: paste it into the box too."],
  [/; --runs selects others\./g, ". Choose another under \"How the log is read\"."],
  [/: chaintrue diagnose of the same belts says whether they do, with anchors and sigmas that count it\./g,
    ": the causes say whether they do, and the lines to paste count it."],
  [/and add it to the file's "distances"/g, "and type it into the box \"A taped distance\""],
  [/, and enter it under distances/g, ", and type it into the box \"A taped distance\""],
  [/enter it under distances/g, "type it into the box \"A taped distance\""],
  [/ \(gcode compensate\)/g, ""],
  [/give its position with --home X,Y/g, "type above where it is"],
  [/ If you know that it is the chain, use --accept-class\./g, ""],
  [/To (find the cause of the remaining error|look for other causes), run chaintrue diagnose on the same belts\./g, "See the causes."],
  [/ or use --inches\b/g, " or choose inches above the table"],
  [/ \(chaintrue plan [^)]*\)/g, ""],
  [/Write the law to a file \(chaintrue diagnose --law\), measure other points, and diagnose these with it \(--effects\) to/g,
    "Keep the law as a cause of your own, measure other points, and find the cause again to"],
  [/: chaintrue fit finds them, and export plotter prints the lines\./g, "; they stand above."],
];

/** The sentence as the page says it. An option that is left has no place in the page: its bracket goes. */
export function inPage(sentence) {
  const said = OPTIONS.reduce((text, [pattern, words]) => text.replace(pattern, words), sentence);
  return said.replace(/ ?\([^()]*--[a-z][^()]*\)/g, "");
}

/** The same for a sheet to print, which is HTML. */
export const sheetInPage = (html) => html.replace(...ON_SHEETS);
