// One output against another: a path, a hodograph, a phase plane, the polar plot of a bearing's load.
// In: a section, the charts of the outputs, the clock. Out: two lists of curves and a drawing with a dot at the clock's
// time. Of outputs in one unit both axes have one scale; what other runs have of both is drawn dashed.

import { valueAt } from "./charts.js";
import { element } from "./page.js";

/** The widest drawing, and the least high one. */
const [WIDEST, LOWEST] = [960, 260];
const PLOT = { left: 76, right: 14, top: 12, bottom: 46 };

/** A new element of a drawing. */
function shape(tag, attributes, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

/** Round numbers inside a range, about `count` of them, and two at least. */
function ticks([least, largest], count) {
  const rough = (largest - least) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const inside = (step) => {
    const first = Math.ceil(least / step);
    const tick = (_, k) => Number(((first + k) * step).toPrecision(12));
    return Array.from({ length: Math.max(Math.floor(largest / step) - first + 1, 0) }, tick);
  };
  const steps = [10, 5, 2, 1, 0.5, 0.2].map((digit) => digit * power);
  const next = steps.findLastIndex((step) => step >= rough);
  return steps.slice(next).map(inside).find((found) => found.length > 1) ?? [];
}

/** The range of values with a margin; a single value has one about it. */
function range(lists) {
  let [least, largest] = [Infinity, -Infinity];
  for (const values of lists)
    for (const value of values) {
      if (value === null) continue;
      if (value < least) least = value;
      if (value > largest) largest = value;
    }
  const middle = (least + largest) / 2;
  const half = 0.55 * Math.max(largest - least, 1e-9 * Math.abs(middle), 1e-300);
  return Number.isFinite(middle) ? [middle - half, middle + half] : [-1, 1];
}

/** Both ranges so that a unit of one is as long as one of the other. */
function toScale(across, up, [wide, high]) {
  const perPixel = Math.max((across[1] - across[0]) / wide, (up[1] - up[0]) / high);
  return [
    [across, wide],
    [up, high],
  ].map(([[least, largest], size]) => {
    const middle = (least + largest) / 2;
    return [middle - 0.5 * perPixel * size, middle + 0.5 * perPixel * size];
  });
}

const isMoving = (values) => values.some((value) => value !== values[0]);

/** The curves of charts by names, each with those of other runs. */
function curvesOf(charts) {
  return charts.flatMap(({ title, unit, curves, times }) =>
    curves.flatMap((curve, index) => {
      if (curve.like !== undefined) return [];
      const others = new Map(curves.filter(({ like }) => like === index).map(({ other, values }) => [other, values]));
      return [{ name: [title, curve.name].filter(Boolean).join(" "), unit, values: curve.values, times, others }];
    }),
  );
}

/** The first x and y that move together, else the first two curves that do. */
function firstPair(curves) {
  const moving = curves.filter(({ values }) => isMoving(values)).map(({ name }) => name);
  const beside = (name) => name.replace(/x$/, "y");
  const first = moving.find((name) => name.endsWith("x") && moving.includes(beside(name)));
  if (first) return [first, beside(first)];
  return moving.length > 1 ? moving : curves.map(({ name }) => name);
}

export class Against {
  #charts;
  #dot = null;
  /** That of its place when it was drawn last, CSS pixels. */
  #width = 0;

  /** `charts` gives the charts of the outputs. */
  constructor(section, charts, clock) {
    this.#charts = charts;
    const names = curvesOf(charts());
    const [across, up] = firstPair(names);
    this.lists = [across, up].map((chosen) =>
      element(
        "select",
        { onchange: () => this.update() },
        ...names.map(({ name }) => element("option", { value: name, selected: name === chosen }, name)),
      ),
    );
    const label = (text, list) => element("label", {}, `${text} `, list);
    this.place = element("div", { class: "against" });
    section.append(
      element("p", { class: "pair-of" }, label("up", this.lists[1]), label("across", this.lists[0])),
      this.place,
    );
    this.clock = clock;
    this.update();
    clock.subscribe(() => this.#follow());
    new ResizeObserver(() => {
      if (this.place.clientWidth !== this.#width) this.update();
    }).observe(this.place);
  }

  /** Draws the run that the charts show now. */
  update() {
    const curves = curvesOf(this.#charts());
    this.chosen = this.lists.map((list) => curves.find(({ name }) => name === list.value));
    if (this.chosen.some((curve) => curve === undefined)) return;
    this.place.replaceChildren(this.#drawn());
    this.#follow();
  }

  #drawn() {
    const [x, y] = this.chosen;
    const names = [...x.others.keys()].filter((name) => y.others.has(name));
    const runs = [[null, x.values, y.values], ...names.map((name) => [name, x.others.get(name), y.others.get(name)])];
    this.#width = this.place.clientWidth;
    const width = Math.min(this.#width || WIDEST, WIDEST);
    const height = Math.max(0.55 * width, LOWEST);
    const size = [width - PLOT.left - PLOT.right, height - PLOT.top - PLOT.bottom];
    let [across, up] = [range(runs.map(([, values]) => values)), range(runs.map(([, , values]) => values))];
    if (x.unit === y.unit && x.unit) [across, up] = toScale(across, up, size);
    this.at = (a, b) => [
      PLOT.left + (size[0] * (a - across[0])) / (across[1] - across[0]),
      PLOT.top + size[1] * (1 - (b - up[0]) / (up[1] - up[0])),
    ];
    const label = `${y.name} over ${x.name}`;
    const drawing = shape("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
    const [bottom, right] = [height - PLOT.bottom, width - PLOT.right];
    const text = (value) => String(value).replaceAll("-", "\u2212");
    for (const value of ticks(across, Math.max(size[0] / 90, 2))) {
      const [place] = this.at(value, up[0]);
      drawing.append(shape("line", { class: "grid", x1: place, x2: place, y1: PLOT.top, y2: bottom }));
      drawing.append(shape("text", { x: place, y: bottom + 16, "text-anchor": "middle" }, text(value)));
    }
    for (const value of ticks(up, Math.max(size[1] / 60, 2))) {
      const [, place] = this.at(across[0], value);
      drawing.append(shape("line", { class: "grid", x1: PLOT.left, x2: right, y1: place, y2: place }));
      drawing.append(shape("text", { x: PLOT.left - 6, y: place + 4, "text-anchor": "end" }, text(value)));
    }
    const named = ({ name, unit }) => (unit ? `${name} in ${unit}` : name);
    const name = (curve, left, top, more) =>
      drawing.append(shape("text", { class: "axis", x: left, y: top, "text-anchor": "middle", ...more }, named(curve)));
    name(x, (PLOT.left + right) / 2, height - 8);
    const middle = (PLOT.top + bottom) / 2;
    name(y, 14, middle, { transform: `rotate(-90 14 ${middle})` });
    runs.forEach(([of, as, bs], index) => {
      const points = as.map((a, k) => (a === null || bs[k] === null ? null : this.at(a, bs[k])));
      const move = ([left, top], letter) => `${letter}${left.toFixed(1)} ${top.toFixed(1)}`;
      const moves = points.map((point, k) => point && move(point, points[k - 1] ? "L" : "M"));
      const line = shape("path", { class: of === null ? "own" : "other", d: moves.filter(Boolean).join("") });
      line.style.setProperty("--hue", `var(--hue-${index % 7})`);
      drawing.append(line);
      if (of === null) return;
      const place = { class: "name", x: right - 4, y: PLOT.top + 16 * index, "text-anchor": "end" };
      const entry = shape("text", place, of);
      entry.style.setProperty("--hue", `var(--hue-${index % 7})`);
      drawing.append(entry);
    });
    this.#dot = shape("circle", { class: "dot", r: 5 });
    drawing.append(this.#dot);
    return drawing;
  }

  /** Puts the dot where both are at the clock's time. */
  #follow() {
    const [x, y] = this.chosen;
    if (!x || !y || this.#dot === null) return;
    const [a, b] = [x, y].map(({ times, values }) => valueAt(times, values, this.clock.time));
    this.#dot.style.display = a === null || b === null ? "none" : "";
    if (a === null || b === null) return;
    const [left, top] = this.at(a, b);
    this.#dot.setAttribute("cx", left);
    this.#dot.setAttribute("cy", top);
  }
}
