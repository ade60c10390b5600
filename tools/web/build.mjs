// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the page and the package from emscripten's output:
//   node build.mjs FOLDER_OF_CHAINTRUE_JS OUTPUT_FOLDER VERSION
import {execFileSync} from "node:child_process";
import {existsSync, mkdirSync, readFileSync, renameSync, statSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";
import esbuild from "esbuild";
import {encoded} from "./page/base85.js";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const read = (path) => readFileSync(path, "utf8");

/** Largest size of a page in bytes: it must fit into a mail together with a few pictures. */
const MOST_BYTES = 2.7e6;

/** Features that the compiler's output uses; browsers of 2023 have them. */
const WASM_FEATURES = ["--enable-exception-handling", "--enable-simd", "--enable-bulk-memory", "--enable-sign-ext",
  "--enable-mutable-globals", "--enable-nontrapping-float-to-int"];

export function bundle(entry, options = {}) {
  const made = esbuild.buildSync({
    entryPoints: [join(here, entry)], bundle: true, write: false, minify: true, format: "iife", target: "es2022",
    charset: "utf8", legalComments: "inline", ...options,
  });
  return made.outputFiles[0].text;
}

/** A minified text for the browser. */
const minified = (text, loader) => esbuild.transformSync(text, {loader, minify: true, charset: "utf8", legalComments: "inline"}).code;

/** Compressed by xz, a quarter smaller than by gzip; the dictionary holds all of it. The page unpacks it with xz-decompress. */
const packed = (bytes) => encoded(execFileSync("xz", ["--format=xz", "--check=crc32", "--lzma2=preset=9e,dict=16MiB", "-c"], {input: bytes, maxBuffer: 1e9}));

/** The file `to` that `make(begun)` makes from `from`. It takes a minute, so it is kept until `from` changes. */
function made(folder, from, to, make) {
  const [source, result, begun] = [from, to, `begun.${to}`].map((name) => join(folder, name));
  if (!existsSync(result) || statSync(result).mtimeMs < statSync(source).mtimeMs) {
    make(source, begun);
    renameSync(begun, result);
  }
  return readFileSync(result);
}

/** The command, a third smaller. */
const smallerWasm = (folder) => made(folder, "chaintrue.wasm", "chaintrue.small.wasm", (source, begun) => {
  execFileSync("wasm-opt", ["-Oz", ...WASM_FEATURES, source, "-o", begun], {stdio: "inherit"});
});

/** Text of a script element: it must not contain the end tag. */
const inScript = (text) => text.replaceAll("</", "<\\/");

function licences() {
  const fflate = read(join(here, "node_modules/fflate/LICENSE"));
  return `${read(join(root, "tools/report/assets/licences.txt"))}\nfflate\n\n${fflate}\n${read(join(here, "page/licence_of_xz.txt"))}`
    .replaceAll("&", "&amp;").replaceAll("<", "&lt;");
}

const EXAMPLES = ["worn_chain", "bent_beam", "long_tape", "slipped_tooth", "nothing_wrong"];

function example() {
  const examples = Object.fromEntries(EXAMPLES.map((name) => [name, read(join(root, `fixtures/start/${name}.csv`))]));
  examples.maslow4 = read(join(root, "fixtures/machines/maslow.yaml")) + read(join(root, "fixtures/good/maslow4_log.txt"));
  return {
    examples, drawing: read(join(root, "fixtures/plotter/mural_drawing.json")),
    "groundcontrol.ini": read(join(root, "fixtures/good/groundcontrol_ring.ini")),
    "bracket.nc": read(join(root, "fixtures/gcode/bracket.nc")),
  };
}

export function page(parts) {
  return Object.entries(parts).reduce((html, [name, text]) => html.replace(`@${name}@`, () => text), read(join(here, "page/index.html")));
}

function main([from, to, version]) {
  const glue = minified(read(join(from, "chaintrue.js")), "js");
  const wasm = smallerWasm(from);
  const worker = `${glue}\nself.createChaintrue = createChaintrue;\n${bundle("engine/worker.js")}`;
  const html = page({
    STYLE: minified(read(join(here, "page/style.css")), "css"), VERSION: version, LICENCES: licences(), EXAMPLE: inScript(JSON.stringify(example())),
    WORKER: packed(worker), WASM: packed(wasm), APP: inScript(bundle("page/app.js")),
  });
  mkdirSync(to, {recursive: true});
  writeFileSync(join(to, "chaintrue.html"), html);
  writeFileSync(join(to, "chaintrue.wasm"), wasm);
  // Emscripten's script uses node features that modules lack, and adds a listener to its process with each run.
  const withoutNode = `const createChaintrue = ((process) => {\n${glue}\nreturn createChaintrue;\n})();`;
  writeFileSync(join(to, "chaintrue.mjs"), `${withoutNode}\n${bundle("engine/package.js", {format: "esm", minify: false, platform: "node"})}`);
  writeFileSync(join(to, "chaintrue.d.ts"), read(join(here, "engine/chaintrue.d.ts")));
  const description = {
    name: "chaintrue", version, type: "module", license: "GPL-3.0-or-later", main: "chaintrue.mjs", types: "chaintrue.d.ts",
    files: ["chaintrue.mjs", "chaintrue.wasm", "chaintrue.d.ts"],
  };
  writeFileSync(join(to, "package.json"), `${JSON.stringify(description, null, 2)}\n`);
  const size = Buffer.byteLength(html);
  console.error(`${join(to, "chaintrue.html")}: ${(size / 1e6).toFixed(2)} MB`);
  if (size > MOST_BYTES) throw new Error(`the page has ${size} bytes, at most ${MOST_BYTES} were promised`);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) main(process.argv.slice(2));
