// SPDX-License-Identifier: GPL-3.0-or-later
// The command's sentences on a fit, told apart.

/** The two numbers, the sentences besides, and the tables of --verbose: they follow, and begin with the settings. */
export function fitParts(sentences) {
  const end = sentences.findIndex((line) => /^Settings {3,}/.test(line));
  const plain = end < 0 ? sentences : sentences.slice(0, end);
  const isHeadline = (line) => /^Your machine (misses|needs)\b/.test(line);
  return {headline: plain.find(isHeadline) ?? null, sentences: plain.filter((line) => !isHeadline(line)), tables: end < 0 ? [] : sentences.slice(end)};
}
