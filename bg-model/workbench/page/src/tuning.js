// The sliders of a live page. In: the settings that bg-workbench's `page/settings.rs` writes, what starts a worker with
// the model, what shows an answer. Out: a panel; a value that is changed there runs the model again, and the page shows
// that run.

import { element, number } from "./page.js";
import { rangeOf, rounded } from "./ranges.js";

/** A run that takes longer is given up for a newer order, milliseconds. */
const PATIENCE = 2000;
/** With more parameters than these there is a field to find one. */
const MANY = 10;

/** A number as a person types it: `1e7`, not `10000000`. */
function written(value) {
  const [plain, scientific] = [String(Number(value.toPrecision(12))), value.toExponential().replace("e+", "e")];
  return plain.length > 6 && scientific.length < plain.length ? scientific : plain;
}

/** The model in a worker. Of the orders that arrive while one is under way, only the newest waits. */
class Runner {
  #begin;
  #worker;
  #current = null;
  #next = null;

  constructor(begin) {
    this.#begin = begin;
    this.#start();
  }

  #start() {
    this.#worker?.terminate();
    this.#current = null;
    this.#worker = this.#begin();
    this.#worker.onmessage = ({ data }) => {
      const { told } = this.#current;
      this.#current = null;
      if (this.#next !== null) this.order(this.#next.text, this.#next.told);
      told(data);
    };
  }

  /** Orders a run; `told` is called with its answer, unless a newer order takes its place. */
  order(text, told) {
    if (this.isBusy && performance.now() - this.#current.begin > PATIENCE) this.#start();
    if (this.isBusy) {
      this.#next = { text, told };
      return;
    }
    this.#next = null;
    this.#current = { begin: performance.now(), told };
    this.#worker.postMessage(text);
  }

  get isBusy() {
    return this.#current !== null;
  }
}

/** A row of the panel: the parameter's slider and field. `changed` is called when its value changes. */
class Control {
  constructor(parameter, changed) {
    Object.assign(this, { parameter, changed, value: parameter.value, range: rangeOf(parameter, parameter.value) });
    const { name, unit, meaning } = parameter;
    this.slider = element("input", {
      type: "range",
      step: "any",
      "aria-label": name,
      oninput: () => this.set(rounded(Number(this.slider.value), this.range)),
    });
    this.field = element("input", {
      type: "number",
      step: "any",
      "aria-label": unit ? `${name} in ${unit}` : name,
      onchange: () => {
        if (this.field.value !== "" && Number.isFinite(Number(this.field.value))) this.set(Number(this.field.value));
        else this.show();
      },
    });
    this.reset = element(
      "button",
      {
        type: "button",
        class: "reset",
        title: `Back to the default, ${number(parameter.default, 6)}`,
        "aria-label": `Reset ${name}`,
        onclick: () => this.set(parameter.default),
      },
      "\u21ba",
    );
    const label = element("span", { class: "name", title: meaning }, element("code", {}, name));
    if (unit) label.append(element("span", { class: "note" }, ` in ${unit}`));
    this.row = element("div", { class: "control" }, label, this.slider, this.field, this.reset);
    this.show();
  }

  set(value) {
    if (value === this.value) return;
    this.value = value;
    this.show();
    this.changed();
  }

  show() {
    const [low, high] = this.range;
    // A value beyond the slider's ends, from the field, moves them.
    if (this.value < low || this.value > high) this.range = rangeOf(this.parameter, this.value);
    [this.slider.min, this.slider.max] = this.range;
    this.slider.value = this.value;
    this.field.value = written(this.value);
    const isUsual = this.value === this.parameter.default;
    this.row.classList.toggle("changed", !isUsual);
    this.reset.disabled = isUsual;
  }
}

export class Tuning {
  #runner;

  /** Fills `section`; `begin` starts a worker, `show` is handed each answer. */
  constructor(section, { order, parameters }, begin, show) {
    this.order = order;
    this.show = show;
    this.status = element("p", { class: "status", role: "status" }, "Move a slider: the model in this page runs again.");
    this.controls = parameters.map((parameter) => new Control(parameter, () => this.run()));
    this.end = element("input", {
      type: "number",
      min: 0,
      step: "any",
      value: order.integration.t_end,
      onchange: () => this.run(),
    });
    const list = element("div", { class: "controls" }, ...this.controls.map(({ row }) => row));
    const all = element("button", { type: "button", onclick: () => this.reset() }, "reset all");
    const end = element("label", { class: "end" }, "end of the run", this.end, "s");
    section.append(
      element("div", { class: "tuning-head" }, element("h2", {}, "Try other values"), all, end),
      this.status,
      ...(parameters.length > MANY ? [this.#search()] : []),
      list,
    );
    this.#runner = new Runner(begin);
    // The run that the page shows already: a browser compiles better what has run.
    if (!begin.hasRun) this.#runner.order(JSON.stringify(order), () => this.status.classList.remove("busy"));
  }

  #search() {
    const search = element("input", {
      type: "search",
      placeholder: "find a parameter",
      "aria-label": "Find a parameter",
      oninput: () => {
        const wanted = search.value.trim().toLowerCase();
        for (const { row, parameter } of this.controls) {
          row.hidden = !`${parameter.name} ${parameter.meaning}`.toLowerCase().includes(wanted);
        }
      },
    });
    return search;
  }

  reset() {
    for (const control of this.controls) {
      control.value = control.parameter.default;
      control.show();
    }
    this.end.value = this.order.integration.t_end;
    this.run();
  }

  /** Orders the run that the sliders ask for. */
  run() {
    const parameters = { ...this.order.parameters };
    for (const { parameter, value } of this.controls) {
      if (value === parameter.default) delete parameters[parameter.name];
      else parameters[parameter.name] = value;
    }
    const integration = { ...this.order.integration, t_end: Number(this.end.value) };
    const order = JSON.stringify({ ...this.order, parameters, integration });
    this.#runner.order(order, (answer) => this.#told(answer));
    setTimeout(() => this.status.classList.toggle("busy", this.#runner.isBusy), 150);
  }

  /** The value of each parameter by name. */
  get values() {
    return new Map(this.controls.map(({ parameter, value }) => [parameter.name, value]));
  }

  #told({ answer, milliseconds, fault }) {
    const told = answer === undefined ? { fault } : JSON.parse(answer);
    const isShown = told.fault === undefined && told.data.times.length > 0;
    this.fault = told.fault ?? (told.failure === null ? "" : `The run failed: ${told.failure}`);
    this.milliseconds = milliseconds;
    const time = `Run again in ${number(milliseconds / 1000, 3)} s.`;
    this.status.textContent = this.fault || time;
    this.status.classList.toggle("failure", this.fault !== "");
    this.status.classList.toggle("busy", this.#runner.isBusy);
    if (isShown) this.show(told, milliseconds);
    this.answered?.();
  }
}
