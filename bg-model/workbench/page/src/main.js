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
import { texts } from "./texts.js";
import { trial } from "./trial.js";
import { Tuning } from "./tuning.js";

/* global hold, model, plays, unpacked */

const faults = [];
window.addEventListener("error", ({ message }) => faults.push(message));
window.addEventListener("unhandledrejection", ({ reason }) => faults.push(String(reason)));

const data = read(JSON.parse(document.getElementById("data").textContent));
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

/** Hands the images their SVG texts. */
async function draw() {
  const images = [...document.querySelectorAll("img[data-drawing]")];
  if (images.length === 0) return;
  const texts = JSON.parse(await unpacked("drawings"));
  for (const image of images) {
    image.src = URL.createObjectURL(new Blob([texts[Number(image.dataset.drawing)]], { type: "image/svg+xml" }));
  }
  await Promise.all(images.map((image) => image.decode().catch(() => null)));
}

/** The sliders of a live page; what else is on it follows them. */
async function tuning({ mark, view, picture, against, wanted }) {
  if (!section("live")) return null;
  const settings = JSON.parse(section("live").textContent);
  const defaults = new Map(settings.parameters.map((parameter) => [parameter.name, parameter.default]));
  const show = (answer, milliseconds) => {
    const { times, events, animation, ...shown } = read(answer.data);
    clock.span(times[0], times.at(-1));
    mark(events);
    charts.replace(section("chart-list"), times, withOthers(shown.charts, times, data.others));
    wanted?.choose();
    against?.update();
    if (section("balance-charts")) charts.replace(section("balance-charts"), times, shown.balance);
    if (animation) view?.update(animation);
    picture?.update(answer.bonds);
    texts(answer, milliseconds, made.values, defaults);
  };
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
  if (data.modes && view) modes(section("modes"), data.modes, view, clock);
  if (plays) {
    clock.play();
    // A page around this one waits with what would keep the machine from moving.
    requestAnimationFrame(() => {
      performance.mark("moving");
      dispatchEvent(new Event("moving"));
    });
  }
  const bonds = JSON.parse(await unpacked("bonds"));
  const picture = section("picture") ? graph(section("picture"), bonds, charts) : null;
  onPaper((isPaper) => view?.print(isPaper));
  const against = section("against") ? new Against(section("against"), () => charts.in(outputs), clock) : null;
  const live = await tuning({ mark, view, picture, against, wanted });
  await draw();
  return { clock, charts, view, picture, live, against, faults };
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
