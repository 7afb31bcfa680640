// Small helpers for elements, numbers and colours.

/** A new element with attributes and children; `on…` attributes are listeners. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/** Saves a file on the reader's machine. */
export function download(name, blob) {
  const address = URL.createObjectURL(blob);
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** The value of the style sheet's variable `--name`. */
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** The colour of curve or body `index`. */
export function hue(index) {
  return colour(`hue-${index % 7}`);
}

/** Calls `listener` when the reader's colour scheme changes. */
export function onScheme(listener) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", listener);
}

/** Calls `listener` with whether the page is about to be printed, in light colours, or is on the screen again. */
export function onPaper(listener) {
  const { classList } = document.documentElement;
  for (const [event, isPaper] of [
    ["beforeprint", true],
    ["afterprint", false],
  ]) {
    addEventListener(event, () => {
      classList.toggle("paper", isPaper);
      listener(isPaper);
    });
  }
}

/** A number as a person reads it, to `digits` digits, with a true minus sign. */
export function number(value, digits = 5) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(digits))) : value.toExponential(digits - 2);
  return text.replace("e+", "e").replaceAll("-", "\u2212");
}

/** A time with as many decimals as the run has to show, s. */
export function seconds(value, duration) {
  const decimals = Math.min(Math.max(2 - Math.floor(Math.log10(duration || 1)), 0), 9);
  return `${value.toFixed(decimals)} s`;
}
