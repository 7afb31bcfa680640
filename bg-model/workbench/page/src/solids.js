// What a body looks like: its solids, or rods between its points and its centre of mass.
// In: a body of the page's data, the size of the machine (m). Out: a group in the body's axes.

import {
  BoxGeometry,
  CylinderGeometry,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";

const UP = new Vector3(0, 1, 0);

/** The geometry of a solid; a cylinder of three.js stands along y. */
function geometry({ shape }) {
  switch (shape.kind) {
    case "cuboid":
      return new BoxGeometry(...shape.edges);
    case "cylinder": {
      const made = new CylinderGeometry(shape.radius, shape.radius, shape.length, 48);
      if (shape.axis === 0) made.rotateZ(-Math.PI / 2);
      if (shape.axis === 2) made.rotateX(Math.PI / 2);
      return made;
    }
    default:
      return new SphereGeometry(shape.radius, 32, 20);
  }
}

/** The pose of a solid in its body's axes; `turned` has the rows of the rotation matrix. */
function pose({ at, turned }) {
  const [x, y, z] = turned;
  return new Matrix4().set(...x, at[0], ...y, at[1], ...z, at[2], 0, 0, 0, 1);
}

/** A round rod from `a` to `b`. */
export function rod(a, b, radius, material) {
  const [from, to] = [new Vector3(...a), new Vector3(...b)];
  const along = to.clone().sub(from);
  const length = along.length();
  const mesh = new Mesh(new CylinderGeometry(radius, radius, length, 16), material);
  mesh.position.copy(from).addScaledVector(along, 0.5);
  mesh.quaternion.copy(new Quaternion().setFromUnitVectors(UP, along.divideScalar(length || 1)));
  return mesh;
}

/** A ball at `at`. */
export function ball(at, radius, material) {
  const mesh = new Mesh(new SphereGeometry(radius, 24, 16), material);
  mesh.position.set(...at);
  return mesh;
}

/** The materials of a body: its faces, its edges. */
export function materials() {
  return {
    faces: new MeshStandardMaterial({
      roughness: 0.55,
      metalness: 0.05,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    }),
    edges: new LineBasicMaterial({ transparent: true, opacity: 0.55 }),
  };
}

/** The body's group, its meshes marked with its name. */
export function body({ name, solids, points }, size, { faces, edges }) {
  const group = new Group();
  for (const solid of solids) {
    const mesh = new Mesh(geometry(solid), faces);
    mesh.applyMatrix4(pose(solid));
    mesh.add(new LineSegments(new EdgesGeometry(mesh.geometry, 25), edges));
    group.add(mesh);
  }
  const thin = 0.008 * size;
  if (solids.length === 0) {
    for (const { at } of points) {
      if (Math.hypot(...at) > 1e-9 * size) group.add(rod([0, 0, 0], at, thin, faces), ball(at, 1.25 * thin, faces));
    }
    group.add(ball([0, 0, 0], 2.6 * thin, faces));
  }
  group.traverse((part) => {
    if (part.isMesh) part.userData.label = name;
  });
  return group;
}
