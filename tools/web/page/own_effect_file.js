// SPDX-License-Identifier: GPL-3.0-or-later
// A cause of the owner's own as the file that the command reads (docs/formats/effect.md).

/** What the formula's millimetres are added to, and how that is written for either chain. */
export const WHERE = {
  left: {words: "the left chain", sides: ["left"], of: (formula) => formula},
  right: {words: "the right chain", sides: ["right"], of: (formula) => formula},
  either: {words: "one chain or the other", sides: ["left", "right"], of: (formula) => formula},
  both: {words: "both chains alike", sides: ["both"], of: (formula) => formula},
  x: {words: "the tool, along x", sides: ["both"], of: (formula) => `side * cos(phi) * (${formula})`},
  y: {words: "the tool, along y", sides: ["both"], of: (formula) => `-sin(phi) * (${formula})`},
};

/** Places that a formula may have besides its size, with what they may be. */
const PLACES = {phase_rad: 6.3, place_rad: 1.57, place_mm: 6000, place_n: 1000};
const nameOf = (words) => words.trim().toLowerCase().replace(/[^a-z0-9]+/g, "_").replace(/^_+|_+$/g, "") || "my_cause";
const numberOf = (text) => Number(text.trim().replace(",", "."));

/** The file of the effect that the form describes. */
export function effectOf({name, where, formula, size, place}) {
  const usual = numberOf(size);
  const bound = Math.max(10, 10 * Math.abs(usual));
  const named = Object.keys(PLACES).find((one) => new RegExp(`\\b${one}\\b`).test(formula));
  const parameters = [{name: "size_mm", symbol: "a", meaning: "how large it is", null: 0, nominal: usual, prior_sigma: Math.max(Math.abs(usual), 0.05), lower: -bound, upper: bound}];
  if (named) {
    const most = PLACES[named];
    parameters.push({name: named, symbol: "p", meaning: "where it sets in", role: "place", nominal: numberOf(place || "0"), prior_sigma: most / 2, lower: -most, upper: most});
  }
  return {
    file_type: "chaintrue_effect", format_version: "1.0", id: nameOf(name), acts_on: "chain", sides: WHERE[where].sides, parameters,
    adds_mm: WHERE[where].of(formula.trim()), cause: name.trim() || "a cause of your own", remedy: "look for what does this",
    not_modelled: "deviations from this form",
  };
}
