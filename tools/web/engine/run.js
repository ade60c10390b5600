// SPDX-License-Identifier: GPL-3.0-or-later
// One run of the command: its words, the files it may read, and what comes of it.

const FOLDER = "/folder";

/** Text of a run's standard output or error; bytes come one at a time. */
function collector() {
  const bytes = [];
  return {
    take: (byte) => {
      if (byte !== null) bytes.push(byte & 0xff);
    },
    text: () => new TextDecoder().decode(new Uint8Array(bytes)),
  };
}

function isSame(a, b) {
  if (a === undefined || a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) {
    if (a[i] !== b[i]) return false;
  }
  return true;
}

function makeFolders(FS, path) {
  const parts = path.split("/").slice(0, -1);
  for (let i = 1; i <= parts.length; ++i) {
    const folder = `${FOLDER}/${parts.slice(0, i).join("/")}`;
    if (!FS.analyzePath(folder).exists) FS.mkdir(folder);
  }
}

function writeFiles(FS, files) {
  FS.mkdir(FOLDER);
  for (const [path, bytes] of Object.entries(files)) {
    makeFolders(FS, path);
    FS.writeFile(`${FOLDER}/${path}`, bytes);
  }
  FS.chdir(FOLDER);
}

/** The files that a run has written, by path; those that it left as they were are not among them. */
function writtenFiles(FS, before, folder = "", written = {}) {
  for (const name of FS.readdir(`${FOLDER}/${folder}`)) {
    if (name === "." || name === "..") continue;
    const path = folder + name;
    if (FS.isDir(FS.stat(`${FOLDER}/${path}`).mode)) {
      writtenFiles(FS, before, `${path}/`, written);
      continue;
    }
    const bytes = FS.readFile(`${FOLDER}/${path}`);
    if (!isSame(before[path], bytes)) written[path] = bytes;
  }
  return written;
}

/**
 * Runs the command in an instance of its own.
 * @param createChaintrue what emscripten's script defines
 * @param module the compiled WebAssembly.Module
 * @param words the command line without the command's name
 * @param files path -> Uint8Array, the folder that the command finds itself in
 * @param options onProgress(words); stdin (Uint8Array)
 * @returns {code, stdout, stderr, files}: the exit code, both texts, and the files written.
 * @throws what the engine died of; nothing of the folder is lost by that
 */
export async function run(createChaintrue, module, words, files, options = {}) {
  const out = collector();
  const err = collector();
  let code = null;
  let at = 0;
  const stdin = options.stdin ?? new Uint8Array();
  const instance = await createChaintrue({
    thisProgram: "chaintrue",
    noInitialRun: true,
    instantiateWasm: (imports, ready) => {
      WebAssembly.instantiate(module, imports).then((made) => ready(made, module));
      return {};
    },
    stdin: () => (at < stdin.length ? stdin[at++] : null),
    stdout: out.take,
    stderr: err.take,
    onProgress: options.onProgress,
    onExit: (status) => {
      code = status;
    },
    quit: (_status, reason) => {
      throw reason;
    },
  });
  writeFiles(instance.FS, files);
  try {
    instance.callMain(words);
  } catch (reason) {
    if (code === null) throw reason;
  }
  return {code, stdout: out.text(), stderr: err.text(), files: writtenFiles(instance.FS, files)};
}
