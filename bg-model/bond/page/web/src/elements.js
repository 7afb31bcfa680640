// Elements, and numbers as they are read.

export { element, number } from "../../../../workbench/page/src/page.js";

/** A text with what stands between backticks as code. */
export function withCode(text) {
  return text.split("`").map((part, k) => {
    if (k % 2 === 0) return part;
    const code = document.createElement("code");
    code.textContent = part;
    return code;
  });
}

/** A time as a person reads it. */
export function lasting(milliseconds) {
  const short = (value) => Number(value.toPrecision(2));
  if (milliseconds < 1e-3) return `${short(milliseconds * 1e6)} ns`;
  if (milliseconds < 1) return `${short(milliseconds * 1e3)} \u00b5s`;
  if (milliseconds < 1000) return `${milliseconds.toFixed(0)} ms`;
  return `${short(milliseconds / 1000)} s`;
}
