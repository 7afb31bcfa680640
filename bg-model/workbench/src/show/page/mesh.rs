//! Triangles of solids.
//!
//! In: a body. Out: for each of its solids a mesh in the body's axes, m: vertices, outward normals, triangles that turn
//! counterclockwise as seen from outside. A body without solids gets rods to its points and a ball at its origin.

use std::f64::consts::{PI, TAU};

use super::animation::{Animation, BodyTrack, NamedPoint, Shape, Solid};

type Vector = [f64; 3];

/// A triangle mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, m.
    pub positions: Vec<[f32; 3]>,
    /// A unit normal for each.
    pub normals: Vec<[f32; 3]>,
    /// Three vertices for each triangle.
    pub indices: Vec<u16>,
}

/// Sides of a cylinder, and of a sphere about its axis.
const SIDES: usize = 32;
/// Bands of a sphere from pole to pole.
const BANDS: usize = 16;
/// Radius of a rod over the size of the machine.
const ROD: f64 = 0.008;
const IDENTITY: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Animation {
    /// The diagonal of the box of all places that the bodies' origins and points pass, m.
    #[must_use]
    pub fn size(&self) -> f64 {
        let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let mut pass = |place: Vector| {
            for axis in 0..3 {
                ends[0][axis] = ends[0][axis].min(place[axis]);
                ends[1][axis] = ends[1][axis].max(place[axis]);
            }
        };
        self.ground.iter().for_each(|point| pass(point.at));
        for body in &self.bodies {
            for (place, turn) in body.position.iter().zip(&body.orientation) {
                pass(*place);
                body.points.iter().for_each(|point| pass(add(*place, turned(*turn, point.at))));
            }
        }
        let square: f64 = (0..3).map(|axis| (ends[1][axis] - ends[0][axis]).max(0.0).powi(2)).sum();
        if square > 0.0 { square.sqrt() } else { 1.0 }
    }
}

/// `vector` turned by a unit quaternion x, y, z, w.
#[must_use]
pub fn turned([x, y, z, w]: [f64; 4], vector: Vector) -> Vector {
    let axis = [x, y, z];
    let twice = cross(axis, vector).map(|part| 2.0 * part);
    add(add(vector, twice.map(|part| w * part)), cross(axis, twice))
}

/// The meshes of a body of a machine as large as `size`, m.
pub fn meshes(body: &BodyTrack, size: f64) -> Vec<Mesh> {
    if !body.solids.is_empty() {
        return body.solids.iter().map(of_solid).collect();
    }
    let rods = body.points.iter().filter_map(|NamedPoint { at, .. }| rod(*at, ROD * size));
    let ball = Solid { shape: Shape::Sphere { radius: 2.6 * ROD * size }, at: [0.0; 3], turned: IDENTITY };
    rods.chain([of_solid(&ball)]).collect()
}

/// A rod from the origin to `end`.
fn rod(end: Vector, radius: f64) -> Option<Mesh> {
    let length = dot(end, end).sqrt();
    if length < 1e-3 * radius {
        return None;
    }
    let along = end.map(|part| part / length);
    let other = if along[0].abs() < 0.9 { IDENTITY[0] } else { IDENTITY[1] };
    let across = cross(along, other);
    let size = dot(across, across).sqrt();
    let across = across.map(|part| part / size);
    let third = cross(along, across);
    // Columns: the rod's axis x along `end`.
    let turned = std::array::from_fn(|row| [along[row], across[row], third[row]]);
    let shape = Shape::Cylinder { radius, length, axis: 0 };
    Some(of_solid(&Solid { shape, at: end.map(|part| part / 2.0), turned }))
}

fn of_solid(solid: &Solid) -> Mesh {
    let mut mesh = Mesh::default();
    match solid.shape {
        Shape::Cuboid { edges } => cuboid(&mut mesh, edges),
        Shape::Cylinder { radius, length, axis } => cylinder(&mut mesh, radius, length, axis),
        Shape::Sphere { radius } => sphere(&mut mesh, radius),
    }
    let rotated = |vector: [f32; 3]| {
        let vector = vector.map(f64::from);
        solid.turned.map(|row| dot(row, vector))
    };
    for position in &mut mesh.positions {
        *position = add(rotated(*position), solid.at).map(|part| part as f32);
    }
    for normal in &mut mesh.normals {
        *normal = rotated(*normal).map(|part| part as f32);
    }
    mesh
}

impl Mesh {
    fn vertex(&mut self, position: Vector, normal: Vector) -> u16 {
        self.positions.push(position.map(|part| part as f32));
        self.normals.push(normal.map(|part| part as f32));
        (self.positions.len() - 1) as u16
    }

    /// Two triangles of four vertices in counterclockwise order.
    fn quad(&mut self, [a, b, c, d]: [u16; 4]) {
        self.indices.extend([a, b, c, a, c, d]);
    }
}

fn cuboid(mesh: &mut Mesh, edges: Vector) {
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        for sign in [1.0, -1.0] {
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| {
                let mut corner = [0.0; 3];
                corner[axis] = sign * edges[axis] / 2.0;
                // Seen from the other side the order is the other one.
                corner[next] = sign * a * edges[next] / 2.0;
                corner[last] = b * edges[last] / 2.0;
                mesh.vertex(corner, normal)
            });
            mesh.quad(corners);
        }
    }
}

/// A unit vector across `axis` at `angle`, rad.
fn around(axis: usize, angle: f64) -> Vector {
    let mut vector = [0.0; 3];
    vector[(axis + 1) % 3] = angle.cos();
    vector[(axis + 2) % 3] = angle.sin();
    vector
}

fn cylinder(mesh: &mut Mesh, radius: f64, length: f64, axis: usize) {
    let angle = |side: usize| TAU * (side % SIDES) as f64 / SIDES as f64;
    let at = |side: usize, sign: f64| {
        let mut place = around(axis, angle(side)).map(|part| radius * part);
        place[axis] = sign * length / 2.0;
        place
    };
    for side in 0..SIDES {
        let [a, b] = [side, side + 1].map(|side| around(axis, angle(side)));
        let corners = [(side, -1.0, a), (side + 1, -1.0, b), (side + 1, 1.0, b), (side, 1.0, a)];
        let corners = corners.map(|(side, sign, normal)| mesh.vertex(at(side, sign), normal));
        mesh.quad(corners);
    }
    for sign in [1.0, -1.0] {
        let mut normal = [0.0; 3];
        normal[axis] = sign;
        let middle = mesh.vertex(normal.map(|part| part * length / 2.0), normal);
        let rim: Vec<u16> = (0..SIDES).map(|side| mesh.vertex(at(side, sign), normal)).collect();
        for side in 0..SIDES {
            let [a, b] = [rim[side], rim[(side + 1) % SIDES]];
            mesh.indices.extend(if sign > 0.0 { [middle, a, b] } else { [middle, b, a] });
        }
    }
}

fn sphere(mesh: &mut Mesh, radius: f64) {
    let mut at = |band: usize, side: usize| {
        let (latitude, angle) = (PI * band as f64 / BANDS as f64, TAU * side as f64 / SIDES as f64);
        let mut normal = around(2, angle).map(|part| part * latitude.sin());
        normal[2] = -latitude.cos();
        mesh.vertex(normal.map(|part| radius * part), normal)
    };
    let rows: Vec<Vec<u16>> = (0..=BANDS).map(|band| (0..=SIDES).map(|side| at(band, side)).collect()).collect();
    for pair in rows.windows(2) {
        for side in 0..SIDES {
            mesh.quad([pair[0][side], pair[0][side + 1], pair[1][side + 1], pair[1][side]]);
        }
    }
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] + b[k])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The volume that triangles enclose, by the divergence theorem: negative where they are turned inside out.
    fn volume(mesh: &Mesh) -> f64 {
        let vertex = |index: u16| mesh.positions[usize::from(index)].map(f64::from);
        let part = |triangle: &[u16]| dot(vertex(triangle[0]), cross(vertex(triangle[1]), vertex(triangle[2]))) / 6.0;
        mesh.indices.chunks(3).map(part).sum()
    }

    #[test]
    fn solids_enclose_their_volume_and_look_outward() {
        // A polygon of 32 sides has 0.9936 of the circle's area; a sphere of 16 bands loses some more.
        let solids = [
            (Shape::Cuboid { edges: [0.2, 0.3, 0.5] }, 0.03, 1e-6),
            (Shape::Cylinder { radius: 0.1, length: 0.4, axis: 0 }, PI * 0.004, 0.01),
            (Shape::Cylinder { radius: 0.1, length: 0.4, axis: 2 }, PI * 0.004, 0.01),
            (Shape::Sphere { radius: 0.1 }, 4.0 / 3.0 * PI * 1e-3, 0.02),
        ];
        for (shape, expected, share) in solids {
            let mesh = of_solid(&Solid {
                shape,
                at: [1.0, -2.0, 0.5],
                turned: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            });
            assert!((volume(&mesh) / expected - 1.0).abs() < share, "{shape:?}: {}", volume(&mesh));
            let normals = mesh.normals.iter().map(|normal| normal.map(f64::from));
            for (position, normal) in mesh.positions.iter().zip(normals) {
                let from_centre = add(position.map(f64::from), [-1.0, 2.0, -0.5]);
                assert!(dot(from_centre, normal) > 0.0 && (dot(normal, normal) - 1.0).abs() < 1e-5, "{shape:?}");
            }
        }
    }

    #[test]
    fn a_rod_reaches_its_point() {
        let end = [0.3, -0.4, 0.1];
        let mesh = rod(end, 0.01).unwrap();
        let reach = |mesh: &Mesh| {
            mesh.positions.iter().map(|place| dot(place.map(f64::from), end) / dot(end, end)).fold(0.0, f64::max)
        };
        assert!((reach(&mesh) - 1.0).abs() < 1e-5 && volume(&mesh) > 0.0);
        assert!(rod([0.0; 3], 0.01).is_none());
    }

    #[test]
    fn a_quaternion_turns_a_vector() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let [x, y, z] = turned([0.0, 0.0, half, half], [1.0, 0.0, 0.0]);
        assert!((x.abs() + (y - 1.0).abs() + z.abs()) < 1e-15);
    }
}
