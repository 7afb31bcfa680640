// The section of the moving machine: the view and what can be chosen of it.
// In: the page's data, a clock. Out: the view, or `null` where there is nothing to show it with.

import { USUAL } from "./arrows.js";
import { download, element, number } from "./page.js";
import { film } from "./film.js";
import { MachineView, VIEWS, webgl } from "./scene.js";

export function motion(section, animation, clock) {
  const place = element("div", { class: "view" });
  section.append(place);
  let renderer;
  try {
    renderer = webgl();
  } catch (fault) {
    place.append(
      element("p", { class: "note" }, `The machine cannot be drawn: this browser gives no WebGL (${fault.message}).`),
    );
    return null;
  }
  const view = new MachineView(place, renderer, animation, clock);
  place.append(viewButtons(view), pictureButtons(view, clock));
  tips(place, view);
  const options = element("div", { class: "options" });
  if (view.arrows.largest > 0) options.append(forceOptions(view));
  options.append(traceOptions(view));
  section.append(options);
  return view;
}

function viewButtons(view) {
  const button = (name) =>
    element("button", { type: "button", title: `Look at all of it: ${name}`, onclick: () => view.look(name) }, name);
  return element("div", { class: "views" }, ...Object.keys(VIEWS).map(button));
}

/** A photo of the view, and a film of the run from where the bar is, at the bar's speed. */
function pictureButtons(view, clock) {
  const name = document.title || "machine";
  const photo = element(
    "button",
    {
      type: "button",
      title: "Save this view as a picture",
      onclick: () => view.copied().toBlob((picture) => download(`${name}.png`, picture)),
    },
    "photo",
  );
  const buttons = element("div", { class: "views pictures" }, photo);
  if (globalThis.MediaRecorder && HTMLCanvasElement.prototype.captureStream) buttons.append(film(view, clock, name));
  return buttons;
}

/** The name of what the pointer is on. */
function tips(place, view) {
  const tip = element("div", { class: "tip", hidden: true });
  place.append(tip);
  place.addEventListener("pointermove", (event) => {
    const text = event.buttons === 0 && event.target === view.canvas ? view.under(event) : null;
    tip.hidden = text === null;
    if (text === null) return;
    const { left, top, width } = place.getBoundingClientRect();
    tip.textContent = text;
    tip.style.left = `${Math.min(event.clientX - left + 12, width - tip.offsetWidth - 4)}px`;
    tip.style.top = `${event.clientY - top + 14}px`;
  });
  place.addEventListener("pointerleave", () => {
    tip.hidden = true;
  });
}

function forceOptions(view) {
  const box = element("input", { type: "checkbox", checked: true, onchange: () => view.forces(box.checked) });
  const scale = element("input", {
    type: "range",
    min: -1,
    max: 2,
    step: 0.01,
    value: 0,
    "aria-label": "Length of the arrows",
    oninput: () => {
      view.forces(box.checked, 10 ** Number(scale.value));
      say();
    },
  });
  const most = element("span", { class: "note" });
  const say = () => {
    const { largest, reference, isCut } = view.arrows;
    const above = 2 * reference * 10 ** -Number(scale.value);
    const cut = `; arrows of more than ${number(above, 3)} N are cut, ${100 * USUAL} % are below ${number(reference, 3)} N`;
    most.textContent = `up to ${number(largest, 3)} N${isCut ? cut : ""}`;
  };
  view.onUpdate(say);
  return element(
    "div",
    { class: "option" },
    element("label", { class: "check" }, box, "joint forces"),
    scale,
    most,
  );
}

function traceOptions(view) {
  const chips = view.points().map((point, index) => {
    const toggle = () => {
      const isShown = chip.getAttribute("aria-pressed") !== "true";
      chip.setAttribute("aria-pressed", String(isShown));
      view.trace(point.key, isShown);
    };
    const chip = element(
      "button",
      {
        type: "button",
        class: "chip",
        "aria-pressed": "false",
        style: `--hue: var(--hue-${point.body % 7})`,
        onclick: toggle,
      },
      point.name,
    );
    if (index === 0) toggle();
    return chip;
  });
  const list = element("div", { class: "chips" }, ...chips);
  return element(
    "details",
    { class: "option traces", open: chips.length <= 8 },
    element("summary", {}, "paths of points"),
    list,
  );
}
