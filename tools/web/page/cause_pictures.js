// SPDX-License-Identifier: GPL-3.0-or-later
// What a cause does, as a picture of the bed: where it alone would put the tool, and what new numbers leave of it.
import {DONE, runVerb} from "./command.js";
import {bedOf} from "./folder.js";
import {errorPicture} from "./picture.js";

/** A cause at the size that was found, or at its usual one. */
function sizesOf({causes}, {effect, side}) {
  const found = causes?.find((one) => one.effect === effect && one.side === side);
  return Object.entries(found?.parameters ?? {}).map(([name, {value}]) => `${name}=${value}`);
}

/**
 * The picture of a hypothesis, by the command that explains effects; null for what has none, such as bad readings.
 * @param name the cause in words
 */
export async function causePicture(page, found, hypothesis, name) {
  const {folder} = page.store;
  const bed = bedOf(folder);
  const {effect, side} = hypothesis;
  if (!bed || !folder["machine.json"] || !/^[a-z_0-9]+$/.test(effect)) return null;
  const sizes = sizesOf(found, hypothesis);
  const words = ["effects", effect, "--machine", "machine.json", "--json", ...(side ? ["--side", side] : []), ...sizes.flatMap((size) => ["--set", size])];
  const result = await runVerb(page, words, {quiet: true});
  if (result?.code !== DONE) return null;
  const {marks} = JSON.parse(result.stdout);
  return errorPicture(bed, marks, ({as_stated_mm: error}) => error, ({calibrated_mm: error}) => error, {
    label: `The bed with two arrows at each place: where ${name} alone puts the tool, and what new numbers leave of it.`,
    before: `what this alone does${sizes.length > 0 ? "" : ", at its usual size"}`, after: "what new numbers leave of it",
  });
}
