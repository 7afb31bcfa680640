// The page of a run: reads the data that the program wrote into it and makes its sections move.
// In: `<script type="application/json" id="data">` and the packed texts, whose form bg-workbench's `page/data.rs`
// says; what draws a machine, if the page is to have one. Out: the page in motion.

import { Against } from "./against.js";
import { Charts } from "./charts.js";
import { Clock } from "./clock.js";
import { player } from "./controls.js";
import { read } from "./data.js";
import { graph } from "./graph.js";
import { withOthers } from "./others.js";
import { element, onPaper } from "./page.js";
import { bringOver, isOfOneKind } from "./renewal.js";
import { texts } from "./texts.js";
import { trial } from "./trial.js";
import { Tuning } from "./tuning.js";

/* global hold, model, plays, unpacked */

const faults = [];
window.addEventListener("error", ({ message }) => faults.push(message));
window.addEventListener("unhandledrejection", ({ reason }) => faults.push(String(reason)));

/** The data that stand in a page. */
const dataOf = (page) => read(JSON.parse(page.getElementById("data").textContent));

let data = dataOf(document);
const section = (name) => document.getElementById(name);
const clock = new Clock(data.times[0] ?? 0, data.times.at(-1) ?? 0);
const charts = new Charts(clock);
onPaper(() => charts.draw());

/**
 * After the first frame is on the screen: what comes then does not keep the page from being seen. Where it is printed
 * at once there are no frames.
 */
const painted = () =>
  new Promise((resolve) => {
    requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(resolve)));
    setTimeout(resolve, 300);
  });

/** Hands the images their SVG texts, which stand in `page`. */
async function draw(page = document) {
  const images = [...document.querySelectorAll("img[data-drawing]")];
  if (images.length === 0) return;
  const texts = JSON.parse(await unpacked("drawings", page));
  for (const image of images) {
    image.src = URL.createObjectURL(new Blob([texts[Number(image.dataset.drawing)]], { type: "image/svg+xml" }));
  }
  await Promise.all(images.map((image) => image.decode().catch(() => null)));
}

/** The sliders of a live page, whose settings stand in `page`; `take` takes over a run. */
async function tuning(take, page = document) {
  if (!section("controls")) return null;
  const settings = JSON.parse(page.getElementById("live").textContent);
  const defaults = new Map(settings.parameters.map((parameter) => [parameter.name, parameter.default]));
  const show = (answer, milliseconds) => {
    take({ ...read(answer.data), others: data.others }, answer.bonds);
    texts(answer, milliseconds, made.values, defaults);
  };
  section("controls").replaceChildren();
  const made = new Tuning(section("controls"), settings, await model(), show);
  return made;
}

/** So many charts are seen at once. */
const FEW = 6;

/** A field that leaves those charts whose names have its text. */
function filter(outputs) {
  const label = { placeholder: "only outputs with \u2026", "aria-label": "Filter the outputs" };
  const field = element("input", { type: "search", class: "wanted", ...label });
  const choose = () => {
    const text = field.value.trim().toLowerCase();
    for (const { place, title, curves } of charts.in(outputs)) {
      const names = [title, ...curves.map(({ name }) => name), ...curves.map(({ column }) => column ?? "")];
      place.hidden = !names.some((name) => name.toLowerCase().includes(text));
    }
  };
  field.addEventListener("input", choose);
  outputs.before(field);
  return { field, choose };
}

/** Fills the page; `machine` has what makes the section of the machine and the modes that it swings in. */
async function start({ motion, modes }) {
  const mark = player(section("player"), clock, data.events);
  const outputs = section("chart-list");
  for (const chart of withOthers(data.charts, data.times, data.others)) charts.add(outputs, data.times, chart);
  const wanted = data.charts.length > FEW ? filter(outputs) : null;
  for (const chart of data.balance) charts.add(section("balance-charts"), data.times, chart);
  // Where the machine is to move at once, that comes first.
  if (!plays) await painted();
  const view = data.animation && motion ? motion(section("machine"), data.animation, clock) : null;
  const swings = view && modes(view, clock);
  if (data.modes) swings?.(section("modes"), data.modes);
  if (plays) {
    clock.play();
    // A page around this one waits with what would keep the machine from moving.
    requestAnimationFrame(() => {
      performance.mark("moving");
      dispatchEvent(new Event("moving"));
    });
  }
  const parts = { clock, charts, view, faults };
  const drawn = async (page) => graph(section("picture"), JSON.parse(await unpacked("bonds", page)), charts);
  parts.picture = section("picture") ? await drawn(document) : null;
  onPaper((isPaper) => view?.print(isPaper));
  parts.against = section("against") ? new Against(section("against"), () => charts.in(outputs), clock) : null;
  /** Shows another run of the same model. */
  const take = ({ times, events, animation, charts: shown, balance, others }, bonds) => {
    if (animation) view?.update(animation);
    clock.span(times[0], times.at(-1));
    mark(events);
    charts.replace(outputs, times, withOthers(shown, times, others));
    wanted?.choose();
    if (section("balance-charts")) charts.replace(section("balance-charts"), times, balance);
    parts.against?.update();
    parts.picture?.update(bonds);
  };
  parts.live = await tuning(take);
  await draw();
  /**
   * Shows another report, an HTML text, in the place of this one, where it is one of the same sections, charts and
   * bodies; whether it is. What the reader has chosen stays, and so does the time.
   */
  window.renew = async (html) => {
    const page = new DOMParser().parseFromString(html, "text/html");
    const next = dataOf(page);
    if (!isOfOneKind([document, data], [page, next])) return false;
    data = next;
    const bonds = JSON.parse(await unpacked("bonds", page));
    take(data, bonds);
    const isDrawnAnew = bringOver(page);
    if (data.modes) swings?.(section("modes"), data.modes);
    if (isDrawnAnew) {
      parts.picture?.end();
      parts.picture = await drawn(page);
    }
    parts.live = await tuning(take, page);
    await draw(page);
    return true;
  };
  return parts;
}

/** Fills the page as its address asks for: as it is, under test, or with the machine alone. */
export function begin(machine) {
  const started = () => start(machine);
  if (location.hash === "#test") trial(started);
  else if (location.hash.startsWith("#still=") && machine.still) machine.still(started);
  else
    started()
      .catch((fault) => console.error(fault))
      .finally(() => hold?.contentDocument.close());
}
