// SPDX-License-Identifier: GPL-3.0-or-later
// One run of the command in a fresh instance: its words, its input files, and its results.

const FOLDER = "/folder";
/** Modification time of a run's input files; files that it writes have today's. */
const GIVEN = 0;

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
    FS.utime(`${FOLDER}/${path}`, GIVEN, GIVEN);
  }
  FS.chdir(FOLDER);
}

/** The files that a run has written, by path, changed or not; without files that it only read. */
function writtenFiles(FS, folder = "", written = {}) {
  for (const name of FS.readdir(`${FOLDER}/${folder}`)) {
    if (name === "." || name === "..") continue;
    const path = folder + name;
    const {mode, mtime} = FS.stat(`${FOLDER}/${path}`);
    if (FS.isDir(mode)) writtenFiles(FS, `${path}/`, written);
    else if (mtime.getTime() !== GIVEN) written[path] = FS.readFile(`${FOLDER}/${path}`);
  }
  return written;
}

/**
 * A fresh instance of the command. It runs once: its memory is released with it.
 * @param createChaintrue the function that emscripten's script defines
 * @param module the compiled WebAssembly.Module
 * @throws if the browser has not enough memory
 */
export function freshInstance(createChaintrue, module) {
  const fresh = {out: collector(), err: collector(), stdin: new Uint8Array(), code: null, instance: null};
  let at = 0;
  return new Promise((resolve, reject) => {
    createChaintrue({
      thisProgram: "chaintrue",
      noInitialRun: true,
      instantiateWasm: (imports, ready) => {
        // Emscripten's script would wait forever for an instance that cannot be made.
        WebAssembly.instantiate(module, imports).then((made) => ready(made, module)).catch(reject);
        return {};
      },
      stdin: () => (at < fresh.stdin.length ? fresh.stdin[at++] : null),
      stdout: fresh.out.take,
      stderr: fresh.err.take,
      onExit: (status) => {
        fresh.code = status;
      },
      quit: (_status, reason) => {
        throw reason;
      },
    }).then((instance) => resolve(Object.assign(fresh, {instance})), reject);
  });
}

/**
 * Runs the command in a fresh instance.
 * @param words the command line without the command's name
 * @param files path -> Uint8Array, the command's working folder
 * @param options onProgress(words); stdin (Uint8Array)
 * @returns {code, stdout, stderr, files}: the exit code, both texts, and the files written.
 * @throws the engine's error; the folder is unchanged
 */
export function runIn(fresh, words, files, options = {}) {
  const {instance, out, err} = fresh;
  fresh.stdin = options.stdin ?? fresh.stdin;
  instance.onProgress = options.onProgress;
  writeFiles(instance.FS, files);
  try {
    instance.callMain(words);
  } catch (reason) {
    if (fresh.code === null) throw reason;
  }
  return {code: fresh.code, stdout: out.text(), stderr: err.text(), files: writtenFiles(instance.FS)};
}
