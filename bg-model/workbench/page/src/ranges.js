// The range of a parameter's slider.
// In: a parameter of the page's settings: its value and default, the ends of what is allowed. Out: the ends of the
// slider, and values that are round on it.

/** About a value: a fifth of it to five times it; -1 to 1 about zero. */
function about(value) {
  if (value === 0) return [-1, 1];
  return [0.2 * value, 5 * value].sort((a, b) => a - b);
}

/** The ends of the slider: what is allowed where that is bounded, else about the default; `value` is between them. */
export function rangeOf({ lower, upper, includes, default: usual }, value) {
  let [low, high] = lower !== null && upper !== null ? [lower, upper] : about(usual);
  low = Math.max(Math.min(low, value), lower ?? -Infinity);
  high = Math.min(Math.max(high, value), upper ?? Infinity);
  // An end that is not allowed itself is nearly reached.
  const near = (high - low) / 1000;
  if (low === lower && !includes[0]) low += near;
  if (high === upper && !includes[1]) high -= near;
  return [Math.min(low, value), Math.max(high, value)];
}

/** The round number next to `value`, a thousandth of the slider or less away and not outside. */
export function rounded(value, [low, high]) {
  const step = 10 ** Math.floor(Math.log10((high - low) / 1000 || 1));
  const near = Number((Math.round(value / step) * step).toPrecision(12));
  return Math.min(Math.max(near, low), high);
}
