// The report page: reads the data that the program wrote into it and makes its sections move.
// In: `<script type="application/json" id="data">`, whose form bg-workbench's `page/data.rs` says. Out: the page in motion.

import "uplot/dist/uPlot.min.css";
import "./style.css";
import { Charts } from "./charts.js";
import { Clock } from "./clock.js";
import { player } from "./controls.js";
import { read } from "./data.js";
import { graph } from "./graph.js";
import { modes } from "./modes.js";
import { motion } from "./motion.js";
import { trial } from "./trial.js";

const faults = [];
window.addEventListener("error", ({ message }) => faults.push(message));
window.addEventListener("unhandledrejection", ({ reason }) => faults.push(String(reason)));

const data = read(document.getElementById("data").textContent);
const section = (name) => document.getElementById(name);
const clock = new Clock(data.times[0] ?? 0, data.times.at(-1) ?? 0);
const charts = new Charts(clock);

/** After the next frame: what comes then does not keep the page from being seen. */
const painted = () => new Promise((resolve) => { requestAnimationFrame(() => setTimeout(resolve)); });

async function start() {
  player(section("player"), clock, data.events);
  for (const chart of data.charts) charts.add(section("chart-list"), data.times, chart);
  for (const chart of data.balance) charts.add(section("balance-charts"), data.times, chart);
  const picture = data.bonds ? graph(section("picture"), data.bonds, charts) : null;
  if (data.animation) await painted();
  const view = data.animation ? motion(section("machine"), data.animation, clock) : null;
  if (data.modes && view) modes(section("modes"), data.modes, view, clock);
  return { clock, charts, view, picture, faults };
}

if (location.hash === "#test") trial(start);
else start();
