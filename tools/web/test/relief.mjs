// SPDX-License-Identifier: GPL-3.0-or-later
// A long program.

/** A relief in straight moves of half a millimetre, of at least that many bytes. */
export function reliefOf(bytes) {
  const lines = ["G21 G90 G17 G94", "G0 Z5", "G0 X-400 Y-300", "G1 Z-1 F800"];
  let length = 0;
  for (let row = 0; length < bytes; ++row) {
    const y = -300 + row * 0.5;
    for (let step = 0; step <= 1600 && length < bytes; ++step) {
      const x = (row % 2 === 0 ? -400 : 400) + (row % 2 === 0 ? 0.5 : -0.5) * step;
      const line = `G1 X${x.toFixed(1)} Y${y.toFixed(1)} Z${(-1 - Math.sin(x / 20) * Math.cos(y / 20)).toFixed(3)}`;
      lines.push(line);
      length += line.length + 1;
    }
  }
  return `${[...lines, "G0 Z5", "M2"].join("\n")}\n`;
}
