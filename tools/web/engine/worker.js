// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the command outside the page's thread. `createChaintrue` precedes this text in the worker's source.
//   {module: WebAssembly.Module}                   once, before anything else
//   {id, words, files} -> {id, progress} ... then {id, result}, {id, crashed}, or {id, starved} without the memory to
//                         begin with
import {freshInstance, runIn} from "./run.js";

let module = null;
/** The instance for the next run, made in advance after each run. */
let next = null;

function prepare() {
  next = freshInstance(self.createChaintrue, module);
  // The error is reported when the promise is awaited.
  next.catch(() => {});
}

self.onmessage = async ({data}) => {
  if (data.module) {
    module = data.module;
    prepare();
    return;
  }
  const {id, words, files} = data;
  const why = (reason) => String(reason?.message ?? reason);
  let fresh = null;
  try {
    fresh = await next;
  } catch (reason) {
    self.postMessage({id, starved: why(reason)});
    return;
  }
  try {
    const result = runIn(fresh, words, files, {onProgress: (progress) => self.postMessage({id, progress})});
    self.postMessage({id, result});
    prepare();
  } catch (reason) {
    self.postMessage({id, crashed: why(reason)});
  }
};
