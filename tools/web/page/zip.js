// SPDX-License-Identifier: GPL-3.0-or-later
// The folder as one zip of the command's own files, and back.
import {unzipSync, zipSync} from "fflate";

/** The earliest date of the format: the same folder gives the same bytes. */
const FIRST_DAY = new Date(1980, 0, 1);
const FOLDER = "my-machine/";

export function zipOf(folder) {
  const paths = Object.keys(folder).sort();
  return zipSync(Object.fromEntries(paths.map((path) => [FOLDER + path, folder[path]])), {level: 6, mtime: FIRST_DAY});
}

/** The files of a zip without their common folder. Throws if it is not a zip. */
export function folderOf(bytes) {
  const files = Object.entries(unzipSync(bytes)).filter(([path]) => !path.endsWith("/") && !path.startsWith("__MACOSX/"));
  const first = files[0]?.[0].split("/")[0];
  const isWrapped = files.length > 0 && files.every(([path]) => path.startsWith(`${first}/`));
  const paths = files.map(([path, content]) => [isWrapped ? path.slice(first.length + 1) : path, content]);
  if (paths.some(([path]) => path.startsWith("/") || path.split("/").includes(".."))) throw new Error("a path leads out of the folder");
  return Object.fromEntries(paths);
}
