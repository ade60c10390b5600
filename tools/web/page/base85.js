// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes as text of a script element: four bytes in five characters; base64 has three in four.

/** The printable characters except space, at sign and those with a meaning in HTML or in a JavaScript string. */
const DIGITS = Array.from({length: 94}, (_, i) => String.fromCharCode(33 + i)).filter((one) => !"<>&\"'`\\@-".includes(one)).join("");
const BASE = DIGITS.length;

/** A last group that is n bytes short is n characters short. */
export function encoded(bytes) {
  let text = "";
  for (let at = 0; at < bytes.length; at += 4) {
    let rest = 0;
    for (let i = 0; i < 4; ++i) rest = rest * 256 + (bytes[at + i] ?? 0);
    let group = "";
    for (let i = 0; i < 5; ++i, rest = Math.floor(rest / BASE)) group = DIGITS[rest % BASE] + group;
    text += group.slice(0, 1 + Math.min(4, bytes.length - at));
  }
  return text;
}

/** The inverse of `encoded`. */
export function decoded(text) {
  const values = new Uint8Array(128);
  for (let digit = 0; digit < BASE; ++digit) values[DIGITS.charCodeAt(digit)] = digit;
  const bytes = new Uint8Array(Math.floor(text.length * 4 / 5));
  for (let from = 0, to = 0; from < text.length; from += 5, to += 4) {
    let group = 0;
    // Missing characters count as the largest digit, so that the bytes before them keep their values.
    for (let i = 0; i < 5; ++i) group = group * BASE + (from + i < text.length ? values[text.charCodeAt(from + i)] : BASE - 1);
    for (let i = 0; i < 4 && to + i < bytes.length; ++i) bytes[to + i] = group >>> (24 - 8 * i);
  }
  return bytes;
}
