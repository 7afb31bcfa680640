// The bond-graph picture: hover a bond for its effort, flow and power over time.
// In: the section with the SVG, the bonds of the page's data, the charts. Out: a panel with the bond's charts; a click
// keeps it; another run's bonds take their place by `update`, another picture by `end` and `graph` again.

import { filled } from "./data.js";
import { element } from "./page.js";

const AXES = ["x", "y", "z"];
const HEIGHT = 120;

/** The power of a bond at each sample, W: effort times flow, summed over the components. */
export function power(effort, flow) {
  return effort[0].map((_, k) => effort.reduce((sum, values, axis) => sum + values[k] * flow[axis][k], 0));
}

/** What the panel shows of bond `index`: its charts' curves. */
export function curvesOf(data, index) {
  const bond = data.bonds[index];
  const [effort, flow] = [bond.effort, bond.flow].map((list) =>
    list.map((at) => filled(data.series[at], data.times.length)),
  );
  const named = (all) => all.map((values, axis) => ({ name: all.length > 1 ? AXES[axis] : "", values }));
  return [
    { title: "effort", unit: bond.effort_unit, curves: named(effort) },
    { title: "flow", unit: bond.flow_unit, curves: named(flow) },
    { title: "power along the half arrow", unit: "W", curves: [{ name: "", values: power(effort, flow) }] },
  ];
}

/** The smallest scale at which labels can be read. */
const LEGIBLE = 0.7;

/** Fits the picture into its frame as long as it can be read; buttons show all of it or enlarge it. */
function sizes(section) {
  const frame = section.querySelector(".picture");
  const picture = frame?.querySelector("svg");
  if (!picture) return;
  const { width } = picture.viewBox.baseVal;
  const fit = () => Math.min(frame.clientWidth / width, 1.2);
  let scale = Math.max(fit(), Math.min(LEGIBLE, 1));
  const show = (next) => {
    scale = Math.min(Math.max(next, 0.1), 4);
    picture.style.width = `${scale * width}px`;
  };
  const button = (text, title, act) => element("button", { type: "button", title, onclick: act }, text);
  section.append(
    element(
      "div",
      { class: "sizes" },
      button("all", "Show all of it", () => show(fit())),
      button("\u2212", "Smaller", () => show(scale / 1.25)),
      button("+", "Larger", () => show(scale * 1.25)),
    ),
  );
  show(scale);
}

export function graph(section, bonds, charts) {
  sizes(section);
  if (bonds === null) return null;
  let data = bonds;
  const groups = [...section.querySelectorAll("g.bond[data-bond]")];
  const panel = element("div", { class: "bond-panel" });
  section.append(panel);
  const hint = element("p", { class: "note" }, "Point at a bond to see its effort, flow and power; click to keep it.");
  panel.append(hint);
  let shown = { index: null, charts: [], isKept: false };

  const show = (group, isKept) => {
    const index = Number(group.dataset.bond);
    if (!(index in data.bonds)) return;
    if (index !== shown.index) {
      shown.charts.forEach((chart) => charts.remove(chart));
      groups.forEach((other) => other.classList.toggle("chosen", other.dataset.bond === group.dataset.bond));
      const heading = element("h3", { class: "bond-name" }, data.bonds[index].name);
      panel.replaceChildren(heading);
      shown = {
        index,
        charts: curvesOf(data, index).map((chart) => charts.add(panel, data.times, chart, HEIGHT)),
        isKept,
      };
    }
    shown.isKept = isKept;
    panel.classList.toggle("kept", isKept);
  };
  for (const group of groups) {
    group.tabIndex = 0;
    group.addEventListener("pointerenter", (event) => {
      if (!shown.isKept && event.pointerType === "mouse") show(group, false);
    });
    const keep = () => show(group, !(shown.isKept && shown.index === Number(group.dataset.bond)));
    group.addEventListener("click", keep);
    group.addEventListener("keydown", (event) => {
      if (event.key === "Enter") keep();
    });
  }
  const update = (next) => {
    if (next === null) return;
    data = next;
    if (shown.index === null) return;
    // The panel's charts are those of effort, flow and power of one bond, whatever the run.
    charts.replace(panel, data.times, curvesOf(data, shown.index));
    shown.charts = charts.all.filter((chart) => chart.place.parentElement === panel);
  };
  /** Takes the panel's charts away, before another picture is in the place of this one. */
  const end = () => shown.charts.forEach((chart) => charts.remove(chart));
  return { show: (index) => show(section.querySelector(`g.bond[data-bond="${index}"]`), false), update, end };
}
