// The compiler in a worker, from the outside. In: the compiled module, as a promise. Out: answers to questions, as
// promises; a worker that is stopped is replaced by another one.

/** After so long a question is given up, milliseconds. */
const PATIENCE = 60_000;

/** A question that was given up for another one: nobody waits for its answer. */
export class Stopped extends Error {}

export class Compiler {
  #module;
  #worker = null;
  #ready = null;
  #waiting = new Map();
  #number = 0;

  constructor(module) {
    this.#module = module;
  }

  get isRunning() {
    return this.#worker !== null;
  }

  get isBusy() {
    return this.#waiting.size > 0;
  }

  /** Starts the worker, which else the first question does. */
  start() {
    if (this.#worker !== null) return;
    const worker = new Worker("compiler.js");
    this.#worker = worker;
    this.#ready = this.#module.then((module) => worker.postMessage(module));
    this.#worker.onmessage = ({ data: { number, fault, ...told } }) => {
      const { resolve, reject, timer } = this.#waiting.get(number);
      this.#waiting.delete(number);
      clearTimeout(timer);
      if (fault === undefined) resolve({ ...told, answer: JSON.parse(told.answer) });
      else reject(new Error(`the compiler stopped: ${fault}`));
    };
  }

  /** The answer to a question, how long it took, and how much machine code there is; a fresh one is asked of a fresh instance of the module. */
  ask(question, { fresh = false } = {}) {
    this.start();
    this.#number += 1;
    const number = this.#number;
    return new Promise((resolve, reject) => {
      const late = () => this.stop(new Error(`no answer after ${PATIENCE / 1000} s, so it was stopped`));
      this.#waiting.set(number, { resolve, reject, timer: setTimeout(late, PATIENCE) });
      const worker = this.#worker;
      const message = { number, question: JSON.stringify(question), fresh };
      this.#ready.then(() => worker.postMessage(message), reject);
    });
  }

  /** Ends what it is at; with the worker goes what was compiled. */
  stop(reason = new Stopped("stopped")) {
    this.#worker?.terminate();
    this.#worker = null;
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const { reject, timer } of waiting) {
      clearTimeout(timer);
      reject(reason);
    }
  }
}
