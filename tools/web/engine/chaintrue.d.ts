// SPDX-License-Identifier: GPL-3.0-or-later

/** Files of a folder by their path, as in {"my-machine/machine.json": bytes}. */
export type Files = Record<string, Uint8Array>;

export interface Result {
  /** The command's exit code: 0 done, 1 a check failed, 2 usage, 3 bad input, 4 not supported or outside, 5 internal. */
  code: number;
  stdout: string;
  stderr: string;
  /** The files that this run has written. */
  files: Files;
}

export interface Options {
  /** Standard input, read by `-`. */
  stdin?: Uint8Array;
  /** Called during long work, at most ten times a second: "diagnose: 3 s, step 2 of 5, ...". */
  onProgress?: (words: string) => void;
}

export interface Chaintrue {
  /** Runs the command with these words in a folder of these files. Rejects only if the engine itself fails. */
  run(words: string[], files?: Files, options?: Options): Promise<Result>;
}

/** The command, compiled once; `wasm` is chaintrue.wasm if it is not next to chaintrue.mjs. */
export function load(wasm?: ArrayBuffer | Uint8Array): Promise<Chaintrue>;
