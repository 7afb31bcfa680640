// The data of the page, with a value for each sample where the file has one number for all of them.
// In: the JSON that bg-workbench's `page/data.rs` writes. Out: the same as objects; tracks of bodies and joints
// as arrays of numbers, x y z (w) of one sample after the other.

/** A series as an array of `count` values. */
export function filled(series, count) {
  return Array.isArray(series) ? series : new Array(count).fill(series);
}

/** Series of components, woven into one array. */
function woven(components, count) {
  const all = new Float32Array(components.length * count);
  components.forEach((series, axis) => {
    for (let k = 0; k < count; k += 1) all[k * components.length + axis] = Array.isArray(series) ? series[k] : series;
  });
  return all;
}

function motion({ times, bodies, joints, ...rest }) {
  const track = (components) => woven(components, times.length);
  return {
    ...rest,
    times,
    bodies: bodies.map((body) => ({ ...body, position: track(body.position), orientation: track(body.orientation) })),
    joints: joints.map((joint) => ({ ...joint, place: track(joint.place), force: track(joint.force) })),
  };
}

/** The data of a run. */
export function read(data) {
  const chart = ({ curves, ...rest }) => ({
    ...rest,
    curves: curves.map((curve) => ({ ...curve, values: filled(curve.values, data.times.length) })),
  });
  return {
    ...data,
    charts: data.charts.map(chart),
    balance: data.balance.map(chart),
    others: data.others.map(({ columns, ...rest }) => ({
      ...rest,
      columns: columns.map((column) => ({ ...column, values: filled(column.values, rest.times.length) })),
    })),
    animation: data.animation && motion(data.animation),
  };
}
