// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes that the page contains as text.
import assert from "node:assert/strict";
import {test} from "node:test";
import {decoded, encoded} from "../page/base85.js";

test("bytes come back from text, whatever their number", () => {
  for (let length = 0; length <= 9; ++length) {
    for (const fill of [() => 0, () => 255, (i) => (i * 73 + 19) % 256]) {
      const bytes = Uint8Array.from({length}, (_, i) => fill(i));
      const text = encoded(bytes);
      assert.deepEqual(decoded(text), bytes, `${bytes} as ${text}`);
      assert.equal(text.length, Math.ceil(length * 5 / 4), "five characters for four bytes");
    }
  }
});

test("the text holds nothing that a page would read as its own", () => {
  const every = Uint8Array.from({length: 4 * 65536}, (_, i) => (Math.imul(i, 2654435761) >>> 13) % 256);
  assert.match(encoded(every), /^[!-~]+$/);
  assert.doesNotMatch(encoded(every), /[<>&"'`\\@-]/);
});
