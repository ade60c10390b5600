// SPDX-License-Identifier: GPL-3.0-or-later
// The command off the page's own thread. `createChaintrue` stands before this text in the worker's source.
//   {wasm: ArrayBuffer}                            once, before anything else
//   {id, words, files} -> {id, progress} ... then {id, result} or {id, crashed}
import {run} from "./run.js";

let compiled = null;

self.onmessage = async ({data}) => {
  if (data.wasm) {
    compiled = WebAssembly.compile(data.wasm);
    return;
  }
  const {id, words, files} = data;
  try {
    const onProgress = (progress) => self.postMessage({id, progress});
    const result = await run(self.createChaintrue, await compiled, words, files, {onProgress});
    self.postMessage({id, result});
  } catch (reason) {
    self.postMessage({id, crashed: String(reason?.message ?? reason)});
  }
};
