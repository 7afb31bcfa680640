// The texts of a live page that follow a new run: head, notes, statistics, statements, table of parameters.
// In: an answer of the model (bg-workbench's `live`). Out: the page's elements with its texts.

import { element, number } from "./page.js";

const section = (name) => document.getElementById(name);

/** What is said of sections that stay as they were written. */
const STAYS = "As the file was written: this does not follow the sliders.";

function facts(lines) {
  for (const item of document.querySelectorAll(".facts li")) {
    const name = item.querySelector("b");
    const line = lines.find(([of]) => of === name.textContent);
    if (line) item.replaceChildren(name, line[1]);
  }
}

function statistics(lines) {
  const list = section("statistics").querySelector("dl");
  list.replaceChildren(...lines.flatMap(([name, text]) => [element("dt", {}, name), element("dd", {}, text)]));
}

function statements(checks) {
  const rows = [...document.querySelectorAll("#statements tr")].slice(1);
  rows.forEach((row, index) => {
    const check = checks[index];
    if (!check) return;
    const [figure, statement, measured, verdict] = row.children;
    figure.textContent = check.figure;
    statement.textContent = check.statement;
    measured.textContent = check.measured;
    verdict.textContent = check.holds ? "\u2713 holds" : "\u2717 does not hold";
    verdict.className = check.holds ? "holds" : "fails";
  });
}

function parameters(values, defaults) {
  for (const row of document.querySelectorAll("#parameters tr")) {
    const name = row.querySelector("code")?.textContent;
    if (!values.has(name)) continue;
    row.querySelector(".number").textContent = number(values.get(name), 8);
    row.classList.toggle("changed", values.get(name) !== defaults.get(name));
  }
}

function stays() {
  for (const name of ["modes", "figures"]) {
    const place = section(name);
    if (place && !place.querySelector(".stays")) {
      place.querySelector("h2").after(element("p", { class: "note stays" }, STAYS));
    }
  }
}

/** Shows the texts of an answer that took so many milliseconds. */
export function texts({ lines, note, balance, checks }, milliseconds, values, defaults) {
  const all = [...lines, ["wall time", `${number(milliseconds / 1000, 3)} s in this page`]];
  facts(all);
  statistics(all);
  statements(checks);
  parameters(values, defaults);
  stays();
  section("samples").textContent = note;
  if (balance !== null && section("balance")) section("balance").querySelector("p").textContent = balance;
  document.querySelector("header .failure")?.remove();
}
