// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two outputs of the command: text, tables and G-code byte for byte; numbers of JSON and of charts within
// bounds.
import assert from "node:assert/strict";

/** Relative difference that another implementation of the C library's functions may cause. */
export const RELATIVE = 1e-9;
/** Absolute difference for rounded zeros: a millionth of a micrometre, of a hundredth of a percent. */
const ABSOLUTE = 1e-9;
/** The digits of a map's coefficients: the last one may be rounded to either side. */
const WRITTEN_DIGITS = 7;

const NUMBER = /-?\d+\.?\d*(?:[eE][-+]?\d+)?/g;
/** The hash of a text whose last digits differ is different. */
const withoutHashes = (text) => text.replace(/(?<![\w.])(?:[0-9a-f]{16}|[0-9a-f]{32}|[0-9a-f]{64})(?![\w.])/g, "(hash)");

/** Compares texts; reports the first lines that differ: a whole report is too long. */
export function assertSame(found, wanted, place) {
  if (found === wanted) return;
  const [a, b] = [found.split("\n"), wanted.split("\n")];
  const differing = a.findIndex((line, index) => line !== b[index]);
  const at = differing < 0 ? a.length : differing;
  assert.fail(`${place}: line ${at + 1} is ${JSON.stringify(a[at]?.slice(0, 300))}, natively ${JSON.stringify(b[at]?.slice(0, 300))}`);
}

/** A text without its numbers and line breaks: the breaks in lists of numbers depend on the digits. */
const wordsOf = (text) => text.replaceAll(NUMBER, "#").replaceAll(/#,\s+(?=#)/g, "#, ");

const decimalsOf = (text) => /^-?\d+\.(\d+)$/.exec(text)?.[1].length ?? 0;
const digitsOf = (text) => text.replace(/[eE].*/, "").replace(/^-?[0.]*/, "").replace(".", "").length;

/** Whether two texts are the same number rounded to neighbouring values of few digits. */
function isRoundedApart(a, b) {
  if (Math.max(digitsOf(a), digitsOf(b)) !== WRITTEN_DIGITS) return false;
  const step = 10 ** -Math.max(decimalsOf(a), decimalsOf(b));
  // A thousandth more, since the two are not exact in binary.
  return Math.abs(Number(a) - Number(b)) <= 1.001 * step;
}

/** Compares texts in which only numbers may differ, within the bounds; returns the largest difference. */
export function largestDifference(found, wanted, place) {
  const [a, b] = [withoutHashes(found), withoutHashes(wanted)];
  assertSame(wordsOf(a), wordsOf(b), place);
  const numbers = a.match(NUMBER) ?? [];
  let largest = {size: 0, place};
  for (const [order, {0: digits, index}] of [...b.matchAll(NUMBER)].entries()) {
    if (numbers[order] === digits || isRoundedApart(numbers[order], digits)) continue;
    const [is, was] = [Number(numbers[order]), Number(digits)];
    const size = Math.abs(is - was) / Math.abs(was);
    if (Math.abs(is - was) <= ABSOLUTE || size <= largest.size) continue;
    const line = b.slice(0, index).split("\n").length;
    largest = {size, place: `${place}: line ${line}: ${numbers[order]}, natively ${digits}`};
  }
  return largest;
}

export const isOfNumbers = (path) => /(\.json|\.html|\/results\.csv)$/.test(path);
/** A sweep's store of binary numbers; its readable results are compared in the reports. */
export const isOfBits = (path) => path.endsWith(".cells");
