// Charts over time, each with a line at the page's time.
// In: an element, curves, a clock. Out: uPlot charts. Press and drag in one sets the time; double click shows all of
// it again; Ctrl and the wheel zoom all charts in time.

import uPlot from "uplot";
import { between } from "./clock.js";
import { colour, download, element, hue, number, onScheme } from "./page.js";

const FONT = "12px system-ui, sans-serif";
const HEIGHT = 190;

/** The value of a curve at the clock's time, on the straight line between its samples. */
export function valueAt(times, values, time) {
  const { index, next, part } = between(times, time);
  const [a, b] = [values[index], values[next]];
  return a === null || b === null ? null : a + part * (b - a);
}

/** The largest magnitude of some values; those that are none are left out. */
const magnitude = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);

/** The range shown, so that rounding noise beside values as large as `beside` does not fill a chart. */
function range(least, largest, beside) {
  if (least === null || largest === null) return [-1, 1];
  const own = magnitude([least, largest]);
  const size = own > 1e-12 * beside ? own : beside;
  const span = Math.max(largest - least, size > 0 ? 1e-6 * size : 1e-6);
  const middle = (least + largest) / 2;
  return [middle - 0.55 * span, middle + 0.55 * span];
}

/** Charts that share one part of time. */
export class Charts {
  #charts = [];
  #span = null;

  constructor(clock) {
    this.clock = clock;
    this.#seen = new IntersectionObserver(
      (entries) => {
        for (const entry of entries)
          this.#charts.find((chart) => chart.place === entry.target)?.see(entry.isIntersecting);
      },
      { rootMargin: "200px" },
    );
    clock.subscribe(() => this.#charts.forEach((chart) => chart.follow()));
    onScheme(() => this.#charts.forEach((chart) => chart.rebuild()));
  }

  #seen;

  /** Adds a chart to `parent`: `{ title, unit, curves: [{ name, values }] }` over `times`. */
  add(parent, times, chart, height = HEIGHT) {
    const made = new Chart(this, parent, times, chart, height);
    this.#charts.push(made);
    this.#seen.observe(made.place);
    return made;
  }

  /** Shows other charts in `parent`; where they are those that are there, with other values, they stay as they are seen. */
  replace(parent, times, charts) {
    const old = this.in(parent);
    const isSame = old.length === charts.length && old.every((chart, index) => chart.fits(charts[index]));
    if (isSame) {
      old.forEach((chart, index) => chart.update(times, charts[index].curves));
      return;
    }
    old.forEach((chart) => this.remove(chart));
    charts.forEach((chart) => this.add(parent, times, chart));
  }

  remove(chart) {
    this.#seen.unobserve(chart.place);
    this.#charts = this.#charts.filter((other) => other !== chart);
    chart.clear();
    chart.place.remove();
  }

  get all() {
    return this.#charts;
  }

  /** Those in `parent`. */
  in(parent) {
    return this.#charts.filter((chart) => chart.place.parentElement === parent);
  }

  /** The largest magnitude in charts of this unit. */
  size(unit) {
    return magnitude(this.#charts.filter((chart) => chart.unit === unit).map((chart) => chart.size));
  }

  /** Draws all charts anew, those as well that have not been seen yet: on paper there is nothing to scroll to. */
  draw() {
    this.#charts.forEach((chart) => chart.draw());
  }

  /** The part of time shown, s; `null` for all of it. */
  get span() {
    return this.#span ?? [this.clock.start, this.clock.end];
  }

  show(span) {
    this.#span = span;
    this.#charts.forEach((chart) => chart.zoom());
  }
}

class Chart {
  #plot = null;
  #line = element("div", { class: "now" });
  #isSeen = false;
  #hidden;

  constructor(charts, parent, times, { title, unit, curves }, height) {
    Object.assign(this, { charts, times, title, unit, curves, height });
    this.#take(curves);
    // Of many curves those that stay as they are would only hide the others.
    const isStill = (values) => values.every((value) => value === values[0]);
    const own = curves.filter(({ like }) => like === undefined);
    const still = own.length > 3 ? curves.flatMap((_, index) => (isStill(this.values[index]) ? [index] : [])) : [];
    this.#hidden = new Set(still.length < curves.length ? still : []);
    this.legend = curves.map((curve, index) => this.#entry(curve, index));
    this.canvas = element("div", { class: "canvas", style: `height:${height}px` });
    const head = element("figcaption", { class: "head" });
    if (title) head.append(element("h3", {}, title));
    head.append(...this.legend.map((entry) => entry.button));
    if (unit) head.append(element("span", { class: "unit" }, unit));
    const save = () => download(`${title || curves[0].name}.csv`, new Blob([this.csv()], { type: "text/csv" }));
    head.append(element("button", { type: "button", class: "save", title: "Save the numbers shown", onclick: save }, "csv"));
    this.place = element("figure", { class: "chart" }, head, this.canvas);
    parent.append(this.place);
    new ResizeObserver(() => this.#resize()).observe(this.canvas);
  }

  /** The curves shown in the part of time shown, as a CSV file. */
  csv() {
    const shown = this.curves.flatMap((_, index) => (this.#hidden.has(index) ? [] : [index]));
    const [start, end] = this.charts.span;
    const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const head = (index) => quoted(`${this.curves[index].name}${this.unit ? ` [${this.unit}]` : ""}`);
    const rows = this.times.flatMap((t, k) =>
      t < start || t > end ? [] : [[t, ...shown.map((index) => this.values[index][k] ?? "")].join(",")],
    );
    return `${[["t [s]", ...shown.map(head)].join(","), ...rows].join("\n")}\n`;
  }

  #entry(curve, index) {
    const value = element("output");
    const button = element(
      "button",
      {
        type: "button",
        class: curve.like === undefined ? "key" : "key other",
        "aria-pressed": String(!this.#hidden.has(index)),
        title: "Show or hide this curve",
        style: `--hue: var(--hue-${(curve.like ?? index) % 7})`,
        onclick: () => this.#toggle(index),
      },
      element("span", { class: "name" }, curve.name),
      value,
    );
    return { button, value };
  }

  #toggle(index) {
    const show = this.#hidden.delete(index);
    if (!show) this.#hidden.add(index);
    this.legend[index].button.setAttribute("aria-pressed", String(show));
    this.#plot?.setSeries(index + 1, { show });
  }

  #take(curves) {
    this.curves = curves;
    this.values = curves.map((curve) => curve.values);
    this.size = magnitude(this.values.map(magnitude));
  }

  /** Whether a chart has these curves. */
  fits({ title, unit, curves }) {
    const isSame = title === this.title && unit === this.unit && curves.length === this.curves.length;
    return isSame && curves.every(({ name }, index) => name === this.curves[index].name);
  }

  /** The same curves of another run. */
  update(times, curves) {
    this.times = times;
    this.#take(curves);
    this.#plot?.setData([times, ...this.values], false);
    this.zoom();
  }

  see(isSeen) {
    this.#isSeen = isSeen;
    if (isSeen && this.#plot === null) this.#build();
    this.follow();
  }

  draw() {
    const isSeen = this.#isSeen;
    this.clear();
    this.see(true);
    this.#isSeen = isSeen;
  }

  rebuild() {
    if (this.#plot === null) return;
    this.clear();
    if (this.#isSeen) this.#build();
  }

  clear() {
    this.#plot?.destroy();
    this.#plot = null;
  }

  zoom() {
    const [min, max] = this.charts.span;
    this.#plot?.setScale("x", { min, max });
    this.follow();
  }

  /** Puts the line and the values of the legend at the clock's time. */
  follow() {
    if (!this.#isSeen || this.#plot === null) return;
    const { time } = this.charts.clock;
    const [start, end] = this.charts.span;
    this.#line.hidden = time < start || time > end;
    this.#line.style.transform = `translateX(${this.#plot.valToPos(time, "x")}px)`;
    this.legend.forEach(({ value }, index) => {
      value.textContent = number(valueAt(this.times, this.values[index], time), 4);
    });
  }

  /** Where the line is, as a time, s; `null` where the chart is not drawn. */
  get lineTime() {
    if (this.#plot === null) return null;
    const place = new DOMMatrix(getComputedStyle(this.#line).transform).m41;
    return this.#plot.posToVal(place, "x");
  }

  /** Places of the plot on the screen, for what acts on it. */
  get over() {
    return this.#plot?.over ?? null;
  }

  #resize() {
    const width = this.canvas.clientWidth;
    if (this.#plot === null || width === 0 || this.#plot.width === width) return;
    this.#plot.setSize({ width, height: this.height });
    this.follow();
  }

  #build() {
    const axis = {
      stroke: colour("pencil"),
      font: FONT,
      grid: { stroke: colour("grid"), width: 1 },
      ticks: { stroke: colour("grid"), width: 1, size: 4 },
    };
    const [min, max] = this.charts.span;
    const labels = (_, ticks) => ticks.map((tick) => String(Number(tick.toPrecision(6))).replaceAll("-", "\u2212"));
    const options = {
      width: Math.max(this.canvas.clientWidth, 50),
      height: this.height,
      legend: { show: false },
      padding: [8, 12, 0, 0],
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false }, bind: { dblclick: () => null } },
      scales: {
        x: { time: false, min, max },
        y: { range: (_, least, largest) => range(least, largest, this.charts.size(this.unit)) },
      },
      axes: [
        { ...axis, values: labels, size: 26, gap: 4 },
        {
          ...axis,
          values: labels,
          size: (plot, found) => Math.max(52, 18 + 7 * Math.max(3, ...(found ?? []).map((text) => text.length))),
        },
      ],
      series: [
        {},
        ...this.curves.map(({ like }, index) => ({
          stroke: hue(like ?? index),
          dash: like === undefined ? [] : [5, 4],
          width: 1.6,
          points: { show: false },
          show: !this.#hidden.has(index),
        })),
      ],
      hooks: { setSize: [() => this.follow()], setScale: [() => this.follow()] },
    };
    this.#plot = new uPlot(options, [this.times, ...this.values], this.canvas);
    this.#plot.over.append(this.#line);
    this.#listen(this.#plot.over);
    this.follow();
  }

  #listen(over) {
    const { charts } = this;
    const seek = (event) => {
      const left = event.clientX - over.getBoundingClientRect().left;
      charts.clock.seek(this.#plot.posToVal(left, "x"));
    };
    over.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      charts.clock.pause();
      over.setPointerCapture(event.pointerId);
      seek(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) seek(event);
    });
    over.addEventListener("dblclick", () => charts.show(null));
    over.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && !event.metaKey) return;
        event.preventDefault();
        const at = this.#plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x");
        const factor = Math.exp(0.002 * event.deltaY);
        const [start, end] = charts.span.map((edge) => at + factor * (edge - at));
        const { clock } = charts;
        const isAll = start <= clock.start && end >= clock.end;
        charts.show(isAll ? null : [Math.max(start, clock.start), Math.min(end, clock.end)]);
      },
      { passive: false },
    );
  }
}
