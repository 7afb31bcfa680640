// The page that compiles. In: the files beside it, what stands after `#` of the address. Out: the page. Method: one
// worker compiles the model that is shown and runs it, another one looks for faults in all models of the text.

import "./page.css";
import { Editor, placed } from "./editor.js";
import { element, lasting, withCode } from "./elements.js";
import { read, written } from "./link.js";
import { show } from "./report.js";
import { trial } from "./trial.js";
import { Words } from "./words.js";
import { Compiler, Stopped } from "./workers.js";

/** After the last key so long nothing is compiled, milliseconds. */
const PAUSE = 250;
/** A rate is measured over about so long, milliseconds. */
const MEASURED = 30;

const faults = [];
window.addEventListener("error", ({ message }) => faults.push(message));
window.addEventListener("unhandledrejection", ({ reason }) => faults.push(String(reason)));

const part = (name) => document.getElementById(name);
const isTried = location.search === "?test";

async function compiled() {
  const response = await fetch("bond.wasm");
  if (!response.ok) throw new Error(`bond.wasm: ${response.status} ${response.statusText}`);
  // A server that does not know the type of the file.
  const isTyped = response.headers.get("Content-Type") === "application/wasm";
  return isTyped ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

class Page {
  #timer;
  /** Counts what was to be shown: an answer for what was shown before is not shown. */
  #version = 0;
  #says = { compiled: "", run: "", rate: "" };

  constructor(examples, module) {
    this.examples = examples;
    this.runner = new Compiler(module);
    this.checker = new Compiler(module);
    const words = new Words(this.checker);
    this.editor = new Editor(part("editor"), () => this.typed(), (text) => words.told(text));
    this.shown = { text: "", graph: null, scene: "", t_end: null, step: null, inputs: {} };
    this.faults = [];
    // What a report in the frame asks for: something like a worker that runs the model which it shows.
    window.model = () => this.model();
    part("example").append(
      ...examples.map(({ name, title }) => element("option", { value: name }, title)),
      element("option", { value: "", hidden: true }, "your own"),
    );
    part("example").addEventListener("change", ({ target }) => this.#open(`example=${target.value}`));
    part("graph").addEventListener("change", ({ target }) => this.#choose({ graph: target.value, scene: "" }));
    part("scene").addEventListener("change", ({ target }) => this.#choose({ scene: target.value }));
    part("link").addEventListener("click", () => this.#copy());
    part("stop").addEventListener("click", () => this.#stop());
    for (const button of document.querySelectorAll(".tabs button")) {
      button.addEventListener("click", () => this.#turn(button.dataset.tab));
    }
    addEventListener("hashchange", () => this.#open(location.hash.slice(1)));
  }

  /** Shows what a link says, whose report may be there. */
  async start(isThere) {
    this.runner.start();
    await this.#open(location.hash.slice(1), isThere);
  }

  async #open(words, isThere = false) {
    let unreadable = null;
    try {
      this.shown = await read(words, this.examples);
    } catch (fault) {
      this.shown = await read("", this.examples);
      unreadable = `The text in the link cannot be read: ${fault.message}. This is the first example.`;
    }
    this.editor.text = this.shown.text;
    await this.#update(isThere);
    if (unreadable !== null) this.#tell(unreadable, true);
  }

  /** The reader has typed. */
  typed() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.shown.text = this.editor.text;
      this.#update();
    }, PAUSE);
  }

  #choose(changed) {
    Object.assign(this.shown, changed);
    this.#update();
  }

  #turn(tab) {
    document.querySelector("main").dataset.tab = tab;
    for (const button of document.querySelectorAll(".tabs button")) {
      button.setAttribute("aria-pressed", button.dataset.tab === tab);
    }
  }

  /** Compiles, runs and shows what is to be shown, and looks for all faults; `isThere` says that its report is. */
  async #update(isThere = false) {
    clearTimeout(this.#timer);
    this.#version += 1;
    const version = this.#version;
    for (const compiler of [this.runner, this.checker]) if (compiler.isBusy) compiler.stop();
    const { text } = this.shown;
    const example = this.examples.find((one) => one.text === text);
    part("example").value = example?.name ?? "";
    part("about").replaceChildren(...withCode(example?.about ?? ""));
    const link = written(this.shown, this.examples).then((words) => history.replaceState(null, "", `#${words}`));
    this.#busy(true);
    try {
      const isClean = await this.#compile(version);
      if (isThere) this.#says.run = ", run before when this page was built";
      const check = isClean === null ? null : this.#check(version, isClean);
      // A report that fails is told below; a check that fails after that is not told as well.
      check?.catch(() => {});
      if (isClean && !isThere) await this.#report(version);
      await check;
      if (isClean) await this.#measure(version);
    } catch (fault) {
      if (!(fault instanceof Stopped) && version === this.#version) this.#tell(`${fault.message}.`, true);
    }
    if (version === this.#version) this.#busy(false);
    await link;
  }

  /** Compiles the model; whether it can be run, `null` where something newer is to be shown. */
  async #compile(version) {
    const { text, graph, scene } = this.shown;
    const question = { ask: "compile", text, graph, scene: scene || null };
    const { answer, milliseconds } = await this.runner.ask(question, { fresh: true });
    if (version !== this.#version) return null;
    this.compiled = question;
    this.#says = { compiled: `Compiled in ${lasting(milliseconds)}`, run: "", rate: "" };
    this.#found(answer.faults);
    if (answer.faults.length > 0) return false;
    this.#offer(answer);
    if (answer.chosen === null) this.#tell("The text has no graph, only parts.");
    return answer.chosen !== null;
  }

  /** The graphs, scenes and inputs to choose. */
  #offer({ graphs, chosen, inputs }) {
    const [graph, scene] = chosen ?? [null, null];
    const fill = (name, list, value) => {
      part(`${name}-label`).hidden = list.length < 2;
      part(name).replaceChildren(...list.map((one) => element("option", { value: one.name, title: one.about ?? "" }, one.name)));
      part(name).value = value;
    };
    fill("graph", graphs, graph);
    fill("scene", graphs.find(({ name }) => name === graph)?.scenes ?? [], scene);
    const field = ({ name, unit }) => {
      const input = element("input", { type: "number", step: "any", value: this.shown.inputs[name] ?? 0 });
      input.addEventListener("change", () => {
        this.#choose({ inputs: { ...this.shown.inputs, [name]: Number(input.value) } });
      });
      return element("label", {}, element("code", {}, name), input, unit === "1" ? "" : unit);
    };
    part("inputs").hidden = inputs.length === 0;
    if (!part("inputs").contains(document.activeElement)) part("inputs").replaceChildren(...inputs.map(field));
  }

  async #report(version) {
    const { t_end, step, inputs } = this.shown;
    const { answer, milliseconds } = await this.runner.ask({ ask: "report", t_end, step, inputs });
    if (version !== this.#version) return;
    if (answer.fault !== undefined) {
      this.#tell(`The machine does not run: ${answer.fault}.`, true);
      part("report").classList.toggle("old", true);
      return;
    }
    this.#says.run = `, run in ${lasting(milliseconds)}`;
    if (this.faults.length === 0) this.#tell();
    await place(answer.page);
  }

  /** Looks for faults in all models: the one that is shown may have none. */
  async #check(version, isClean) {
    const { answer } = await this.checker.ask({ ask: "check", text: this.shown.text }, { fresh: true });
    if (version === this.#version) this.#found(answer.faults, isClean);
  }

  /** Shows the faults; `isElsewhere` says that the model which is shown has none. */
  #found(found, isElsewhere = false) {
    this.faults = placed(this.editor.text, found);
    this.editor.mark(this.faults);
    const one = ({ line, column, code, message, help, from, to }) => {
      const button = element("button", { type: "button" }, element("b", {}, `${line}:${column} ${code}`), ` ${message}`);
      if (help) button.append(element("small", {}, help));
      button.addEventListener("click", () => this.editor.select(from, to));
      return element("li", {}, button);
    };
    part("faults").replaceChildren(...this.faults.map(one));
    part("faults").hidden = this.faults.length === 0;
    const count = this.faults.length === 1 ? "a fault" : `${this.faults.length} faults`;
    document.querySelector('[data-tab="text"]').textContent = this.faults.length > 0 ? `Text: ${count}` : "Text";
    if (this.faults.length === 0) return;
    if (isElsewhere) {
      this.#tell(`The text has ${count}, but not in the model that is shown.`, true);
      return;
    }
    const rest = part("report").querySelector("iframe") ? " The machine is that of the text before." : "";
    part("report").classList.toggle("old", rest !== "");
    if (rest === "") part("wait").textContent = `The text has ${count}.`;
    this.#tell(`The text has ${count}.${rest}`, true);
  }

  /** How long an evaluation of the rate takes. */
  async #measure(version) {
    let how = "";
    const once = async (count) => {
      const { answer, milliseconds, functions } = await this.runner.ask({ ask: "rate", count });
      how = functions > 0 ? "in machine code" : "interpreted";
      return answer.fault === undefined ? milliseconds : null;
    };
    // A machine that does other things meanwhile makes one of the two longer.
    const time = async (count) => {
      const [a, b] = [await once(count), await once(count)];
      return a === null || b === null ? null : Math.min(a, b);
    };
    // The first answer is that of an engine which is not warm; each has a model to be made beside its rates.
    const made = await time(1);
    let count = 100;
    let spent = await time(count);
    while (spent !== null && spent - made < MEASURED / 2 && count < 1e7) {
      count = Math.ceil(count * Math.min(Math.max(MEASURED / Math.max(spent - made, 0.1), 2), 100));
      spent = await time(count);
    }
    if (spent === null || version !== this.#version) return;
    this.rate = (spent - made) / count;
    this.#says.rate = `; the rate takes ${lasting(this.rate)} each time, ${how}`;
    if (this.faults.length === 0) this.#tell();
  }

  /** What a report in the frame takes for what starts a worker. */
  model() {
    const version = this.#version;
    const begin = () => {
      const worker = {
        onmessage: null,
        postMessage: (order) => this.#order(version, order).then((data) => data && worker.onmessage?.({ data })),
        terminate: () => {
          worker.onmessage = null;
          if (version === this.#version) this.runner.stop();
        },
      };
      return worker;
    };
    begin.hasRun = true;
    return begin;
  }

  /** Runs the model as the sliders of the report say. */
  async #order(version, order) {
    if (version !== this.#version) return null;
    const { t_end } = JSON.parse(order).integration;
    this.shown.t_end = t_end === (this.shown.t_end ?? 5) ? this.shown.t_end : t_end;
    try {
      const { answer, milliseconds } = await this.#ran(order);
      return { answer: JSON.stringify(answer), milliseconds };
    } catch (fault) {
      return fault instanceof Stopped ? null : { fault: fault.message };
    }
  }

  async #ran(order) {
    // With its worker goes what was compiled.
    if (!this.runner.isRunning) await this.runner.ask(this.compiled, { fresh: true });
    return this.runner.ask({ ask: "run", order });
  }

  #stop() {
    this.#version += 1;
    for (const compiler of [this.runner, this.checker]) compiler.stop();
    this.#busy(false);
    this.#tell("Stopped. The next change compiles again.");
  }

  async #copy() {
    const words = await written(this.shown, this.examples);
    const link = new URL(`#${words}`, location.href);
    history.replaceState(null, "", link);
    const told = await navigator.clipboard.writeText(link.href).then(
      () => "The link is copied: it holds the text.",
      () => "The link is in the address bar: it holds the text.",
    );
    this.#tell(told);
  }

  #busy(isBusy) {
    document.body.classList.toggle("busy", isBusy);
    part("stop").hidden = !isBusy;
  }

  /** Says it; without words how long things took. */
  #tell(words, isFault = false) {
    const { compiled, run, rate } = this.#says;
    part("status").textContent = words ?? `${compiled}${run}${rate}.`;
    part("status").classList.toggle("fault", isFault);
  }
}

/** Puts a report into its frame, until it moves. */
async function place(report) {
  const moves = show(part("report"), report);
  part("wait").hidden = true;
  part("report").classList.toggle("old", false);
  await moves;
}

/* global first */

/** Where the address says nothing, shows the report that was made when this page was built; whether it is there. */
async function opened() {
  const report = await first;
  if (report === null) return false;
  // What its sliders ask for before the compiler is there.
  window.model = async () => (await made).model();
  await place(report);
  return true;
}

/** The page, as soon as it is there. */
let making;
const made = new Promise((resolve) => {
  making = resolve;
});

async function start() {
  const examples = fetch("examples.json").then((file) => file.json());
  // The first motion comes first: what compiles the compiler would keep it waiting.
  const isThere = await opened();
  const module = compiled();
  const page = new Page(await examples, module);
  making(page);
  await Promise.all([module, page.start(isThere)]);
  return page;
}

const began = start();
began.catch((fault) => {
  part("wait").textContent = `The compiler cannot be loaded: ${fault.message}.`;
});
if (isTried) trial(began, faults);
