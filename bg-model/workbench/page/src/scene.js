// The machine in motion.
// In: the animation of the page's data, a clock. Out: a view that can be turned, with bodies, ground, traces and
// forces.

import {
  AmbientLight,
  Box3,
  BufferGeometry,
  CanvasTexture,
  Color,
  ConeGeometry,
  DirectionalLight,
  GridHelper,
  Group,
  HemisphereLight,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Scene,
  Sprite,
  SpriteMaterial,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Arrows } from "./arrows.js";
import { between } from "./clock.js";
import { colour, element, hue, number, onScheme } from "./page.js";
import { body, materials } from "./solids.js";
import { Trace, lengthOf, path, placeAt } from "./traces.js";

/** Where the reader looks from. */
export const VIEWS = {
  "3-D": [0.45, 0.35, 1],
  front: [0, 0, 1],
  side: [1, 0, 0],
  top: [0, 1, 0.0001],
};

/** What draws; an error where the browser gives no WebGL. */
export function webgl() {
  const renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  return renderer;
}

export class MachineView {
  constructor(place, renderer, animation, clock) {
    Object.assign(this, { place, renderer, animation, clock });
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("aria-label", "The machine in motion; drag to turn it, Ctrl and the wheel to come nearer");
    place.prepend(this.canvas);

    this.scene = new Scene();
    // What has inertial axes, turned so that y is up.
    this.world = new Group();
    this.scene.add(this.world);
    this.#stand();
    this.camera = new PerspectiveCamera(32, 1, 0.001, 1000);
    this.box = this.#extent();
    this.size = Math.max(this.box.getSize(new Vector3()).length(), 1e-6);
    this.#light();
    this.listeners = [];
    this.traces = new Map();
    this.bodies = animation.bodies.map(() => ({ material: materials() }));
    this.#ground();
    this.#machine();
    this.#tint();

    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableZoom = false;
    this.controls.addEventListener("change", () => this.draw());
    // The wheel scrolls the page until the reader has clicked into the view or holds Ctrl.
    const zooms = (event) => {
      this.controls.enableZoom = event.ctrlKey || event.metaKey || document.activeElement === this.canvas;
    };
    place.addEventListener("wheel", zooms, { capture: true, passive: true });
    this.look("3-D");

    new ResizeObserver(() => this.#resize()).observe(place);
    this.#resize();
    clock.subscribe(() => this.#follow());
    onScheme(() => {
      this.#tint();
      this.draw();
    });
  }

  /** Turns inertial axes so that things fall along -y. */
  #stand() {
    this.upright = new Quaternion(...this.animation.upright);
    this.world.quaternion.copy(this.upright);
  }

  /** What the machine passes over the run, y up. */
  #extent() {
    const { times, bodies, ground } = this.animation;
    const box = new Box3();
    const pass = (place) => box.expandByPoint(place.applyQuaternion(this.upright));
    for (const { at } of ground) pass(new Vector3(...at));
    for (const track of bodies) {
      const near = track.solids.flatMap(({ at, shape }) => {
        const reach = Math.max(
          ...(shape.edges ?? []).map((edge) => edge / 2),
          shape.radius ?? 0,
          (shape.length ?? 0) / 2,
        );
        return [-1, 1].flatMap((sign) =>
          [0, 1, 2].map((axis) => at.map((x, k) => (k === axis ? x + 0.7 * sign * reach : x))),
        );
      });
      const points = [[0, 0, 0], ...track.points.map(({ at }) => at), ...near];
      const stride = Math.max(1, Math.floor(times.length / 300));
      for (let k = 0; k < times.length; k += stride) points.forEach((at) => pass(placeAt(track, at, k)));
    }
    return box;
  }

  #light() {
    this.scene.add(new AmbientLight(0xffffff, 0.55), new HemisphereLight(0xffffff, 0x8090a0, 1.1));
    for (const [direction, strength] of [
      [[0.6, 1, 0.9], 1.9],
      [[-0.8, 0.3, 0.5], 0.6],
    ]) {
      const light = new DirectionalLight(0xffffff, strength);
      light.position.set(...direction);
      this.scene.add(light);
    }
  }

  /** Bodies, supports and forces, as the animation has them. */
  #machine() {
    const { times, bodies, ground, joints } = this.animation;
    for (const part of [...this.bodies.map(({ group }) => group), this.supports, this.arrows?.group]) discard(part);
    this.bodies = this.bodies.map(({ material }, index) => {
      const group = body(bodies[index], this.size, material);
      return { track: bodies[index], group, material };
    });
    this.supports = new Group();
    for (const { name, at } of ground) this.supports.add(this.#supportAt(name, at));
    this.arrows = new Arrows(times, joints, this.size, this.arrows?.material);
    this.world.add(...this.bodies.map(({ group }) => group), this.arrows.group);
    this.scene.add(this.supports);
  }

  #supportAt(name, at) {
    const height = 0.035 * this.size;
    const shape = new ConeGeometry(0.6 * height, height, 4).rotateY(Math.PI / 4).translate(0, -height / 2, 0);
    const cone = new Mesh(shape, this.support);
    cone.position.set(...at).applyQuaternion(this.upright);
    cone.userData.label = `ground.${name}`;
    return cone;
  }

  /** The machine in another run; the reader still looks from where they did. */
  update(animation) {
    this.swinging(null);
    this.animation = animation;
    this.#stand();
    this.box = this.#extent();
    const { scale } = this.arrows;
    this.#machine();
    const keys = [...this.traces.keys()];
    for (const key of keys) {
      this.trace(key, false);
      this.trace(key, true);
    }
    this.#tint();
    this.forces(this.showsForces !== false, scale);
    this.#follow();
    this.listeners.forEach((listener) => listener());
  }

  /** Calls `listener` now and after each update. */
  onUpdate(listener) {
    this.listeners.push(listener);
    listener();
  }

  /** A grid below the machine, axes at its corner. */
  #ground() {
    const { min, max } = this.box;
    const middle = this.box.getCenter(new Vector3());
    const cell = 10 ** Math.floor(Math.log10(this.size / 2));
    const cells = 2 * Math.ceil(this.size / cell);
    this.grid = new GridHelper(cells * cell, cells);
    this.grid.position.set(
      cell * Math.round(middle.x / cell),
      min.y - 0.05 * this.size,
      cell * Math.round(middle.z / cell),
    );
    this.axes = triad(0.09 * this.size);
    this.axes.quaternion.copy(this.upright);
    this.axes.position.set(min.x - 0.08 * this.size, this.grid.position.y, max.z + 0.04 * this.size);
    this.support = new MeshStandardMaterial({ roughness: 0.8 });
    this.scene.add(this.grid, this.axes);
  }

  #tint() {
    const edge = new Color(colour("paper"));
    this.bodies.forEach(({ material }, index) => {
      material.faces.color.set(hue(index));
      material.edges.color.copy(material.faces.color).lerp(edge, 0.55);
    });
    this.arrows.material.color.set(colour("force"));
    this.support.color.set(colour("axis"));
    this.grid.material.vertexColors = false;
    this.grid.material.color.set(colour("grid"));
    this.axes.children.forEach(({ material }, index) => material.color.set(hue(index % 3)));
    for (const [key, trace] of this.traces) trace.tint(hue(Number(key.split(":")[0])));
  }

  /** All points that can be traced: `{ key, name, body, at }`, the one that goes farthest first. */
  points() {
    const count = this.animation.times.length;
    const all = this.animation.bodies.flatMap((track, index) => {
      const own = [{ name: "centre", at: [0, 0, 0] }, ...track.points];
      return own.map(({ name, at }) => ({
        key: `${index}:${name}`,
        name: `${track.name}.${name}`,
        body: index,
        at,
        length: lengthOf(path(track, at, count)),
      }));
    });
    return all.sort((a, b) => b.length - a.length);
  }

  /** Draws or takes away the trace of the point of this key. */
  trace(key, isShown) {
    discard(this.traces.get(key)?.group);
    this.traces.delete(key);
    const point = isShown ? this.points().find((other) => other.key === key) : null;
    if (point) {
      const { times, bodies } = this.animation;
      const trace = new Trace(times, path(bodies[point.body], point.at, times.length), this.size);
      trace.tint(hue(point.body));
      trace.show(this.clock.time);
      this.traces.set(key, trace);
      this.world.add(trace.group);
    }
    this.draw();
  }

  /** Looks at the whole machine from one of `VIEWS`. */
  look(name) {
    this.view = name;
    const middle = this.box.getCenter(new Vector3());
    const direction = new Vector3(...VIEWS[name]).normalize();
    this.camera.position.copy(middle).addScaledVector(direction, this.#distance(direction, middle));
    this.controls.target.copy(middle);
    this.controls.update();
    this.draw();
  }

  /** How far away the whole extent is in the picture, m. */
  #distance(direction, middle) {
    const probe = new PerspectiveCamera();
    probe.position.copy(direction);
    probe.lookAt(0, 0, 0);
    const back = probe.quaternion.clone().invert();
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    for (let corner = 0; corner < 8; corner += 1) {
      const { min, max } = this.box;
      const at = new Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z);
      const seen = at.sub(middle).applyQuaternion(back);
      const across = Math.max(Math.abs(seen.y), Math.abs(seen.x) / (this.camera.aspect || 1));
      distance = Math.max(distance, seen.z + across / slope);
    }
    return 1.15 * distance + 0.05 * this.size;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    const turned = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.near = 0.001 * this.size;
    this.camera.far = 60 * this.size;
    this.camera.updateProjectionMatrix();
    if (Math.abs(turned - this.camera.aspect) > 0.02) this.look(this.view);
    this.draw();
  }

  #follow() {
    if (this.swing) return;
    const { time } = this.clock;
    const { index, next, part } = between(this.animation.times, time);
    for (const { track, group } of this.bodies) {
      const [a, b] = [index, next].map((k) => new Quaternion().fromArray(track.orientation, 4 * k));
      group.quaternion.copy(a.slerp(b, part));
      const [from, to] = [index, next].map((k) => new Vector3().fromArray(track.position, 3 * k));
      group.position.copy(from.lerp(to, part));
    }
    this.arrows.show(time);
    for (const trace of this.traces.values()) trace.show(time);
    this.draw();
  }

  /** Shows the poses that `swing(now)` gives, positions and orientations, in place of the run's; `null` ends that. */
  swinging(swing) {
    this.swing = swing;
    this.arrows.group.visible = this.showsForces !== false && !swing;
    for (const { group } of this.traces.values()) group.visible = !swing;
    if (!swing) {
      this.#follow();
      return;
    }
    const frame = (now) => {
      if (this.swing !== swing) return;
      swing(now / 1000).forEach(({ position, orientation }, index) => {
        this.bodies[index].group.position.copy(position);
        this.bodies[index].group.quaternion.copy(orientation);
      });
      this.draw();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** Shows the joint forces, `scale` times as long as at first, or hides them. */
  forces(isShown, scale = this.arrows.scale) {
    this.showsForces = isShown;
    this.arrows.group.visible = isShown && !this.swing;
    this.arrows.scale = scale;
    this.arrows.show(this.clock.time);
    this.draw();
  }

  /** What is under a place on the screen, in words; `null` where there is nothing. */
  under({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const hit = ray
      .intersectObjects(this.scene.children, true)
      .find(({ object }) => object.userData.label && shown(object));
    if (!hit) return null;
    const joint = this.arrows.arrows.findIndex(({ shaft, tip }) => hit.object === shaft || hit.object === tip);
    const { label } = hit.object.userData;
    return joint < 0 ? label : `${label}: ${number(this.arrows.force(joint, this.clock.time).length(), 4)} N`;
  }

  /** What is seen, with the page's background: drawn into `copy`, or into a new canvas. */
  copied(copy = element("canvas", { width: this.canvas.width, height: this.canvas.height })) {
    this.renderer.render(this.scene, this.camera);
    const context = copy.getContext("2d");
    context.fillStyle = colour("paper");
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(this.canvas, 0, 0, copy.width, copy.height);
    return copy;
  }

  /** Puts a copy in the place of the view: a browser prints none of its own. */
  print(isPaper) {
    this.copy?.remove();
    this.copy = null;
    if (!isPaper) return;
    this.copy = this.copied();
    this.copy.className = "copy";
    this.canvas.after(this.copy);
  }

  /** Draws with the next frame of the screen, however often it is asked for until then. */
  draw() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
}

/** Takes an object out of the scene, if there is one, with its geometries; materials are used again. */
function discard(object) {
  object?.removeFromParent();
  object?.traverse(({ geometry }) => geometry?.dispose());
}

/** Whether an object and all it is part of are visible. */
function shown(object) {
  return object === null || (object.visible && shown(object.parent));
}

/** Lines along x, y and z with their letters, which get the colours of these components in the charts. */
function triad(length) {
  const axes = [0, 1, 2];
  const along = (axis, way) => new Vector3().setComponent(axis, way * length);
  const line = (axis) => {
    const geometry = new BufferGeometry().setFromPoints([new Vector3(), along(axis, 1)]);
    return new Line(geometry, new LineBasicMaterial());
  };
  const lettered = (axis) => {
    const sprite = new Sprite(new SpriteMaterial({ map: letter("xyz"[axis]), depthTest: false }));
    sprite.position.copy(along(axis, 1.25));
    sprite.scale.setScalar(0.55 * length);
    return sprite;
  };
  return new Group().add(...axes.map(line), ...axes.map(lettered));
}

/** A letter as a texture, white: the material has the colour. */
function letter(text) {
  const canvas = element("canvas", { width: 64, height: 64 });
  const context = canvas.getContext("2d");
  Object.assign(context, { font: "bold 52px system-ui, sans-serif", fillStyle: "white" });
  Object.assign(context, { textAlign: "center", textBaseline: "middle" });
  context.fillText(text, 32, 32);
  return new CanvasTexture(canvas);
}
