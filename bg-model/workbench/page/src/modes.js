// The modes of the linearised machine: a table, each with a button that lets the machine swing in it.
// In: the modes of the page's data, the view, the clock. Out: buttons. The swing is scaled to be seen: the point that
// moves most moves a tenth of the machine, or a body turns by a quarter of a radian; every mode is shown with the same
// period.

import { Quaternion, Vector3 } from "three";

const PERIOD = 2;
const SHIFT = 0.1;
const TURN = 0.25;

/** The real part of a complex amplitude `[re, im]` at `phase`, rad. */
function at([re, im], phase) {
  return re * Math.cos(phase) - im * Math.sin(phase);
}

const size = (vector) => Math.hypot(...vector.flat());

/** The factor that makes a mode's swing visible. */
export function visible(mode, length) {
  const shift = Math.max(...mode.bodies.map(({ translation }) => size(translation)));
  const turn = Math.max(...mode.bodies.map(({ rotation }) => size(rotation)));
  return 1 / Math.max(shift / (SHIFT * length), turn / TURN, 1e-300);
}

/** The poses of the bodies in a mode at `now`, s: about their poses at rest, rotation vectors in inertial axes. */
export function poses(modes, mode, factor, now) {
  const phase = (2 * Math.PI * now) / PERIOD;
  return modes.bodies.map((rest, index) => {
    const { translation, rotation } = mode.bodies[index];
    const shift = new Vector3(...translation.map((part) => factor * at(part, phase)));
    const turn = new Vector3(...rotation.map((part) => factor * at(part, phase)));
    const angle = turn.length();
    const small = new Quaternion().setFromAxisAngle(angle > 0 ? turn.divideScalar(angle) : turn, angle);
    return {
      position: new Vector3(...rest.position).add(shift),
      orientation: small.multiply(new Quaternion(...rest.orientation)),
    };
  });
}

/** What fills the section of the modes of a machine with their data, once or again: buttons that let it swing. */
export function modes(view, clock) {
  let buttons = [];
  const stop = () => {
    view.swinging(null);
    buttons.forEach((button) => button.setAttribute("aria-pressed", "false"));
  };
  // The run goes on where the reader plays or scrubs it.
  let time = clock.time;
  clock.subscribe((now) => {
    if (view.swing && (now.playing || now.time !== time)) stop();
    time = now.time;
  });
  return (section, data) => {
    buttons = [...section.querySelectorAll("button[data-mode]")];
    for (const button of buttons) {
      const mode = data.modes[Number(button.dataset.mode)];
      button.hidden = mode.bodies.every(({ translation, rotation }) => size(translation) + size(rotation) === 0);
      button.addEventListener("click", () => {
        const starts = button.getAttribute("aria-pressed") !== "true";
        stop();
        if (!starts) return;
        clock.pause();
        button.setAttribute("aria-pressed", "true");
        const factor = visible(mode, view.size);
        view.swinging((now) => poses(data, mode, factor, now));
        view.place.scrollIntoView({ block: "nearest" });
      });
    }
  };
}
