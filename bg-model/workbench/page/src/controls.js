// The bar at the foot of the page: play, time, speed.
// In: a clock and the element of the bar. Out: a bar that follows the clock and sets it, and what marks the events of
// another run on it.

import { speeds } from "./clock.js";
import { element, seconds } from "./page.js";

const PLAY = "M7 4.5v15l13-7.5z";
const PAUSE = "M6 4.5h4.5v15H6zM13.5 4.5H18v15h-4.5z";
const STEPS = 10000;

function icon(path) {
  const drawing = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  drawing.setAttribute("viewBox", "0 0 24 24");
  drawing.setAttribute("aria-hidden", "true");
  const shape = document.createElementNS("http://www.w3.org/2000/svg", "path");
  shape.setAttribute("d", path);
  drawing.append(shape);
  return { drawing, show: (other) => shape.setAttribute("d", other) };
}

function speedText(speed) {
  if (speed === 1) return "real time";
  return speed > 1 ? `${speed}\u00d7 faster` : `${Number((1 / speed).toPrecision(3))}\u00d7 slower`;
}

export function player(bar, clock, events) {
  const duration = () => clock.end - clock.start;
  const symbol = icon(PLAY);
  const button = element(
    "button",
    { class: "play", "aria-label": "Play", onclick: () => clock.toggle() },
    symbol.drawing,
  );
  const slider = element("input", {
    type: "range",
    min: 0,
    max: STEPS,
    step: 1,
    "aria-label": "Time",
    oninput: (event) => clock.seek(clock.start + (duration() * event.target.value) / STEPS),
  });
  const marks = element("div", { class: "marks", "aria-hidden": "true" });
  const mark = (all) => {
    const place = (event) => (duration() > 0 ? (event - clock.start) / duration() : 0);
    const made = (event) => element("i", { style: `left:${(100 * place(event)).toFixed(3)}%` });
    marks.replaceChildren(...all.slice(0, 200).map(made));
  };
  mark(events);
  const shown = element("output", { class: "time" });
  const chosen = element("select", {
    "aria-label": "Speed",
    onchange: (event) => {
      clock.speed = Number(event.target.value);
    },
  });
  for (const speed of [...speeds(clock.speed)].reverse()) {
    chosen.append(element("option", { value: speed, selected: speed === clock.speed }, speedText(speed)));
  }
  bar.append(button, element("div", { class: "track" }, marks, slider), shown, chosen);
  clock.subscribe(({ time, playing }) => {
    symbol.show(playing ? PAUSE : PLAY);
    button.setAttribute("aria-label", playing ? "Pause" : "Play");
    const part = duration() > 0 ? (time - clock.start) / duration() : 0;
    slider.value = Math.round(STEPS * part);
    slider.style.setProperty("--part", `${100 * part}%`);
    shown.textContent = seconds(time, duration());
  });
  // The space bar plays and the arrow keys step, unless they are for the element in focus.
  document.addEventListener("keydown", (event) => {
    if (event.target.closest("input, select, button, summary, a, textarea") || event.ctrlKey || event.metaKey) return;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === " ") clock.toggle();
    else if (step) clock.seek(clock.time + (step * duration()) / 200);
    else return;
    event.preventDefault();
  });
  return mark;
}
