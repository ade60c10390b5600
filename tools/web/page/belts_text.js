// SPDX-License-Identifier: GPL-3.0-or-later
// What an owner of four belts pastes: the settings, the log, or both in one text.

/** A line of a settings file: a key with its value, an item, a comment, or nothing. A log's lines begin with a bracket or hold one. */
const YAML_LINE = /^\s*(#.*|[A-Za-z_][\w/-]*:(\s[^{]*)?|- .*)?$/;
const SETTINGS_BEGIN = /^\s*MaslowKinematics:\s*$/m;

/** The two files in a pasted text: {yaml, log}; null for one that is not there. */
export function splitPasted(text) {
  const lines = text.replace(/\r/g, "").split("\n");
  if (!SETTINGS_BEGIN.test(text.replace(/\r/g, ""))) return {yaml: null, log: text.trim() === "" ? null : text};
  const log = lines.filter((line) => !YAML_LINE.test(line));
  return {yaml: `${lines.filter((line) => YAML_LINE.test(line)).join("\n")}\n`, log: log.length > 0 ? `${log.join("\n")}\n` : null};
}

/** Whether a text is of a Maslow 4 at all. */
export const isOfBelts = (text) => SETTINGS_BEGIN.test(text) || /CLBM:|\{\s*bl:/.test(text);

/** How many calibrations the log holds, by the command's list of them. */
export function runsIn(sentences) {
  const said = sentences.map((line) => /^The log holds (\d+) runs/.exec(line)).find(Boolean);
  return said ? Number(said[1]) : 0;
}
