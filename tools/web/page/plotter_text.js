// SPDX-License-Identifier: GPL-3.0-or-later
// Distinguishes a V-plotter's files from a router's.

/** Marlin's M665 or Configuration.h, Polargraph's properties, a mural's three numbers. FluidNC's yaml may be of a router. */
const SETTINGS = /\bM665\s+[A-Z]|#define\s+POLARGRAPH|^machine\.motors\.mmPerRev=|^\s*top distance:/m;
const OURS = /"chaintrue_(plotter|drawing)"/;

/** Whether a text is of a V-plotter and of nothing else. */
export const isOfPlotter = (text) => (/^\s*\{/.test(text) ? OURS.test(text) : SETTINGS.test(text));
export const isDrawingText = (text) => /^\s*\{/.test(text) && text.includes('"chaintrue_drawing"');
/** FluidNC's WallPlotter, which hangs a router or a pen. */
export const isWallPlotter = (text) => /^\s*WallPlotter:/m.test(text);

/** "the length A-B", "the bow of A-B at E" of a measure. */
export const wordsOf = ({kind, from, to, middle}) => (kind === "bow" ? `bow of ${from}\u2013${to} at ${middle}` : `length ${from}\u2013${to}`);

const READS_GCODE = ["fluidnc", "marlin"];
/** A mural and a Polargraph are sent pictures. */
export const readsGcode = (drawing) => READS_GCODE.includes(drawing?.set?.firmware);

/** A ruler's number as it was typed: null for nothing, the text itself where it is none. */
export function millimetresTyped(text) {
  const trimmed = text.trim().replace(",", ".").replace("\u2212", "-");
  if (trimmed === "") return null;
  const value = Number(trimmed);
  return Number.isFinite(value) ? value : text.trim();
}
