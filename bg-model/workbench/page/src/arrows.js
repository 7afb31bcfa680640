// Joint forces as arrows.
// In: the joints of the page's data. Out: an arrow each, from the joint along the force on its second body. A quarter of
// the machine is as long as the largest force; where a few instants have far larger ones than all others, as long as the
// force that 95 % are below, and arrows are cut at twice that.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { between } from "./clock.js";

const UP = new Vector3(0, 1, 0);
const SHARE = 0.25;
/** The part of the forces that those are below which count as usual. */
export const USUAL = 0.95;
/** How many times as large as these the largest may be without being cut, and how many times as long cut arrows are. */
const RARE = 3;
const CUT = 2;

/** The sizes of all forces of these joints over the run, N, from the least on. */
function sizes(joints) {
  const found = [];
  for (const { force } of joints) {
    for (let k = 0; k < force.length; k += 3) found.push(Math.hypot(force[k], force[k + 1], force[k + 2]));
  }
  return Float64Array.from(found).sort();
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
    const all = sizes(joints);
    this.largest = all.at(-1) ?? 0;
    const usual = all[Math.floor(USUAL * (all.length - 1))] ?? 0;
    /** Whether arrows are cut, N of the arrow that is a quarter of the machine, and the length beyond which there are none, m. */
    this.isCut = usual > 0 && this.largest > RARE * usual;
    this.reference = this.isCut ? usual : this.largest;
    this.unit = this.reference > 0 ? (SHARE * size) / this.reference : 0;
    this.most = CUT * SHARE * size;
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
      if (this.isCut) force.clampLength(0, this.most);
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
