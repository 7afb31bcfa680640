// Paths of points of the bodies over the run.
// In: a body's track and a point in its axes. Out: a faint line of the whole path and a strong one of what has passed.

import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { between } from "./clock.js";

/** The place of a point of the body at sample `k`, m. */
export function placeAt({ position, orientation }, at, k) {
  const turned = new Vector3(...at).applyQuaternion(new Quaternion().fromArray(orientation, 4 * k));
  return turned.add(new Vector3().fromArray(position, 3 * k));
}

/** The path of the point, one place a sample, m. */
export function path(body, at, count) {
  const places = new Float32Array(3 * count);
  for (let k = 0; k < count; k += 1) placeAt(body, at, k).toArray(places, 3 * k);
  return places;
}

/** The length of a path, m. */
export function lengthOf(places) {
  let length = 0;
  for (let k = 3; k < places.length; k += 3) {
    length += Math.hypot(places[k] - places[k - 3], places[k + 1] - places[k - 2], places[k + 2] - places[k - 1]);
  }
  return length;
}

export class Trace {
  constructor(times, places, size) {
    Object.assign(this, { times, places });
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3));
    this.passed = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3));
    this.faint = new LineBasicMaterial({ transparent: true, opacity: 0.28 });
    this.strong = new LineBasicMaterial();
    this.dot = new Mesh(new SphereGeometry(0.009 * size, 16, 12), new MeshStandardMaterial({ roughness: 0.5 }));
    this.group = new Group().add(new Line(geometry, this.faint), new Line(this.passed, this.strong), this.dot);
    this.group.children.forEach((part) => {
      part.frustumCulled = false;
    });
  }

  tint(shade) {
    for (const material of [this.faint, this.strong, this.dot.material]) material.color.set(shade);
  }

  show(time) {
    const { index, next, part } = between(this.times, time);
    this.passed.setDrawRange(0, index + 1);
    const of = (sample) => new Vector3().fromArray(this.places, 3 * sample);
    this.dot.position.copy(of(index).lerp(of(next), part));
  }
}
