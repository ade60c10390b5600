// SPDX-License-Identifier: GPL-3.0-or-later
// The command as a package for other pages and for node. `createChaintrue` precedes this text.
import {freshInstance, runIn} from "./run.js";

const isNode = typeof process !== "undefined" && process.versions?.node !== undefined;

async function bytesOf(url) {
  if (!isNode) return (await fetch(url)).arrayBuffer();
  const {readFile} = await import("node:fs/promises");
  return readFile(url);
}

/** The command, ready to run: see chaintrue.d.ts. */
export async function load(wasm) {
  const bytes = wasm ?? await bytesOf(new URL("chaintrue.wasm", import.meta.url));
  const module = await WebAssembly.compile(bytes);
  return {
    run: async (words, files = {}, options = {}) => runIn(await freshInstance(createChaintrue, module), words, files, options),
  };
}
