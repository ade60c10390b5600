// SPDX-License-Identifier: GPL-3.0-or-later
// Data stored by the browser between visits, in IndexedDB: the files of one folder, each separately, and the view. If
// nothing can be stored (private windows, a full disk) the page is notified and continues without.

const DATABASE = "chaintrue";
const FILES = "files";
const VIEW = "view";

function finished(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

export class Storage {
  #database = null;
  #pending = null;
  #writing = null;
  #kept = {};
  #onProblem;

  /** @param onProblem(sentence) is called with an error, and with null once it is resolved */
  constructor(onProblem) {
    this.#onProblem = onProblem;
  }

  /** The stored {folder, view}, or null. */
  async open() {
    try {
      const request = indexedDB.open(DATABASE, 1);
      request.onupgradeneeded = () => {
        request.result.createObjectStore(FILES);
        request.result.createObjectStore(VIEW);
      };
      this.#database = await finished(request);
      const transaction = this.#database.transaction([FILES, VIEW]);
      const [paths, files, view] = await Promise.all([finished(transaction.objectStore(FILES).getAllKeys()),
        finished(transaction.objectStore(FILES).getAll()), finished(transaction.objectStore(VIEW).get(VIEW))]);
      if (!view) return null;
      this.#kept = Object.fromEntries(paths.map((path, index) => [path, files[index]]));
      return {folder: this.#kept, view};
    } catch (problem) {
      this.#fail(problem);
      return null;
    }
  }

  /** Stores {folder, view}; of several calls while one is being written, the last. */
  keep(state) {
    if (!this.#database) return Promise.resolve();
    this.#pending = state;
    this.#writing ??= this.#write().finally(() => {
      this.#writing = null;
    });
    return this.#writing;
  }

  async #write() {
    while (this.#pending) {
      const {folder, view} = this.#pending;
      this.#pending = null;
      try {
        const transaction = this.#database.transaction([FILES, VIEW], "readwrite", {durability: "strict"});
        const done = new Promise((resolve, reject) => {
          transaction.oncomplete = resolve;
          transaction.onabort = transaction.onerror = () => reject(transaction.error);
        });
        this.#putChanged(transaction.objectStore(FILES), folder);
        transaction.objectStore(VIEW).put(view, VIEW);
        await done;
        this.#kept = folder;
        this.#onProblem(null);
      } catch (problem) {
        this.#fail(problem);
        return;
      }
    }
  }

  /** Files are never changed in place: the same object is the same file. */
  #putChanged(store, folder) {
    for (const [path, bytes] of Object.entries(folder)) {
      if (this.#kept[path] !== bytes) store.put(bytes, path);
    }
    for (const path of Object.keys(this.#kept)) {
      if (!(path in folder)) store.delete(path);
    }
  }

  #fail(problem) {
    const reason = problem?.name === "QuotaExceededError" ? "its storage is full" : "a private window, or its settings";
    this.#onProblem(`This browser keeps nothing of this page (${reason}). All works, but press Download before you ` +
      "close it: the folder holds everything, and Open restores it.");
  }
}
