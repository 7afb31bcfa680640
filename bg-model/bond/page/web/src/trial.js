// What a test sees of the page: with `?test` in the address it waits for the first motion, types a fault and takes it
// back, moves a slider, follows a link, and writes what it finds into the document, as JSON in `<pre id="verdict">`. A
// browser that writes out its document waits for that: a frame whose document is open keeps the page from being loaded.

import { element } from "./elements.js";
import { written } from "./link.js";

const pause = (milliseconds) =>
  new Promise((resolve) => {
    setTimeout(resolve, milliseconds);
  });

/** What `find` gives as soon as it gives something. */
async function until(what, find) {
  for (let waited = 0; waited < 60_000; waited += 10) {
    const found = find();
    if (found) return found;
    await pause(10);
  }
  throw new Error(`waited in vain for ${what}`);
}

const frame = () => document.querySelector("#report iframe:not(.next)");
const inFrame = (selector) => frame()?.contentDocument?.querySelector(selector);
const isThere = () => document.querySelector("#report:not(.old) iframe:not(.next)") && !document.body.classList.contains("busy");

/** Waits until the machine of the frame has moved, and says when that was. */
async function moved() {
  const time = () => inFrame("#player output")?.textContent;
  await until("the machine", () => inFrame("#machine canvas"));
  const first = time();
  await until("motion", () => time() !== first);
  return performance.now();
}

/** Types over `before`, which stands once in the text. */
function retype(editor, before, after) {
  const at = editor.text.indexOf(before);
  editor.type(at, at + before.length, after);
}

async function found(page, motion, verdict) {
  verdict.motion_ms = await motion;
  await until("what was compiled", () => page.compiled);
  await until("the rate", () => page.rate);
  verdict.status = document.getElementById("status").textContent;
  verdict.rate_ms = page.rate;
  verdict.title = inFrame("h1").textContent;
  verdict.bonds = frame().contentDocument.querySelectorAll("#picture .bond").length;
  verdict.charts = frame().contentDocument.querySelectorAll("#chart-list .chart").length;
  const { scrollWidth, clientWidth } = document.documentElement;
  verdict.overflow = scrollWidth - clientWidth;

  // What is told of a function and of a word under the pointer.
  verdict.told = {};
  for (const word of ["rotation_z", "tilt"]) {
    const range = document.createRange();
    const texts = document.createTreeWalker(document.querySelector(".cm-content"), NodeFilter.SHOW_TEXT);
    while (texts.nextNode() && !texts.currentNode.data.includes(word));
    range.setStart(texts.currentNode, texts.currentNode.data.indexOf(word));
    range.setEnd(texts.currentNode, range.startOffset + word.length);
    const { left, width, top, height } = range.getBoundingClientRect();
    const place = { clientX: left + width / 2, clientY: top + height / 2, bubbles: true };
    texts.currentNode.parentElement.dispatchEvent(new MouseEvent("mousemove", place));
    const shown = await until(`what \`${word}\` is`, () => {
      const told = document.querySelector(".told");
      return told?.textContent.startsWith(word) ? told : null;
    });
    verdict.told[word] = [...shown.children].map((part) => part.textContent);
  }

  // A fault, as it is typed, after letters of two and of four bytes.
  const before = performance.now();
  retype(page.editor, "Angle at", "\u00c4ngle \u{1f600} at");
  retype(page.editor, "angle: rad = 0.5", "angle: radd = 0.5");
  const mark = await until("a fault", () => document.querySelector(".cm-lintRange-error"));
  verdict.fault_ms = performance.now() - before;
  verdict.marked = mark.textContent;
  verdict.fault = document.querySelector("#faults li").textContent;
  verdict.old = document.querySelector("#report.old") !== null;
  const kept = frame();
  retype(page.editor, "angle: radd = 0.5", "angle: rad = 0.75");
  await until("no fault", () => document.getElementById("faults").hidden && isThere());
  verdict.corrected = inFrame("#parameters td.number").textContent;
  verdict.renewed = frame() === kept;

  // A slider of the report, which this page's worker runs the model for.
  const slider = inFrame("#controls input[type=range]");
  slider.value = Number(slider.min) + 0.75 * (slider.max - slider.min);
  slider.dispatchEvent(new Event("input"));
  await until("another run", () => inFrame("#controls .status").textContent.startsWith("Run again"));
  verdict.slid = Number(inFrame("#controls input[type=number]:not([min])").value);
  verdict.changed = inFrame("#parameters tr.changed td.number").textContent;
  inFrame("nav a").click();
  await pause(100);
  verdict.section = inFrame("#controls .status").textContent !== "";

  // A link that holds another text, and another end of the run.
  const text = page.editor.text.replace("0.75", "1.25").replace("Pendulum", "Followed");
  const link = await written({ ...page.shown, text, t_end: 1.5 }, page.examples);
  location.hash = link;
  await until("what the link holds", () => inFrame("h1")?.textContent === "Followed" && isThere());
  verdict.followed = { text: page.editor.text === text, end: inFrame("#controls .end input").value, link };

  // A run that takes too long is stopped, and what comes after it is compiled as ever.
  location.hash = "example=first&end=4500";
  const stop = document.getElementById("stop");
  await until("a long run", () => !stop.hidden);
  await pause(1000);
  verdict.stopped = { offered: !stop.hidden };
  stop.click();
  Object.assign(verdict.stopped, { status: document.getElementById("status").textContent, hidden: stop.hidden });

  // The hacksaw, chosen from the examples.
  const begin = performance.now();
  const example = document.getElementById("example");
  example.value = "hacksaw";
  example.dispatchEvent(new Event("change"));
  await until("the hacksaw", () => inFrame("h1")?.textContent === "Hacksaw: Motion" && inFrame("#machine canvas"));
  verdict.hacksaw_ms = performance.now() - begin;
  await until("the hacksaw's rate", isThere);
  verdict.hacksaw = document.getElementById("status").textContent;
  verdict.hacksaw_rate_ms = page.rate;
  verdict.scenes = document.getElementById("scene").length;
}

export async function trial(began, faults) {
  const hold = document.body.appendChild(element("iframe", { hidden: true }));
  hold.contentDocument.open();
  const verdict = { faults };
  const motion = moved();
  await began.then((page) => found(page, motion, verdict)).catch((fault) => faults.push(fault.stack ?? String(fault)));
  document.body.append(element("pre", { id: "verdict", hidden: true }, JSON.stringify(verdict)));
  hold.contentDocument.close();
}
