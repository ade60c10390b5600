// SPDX-License-Identifier: GPL-3.0-or-later
// What the command wrote twice: text, tables and G-code equal to the byte; numbers of JSON and of a report's charts within bounds.
import assert from "node:assert/strict";

/** What other libraries of the C standard's functions may move a number by, of its size. */
export const RELATIVE = 1e-9;
/** What is zero but for rounding has no size of its own: a millionth of a micrometre, of a hundredth of a percent. */
const ABSOLUTE = 1e-9;
/** The digits that a map's coefficients are written with: the last of them may round to either side. */
const WRITTEN_DIGITS = 7;

const NUMBER = /-?\d+\.?\d*(?:[eE][-+]?\d+)?/g;
/** A hash over text whose last digits differ is another one. */
const withoutHashes = (text) => text.replace(/(?<![\w.])[0-9a-f]{16}(?![\w.])/g, "(hash)");

/** Equal texts, or the first lines that differ: the whole of a report is too long to be told. */
export function assertSame(found, wanted, place) {
  if (found === wanted) return;
  const [a, b] = [found.split("\n"), wanted.split("\n")];
  const differing = a.findIndex((line, index) => line !== b[index]);
  const at = differing < 0 ? a.length : differing;
  assert.fail(`${place}: line ${at + 1} is ${JSON.stringify(a[at]?.slice(0, 300))}, natively ${JSON.stringify(b[at]?.slice(0, 300))}`);
}

/** A text without its numbers; lists of these are broken into lines by their digits. */
const wordsOf = (text) => text.replaceAll(NUMBER, "#").replaceAll(/#,\s+(?=#)/g, "#, ");

const decimalsOf = (text) => /^-?\d+\.(\d+)$/.exec(text)?.[1].length ?? 0;
const digitsOf = (text) => text.replace(/[eE].*/, "").replace(/^-?[0.]*/, "").replace(".", "").length;

/** Whether two texts are one number, written in few digits, that was rounded to neighbours. */
function isRoundedApart(a, b) {
  if (Math.max(digitsOf(a), digitsOf(b)) !== WRITTEN_DIGITS) return false;
  const step = 10 ** -Math.max(decimalsOf(a), decimalsOf(b));
  // A thousandth more: the two are not exact in binary.
  return Math.abs(Number(a) - Number(b)) <= 1.001 * step;
}

/** Texts whose numbers alone may differ, and these within the bounds; the largest difference found. */
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
/** A sweep's own store, whose numbers are bits; what people read of it is compared in the reports. */
export const isOfBits = (path) => path.endsWith(".cells");
