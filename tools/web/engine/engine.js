// SPDX-License-Identifier: GPL-3.0-or-later
// The command for the page: runs in sequence in a worker that can be stopped.

/** The command did not finish: it was stopped, or the engine died. */
export class NotFinished extends Error {
  constructor(message, isCancelled) {
    super(message);
    this.isCancelled = isCancelled;
  }
}

export class Engine {
  #source;
  #module;
  #worker = null;
  #current = null;
  #waiting = [];
  #number = 0;

  /** @param source text of the worker; @param wasm bytes of the command. @throws where the browser cannot compile them */
  static async of(source, wasm) {
    return new Engine(source, await WebAssembly.compile(wasm));
  }

  /** @param module is compiled once for all workers, so that the browser's optimised code is shared */
  constructor(source, module) {
    this.#source = source;
    this.#module = module;
    this.#start();
  }

  /**
   * Queues a run of the command. `supersede` names a task: of several queued runs with one name
   * only the last is executed, the others are cancelled.
   * @returns a promise of {code, stdout, stderr, files}; rejects with NotFinished
   */
  run(words, files, {onProgress, supersede} = {}) {
    if (supersede) this.cancel((job) => job !== this.#current && job.supersede === supersede);
    return new Promise((resolve, reject) => {
      this.#waiting.push({id: ++this.#number, words, files, onProgress, supersede, resolve, reject});
      this.#next();
    });
  }

  /** Stops the runs selected by `which`, including the current one. */
  cancel(which = () => true) {
    const stopped = this.#waiting.filter(which);
    this.#waiting = this.#waiting.filter((job) => !stopped.includes(job));
    if (this.#current && which(this.#current)) {
      stopped.push(this.#current);
      this.#restart();
    }
    for (const job of stopped) job.reject(new NotFinished("Stopped.", true));
    this.#next();
  }

  get isBusy() {
    return this.#current !== null;
  }

  #start() {
    const url = URL.createObjectURL(new Blob([this.#source], {type: "text/javascript"}));
    const worker = new Worker(url);
    URL.revokeObjectURL(url);
    worker.onmessage = ({data}) => this.#heard(data);
    worker.onerror = (event) => {
      event.preventDefault();
      // Messages of a stopped worker do not concern the next run.
      if (worker === this.#worker) this.#died(event.message || "the worker ended");
    };
    worker.postMessage({module: this.#module});
    this.#worker = worker;
  }

  #restart() {
    this.#worker.terminate();
    this.#current = null;
    this.#start();
  }

  #next() {
    if (this.#current || this.#waiting.length === 0) return;
    this.#current = this.#waiting.shift();
    const {id, words, files} = this.#current;
    this.#worker.postMessage({id, words, files});
  }

  #heard({id, progress, result, crashed, starved}) {
    const job = this.#current;
    if (!job || job.id !== id) return;
    if (progress !== undefined) {
      job.onProgress?.(progress);
      return;
    }
    if (starved !== undefined && !job.isSecond) {
      // A new worker, to release the memory of earlier runs.
      this.#restart();
      this.#waiting.unshift({...job, isSecond: true});
      this.#next();
      return;
    }
    if (crashed !== undefined || starved !== undefined) {
      this.#died(crashed ?? starved);
      return;
    }
    this.#current = null;
    job.resolve(result);
    this.#next();
  }

  #died(reason) {
    const job = this.#current;
    this.#restart();
    job?.reject(new NotFinished(`The engine stopped unexpectedly (${reason}). Nothing that you typed is lost; please ` +
      "report it with the folder of the button Download.", false));
    this.#next();
  }
}
