// Other runs and measurements beside the run's own curves.
// In: charts of the run, the times of their samples, the others of the page's data. Out: the charts with a curve more
// for each column that another one has, at the same times: on straight lines between its own rows, nothing outside of
// them.

import { sampleAt } from "./clock.js";

/** The values of a column at `times`. */
function at(times, own, values) {
  return times.map((time) => {
    if (own.length === 0 || time < own[0] || time > own.at(-1)) return null;
    const index = sampleAt(own, time);
    const [a, b] = [values[index], values[index + 1]];
    if (time === own[index] || b === undefined) return a;
    if (a === null || b === null) return null;
    return a + ((b - a) * (time - own[index])) / (own[index + 1] - own[index]);
  });
}

/** The charts with what `others` have of their columns; such a curve is `like` its own one and of `other`. */
export function withOthers(charts, times, others) {
  if (others.length === 0) return charts;
  return charts.map((chart) => {
    const more = chart.curves.flatMap((curve, like) =>
      others.flatMap(({ name, times: own, columns }) => {
        const column = columns.find((known) => known.name === curve.column);
        if (!column) return [];
        return [{ name: `${curve.name}, ${name}`, values: at(times, own, column.values), like, other: name }];
      }),
    );
    return { ...chart, curves: [...chart.curves, ...more] };
  });
}
