// A film of the machine in motion.
// In: the view, the clock. Out: a button; pressed, the run is played from its start at the bar's speed, and what is seen
// becomes a WebM file. Pressed again, the film ends there.

import { download, element } from "./page.js";

const FRAMES = 30;

export function film(view, clock, name) {
  let recorder = null;
  const button = element(
    "button",
    {
      type: "button",
      title: "Save a film of the run, at the speed of the bar below",
      onclick: () => (recorder ? recorder.stop() : begin()),
    },
    "film",
  );
  const begin = () => {
    // With a background: a film has no transparency.
    const canvas = view.copied();
    const parts = [];
    recorder = new MediaRecorder(canvas.captureStream(FRAMES));
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    recorder.addEventListener("stop", () => {
      recorder = null;
      clock.loops = true;
      button.textContent = "film";
      clock.pause();
      download(`${name}.webm`, new Blob(parts, { type: "video/webm" }));
    });
    button.textContent = "end";
    clock.loops = false;
    clock.seek(clock.start);
    clock.play();
    recorder.start();
    const frame = () => {
      if (!recorder) return;
      view.copied(canvas);
      // The last frame is in the film as well.
      if (clock.time >= clock.end || !clock.playing) setTimeout(() => recorder?.stop(), 2000 / FRAMES);
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  };
  return button;
}
