// Joint forces as arrows.
// In: the joints of the page's data. Out: an arrow each, from the joint along the force on its second body; the
// longest force of the run is a quarter of the machine long.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { between } from "./clock.js";

const UP = new Vector3(0, 1, 0);
const SHARE = 0.25;

/** The largest size of a force of these joints over the run, N. */
export function largestForce(joints) {
  let square = 0;
  for (const { force } of joints) {
    for (let k = 0; k < force.length; k += 3)
      square = Math.max(square, force[k] ** 2 + force[k + 1] ** 2 + force[k + 2] ** 2);
  }
  return Math.sqrt(square);
}

class Arrow {
  constructor(label, size, material) {
    const width = 0.0065 * size;
    this.head = 5.5 * width;
    this.shaft = new Mesh(new CylinderGeometry(width, width, 1, 16).translate(0, 0.5, 0), material);
    this.tip = new Mesh(new ConeGeometry(2.3 * width, this.head, 20).translate(0, -this.head / 2, 0), material);
    this.group = new Group().add(this.shaft, this.tip);
    for (const part of [this.shaft, this.tip]) part.userData.label = label;
  }

  /** From `at` along `vector`, as long as it. */
  point(at, vector) {
    const length = vector.length();
    this.group.visible = length > 0.002 * this.head;
    if (!this.group.visible) return;
    this.group.position.copy(at);
    this.group.quaternion.copy(new Quaternion().setFromUnitVectors(UP, vector.clone().divideScalar(length)));
    // Of a short arrow the tip is smaller.
    const tip = Math.min(1, length / (1.6 * this.head));
    this.tip.scale.setScalar(tip);
    this.tip.position.y = length;
    this.shaft.scale.set(tip, Math.max(length - 0.9 * tip * this.head, 1e-9), tip);
  }
}

export class Arrows {
  constructor(times, joints, size, material = new MeshStandardMaterial({ roughness: 0.5 })) {
    Object.assign(this, { times, joints, material });
    this.largest = largestForce(joints);
    this.unit = this.largest > 0 ? (SHARE * size) / this.largest : 0;
    this.scale = 1;
    this.group = new Group();
    this.arrows = joints.map(({ name, kind }) => new Arrow(`${name} (${kind})`, size, this.material));
    for (const { group } of this.arrows) this.group.add(group);
  }

  /** The force of joint `index` at `time`, N. */
  force(index, time) {
    return vectorAt(this.times, this.joints[index].force, time);
  }

  show(time) {
    this.arrows.forEach((arrow, index) => {
      const force = this.force(index, time).multiplyScalar(this.unit * this.scale);
      arrow.point(vectorAt(this.times, this.joints[index].place, time), force);
    });
  }
}

/** The vector at `time` of a track of vectors, one after the other. */
export function vectorAt(times, track, time) {
  const { index, next, part } = between(times, time);
  const of = (sample) => new Vector3(track[3 * sample], track[3 * sample + 1], track[3 * sample + 2]);
  return of(index).lerp(of(next), part);
}
