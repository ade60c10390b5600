// SPDX-License-Identifier: GPL-3.0-or-later
// What the browser keeps between visits: one folder, in IndexedDB. Where it keeps nothing (private windows, a full
// disk) `problem` says so, and the page goes on without.

const DATABASE = "chaintrue";
const STORE = "folders";
const KEY = "current";

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
  #onProblem;

  constructor(onProblem) {
    this.#onProblem = onProblem;
  }

  /** What was kept, or null. */
  async open() {
    try {
      const request = indexedDB.open(DATABASE, 1);
      request.onupgradeneeded = () => request.result.createObjectStore(STORE);
      this.#database = await finished(request);
      return (await finished(this.#database.transaction(STORE).objectStore(STORE).get(KEY))) ?? null;
    } catch (problem) {
      this.#fail(problem);
      return null;
    }
  }

  /** Keeps `state`; of several that come while one is being written, the last. */
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
      const state = this.#pending;
      this.#pending = null;
      try {
        const transaction = this.#database.transaction(STORE, "readwrite", {durability: "strict"});
        const done = new Promise((resolve, reject) => {
          transaction.oncomplete = resolve;
          transaction.onabort = transaction.onerror = () => reject(transaction.error);
        });
        transaction.objectStore(STORE).put(state, KEY);
        await done;
        this.#onProblem(null);
      } catch (problem) {
        this.#fail(problem);
        return;
      }
    }
  }

  #fail(problem) {
    const reason = problem?.name === "QuotaExceededError" ? "its storage is full" : "a private window, or its settings";
    this.#onProblem(`This browser keeps nothing of this page (${reason}). All works, but press Download before you ` +
      "close it: the folder holds everything, and Open takes it back.");
  }
}
