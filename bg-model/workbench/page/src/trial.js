// What a test sees of the page: with `#test` in the address it plays, scrubs, looks, and writes what it finds into the
// document, as JSON in `<pre id="verdict">`. A browser that writes out its document waits for that: the loader holds
// it.

import { element } from "./page.js";

const pause = (milliseconds) =>
  new Promise((resolve) => {
    setTimeout(resolve, milliseconds);
  });
/** The next frame of the screen; a browser that draws none while nothing moves is not waited for. */
const frame = () =>
  Promise.race([
    pause(200),
    new Promise((resolve) => {
      requestAnimationFrame(() => requestAnimationFrame(resolve));
    }),
  ]);

/* global hold */

/** How many colours the machine's picture has; 0 without one. */
function colours(view) {
  if (view === null) return 0;
  view.renderer.render(view.scene, view.camera);
  const copy = element("canvas", { width: 160, height: 120 });
  const context = copy.getContext("2d");
  context.drawImage(view.canvas, 0, 0, 160, 120);
  const bytes = context.getImageData(0, 0, 160, 120).data;
  const found = new Set();
  for (let k = 0; k < bytes.length; k += 4) found.add((bytes[k] << 16) | (bytes[k + 1] << 8) | bytes[k + 2]);
  return found.size;
}

/** Presses at a part of a chart's width, 0 to 1. */
function press(over, part) {
  const { left, top, width } = over.getBoundingClientRect();
  const options = { clientX: left + part * width, clientY: top + 5, button: 0, pointerId: 1, bubbles: true };
  over.setPointerCapture = () => {};
  over.dispatchEvent(new PointerEvent("pointerdown", options));
}

export async function trial(start) {
  const page = await start();
  const verdict = { ready_ms: performance.now(), faults: page.faults };
  await found(verdict, page).catch((fault) => page.faults.push(fault.stack ?? String(fault)));
  document.body.append(element("pre", { id: "verdict", hidden: true }, JSON.stringify(verdict)));
  hold?.contentDocument.close();
}

/** How far a body moves in the first mode, m, and how far off it is when the time is set again. */
async function swing(view, clock, poses) {
  const button = document.querySelector("button[data-mode]:not([hidden])");
  if (!view || !button) return null;
  const before = poses();
  button.click();
  const apart = (a, b) => Math.max(...a.map((place, body) => Math.hypot(...place.map((x, k) => x - b[body][k]))));
  await pause(300);
  const first = poses();
  // A busy machine may be slow with the next frame.
  for (let waited = 0; apart(first, poses()) < 1e-3 && waited < 5000; waited += 50) await pause(50);
  const moved = apart(first, poses());
  const pressed = button.getAttribute("aria-pressed");
  clock.seek(clock.time * 0.5);
  clock.seek(clock.time * 2);
  await frame();
  return { moved, pressed, back: apart(before, poses()) };
}

/** Moves the first slider to three quarters and waits for the run; what the page then shows. */
async function tuned({ charts, live }) {
  if (!live) return null;
  const [{ slider, parameter }] = live.controls;
  const answered = new Promise((resolve) => {
    live.answered = resolve;
  });
  const begin = performance.now();
  slider.value = Number(slider.min) + 0.75 * (slider.max - slider.min);
  slider.dispatchEvent(new Event("input"));
  await answered;
  await frame();
  const [chart] = charts.all;
  return {
    name: parameter.name,
    value: live.values.get(parameter.name),
    fault: live.fault,
    curve: chart.curves[0].name,
    last: chart.values[0].at(-1),
    computed: live.milliseconds,
    milliseconds: performance.now() - begin,
  };
}

/** What is drawn against what, and that its dot follows the time. */
async function path(against, clock) {
  if (!against) return null;
  const dot = () => ["cx", "cy"].map((name) => Number(against.place.querySelector(".dot").getAttribute(name)));
  clock.seek(clock.start);
  const first = dot();
  clock.seek(clock.end);
  const last = dot();
  const paths = against.place.querySelectorAll("path[d^=M]").length;
  return { chosen: against.lists.map((list) => list.value), paths, first, last };
}

async function found(verdict, { clock, charts, view, picture, live, against }) {
  await frame();
  clock.speed = (clock.end - clock.start) / 2;
  clock.play();
  // A busy machine may draw its first frame late.
  for (let waited = 0; clock.time === clock.start && waited < 5000; waited += 50) await pause(50);
  clock.pause();
  verdict.played_to = clock.time;
  const poses = () => view?.bodies.map(({ group }) => group.position.toArray()) ?? [];
  clock.seek(clock.end);
  await frame();
  verdict.at_end = { time: clock.time, positions: poses() };
  const slider = document.querySelector("#player input[type=range]");
  slider.value = slider.max / 2;
  slider.dispatchEvent(new Event("input"));
  await frame();
  verdict.at_middle = { time: clock.time, positions: poses() };
  const drawn = charts.all.filter((chart) => chart.over !== null);
  verdict.charts = { all: charts.all.length, drawn: drawn.length, line: drawn[0]?.lineTime ?? null };
  if (drawn.length > 0) press(drawn[0].over, 0.25);
  await frame();
  verdict.pressed_to = clock.time;
  verdict.colours = colours(view);
  verdict.photo = view?.copied().getContext("2d").getImageData(0, 0, 1, 1).data[3] ?? null;
  verdict.csv = charts.all[0]?.csv().split("\n").slice(0, 2) ?? null;
  verdict.swing = await swing(view, clock, poses);
  if (picture) {
    picture.show(0);
    await frame();
    verdict.bond_charts = document.querySelectorAll(".bond-panel .chart").length;
  }
  verdict.against = await path(against, clock);
  verdict.live = await tuned({ charts, live });
  dispatchEvent(new Event("beforeprint"));
  verdict.blank_on_paper = charts.all.filter((chart) => chart.over === null).length;
  dispatchEvent(new Event("afterprint"));
  const { scrollWidth, clientWidth } = document.documentElement;
  const drawings = [...document.querySelectorAll("img[data-drawing]")];
  await Promise.all(drawings.map((image) => image.decode()));
  verdict.drawings = drawings.map((image) => image.naturalWidth);
  verdict.overflow = scrollWidth - clientWidth;
}
