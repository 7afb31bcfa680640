//! The mass matrix in the file's pose, from which MuJoCo takes the inertias that time constants and ratios speak of.
//!
//! In: the links and joints that have been read. Out: an entry for each two freedoms. Method: composite rigid bodies,
//! all seen from the ground's origin (R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 6).

use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3, Vector6};

use super::Reader;
use crate::robot::{Inertia, Joint, JointKind, Length, Pose};

/// Inertias of a robot's freedoms.
pub struct Moved {
    /// The mass matrix: kg m^2, kg m and kg.
    matrix: DMatrix<f64>,
    /// The first freedom of each joint.
    first: Vec<usize>,
}

impl Moved {
    /// In the pose of a file.
    pub fn new(reader: &Reader) -> Self {
        let robot = &reader.robot;
        let seen = |(link, place): (&crate::robot::Link, &Pose)| {
            link.inertia.map_or(Matrix6::zeros(), |own| spatial(&own.seen_from(place)))
        };
        let mut carried: Vec<Matrix6<f64>> = robot.links.iter().zip(&reader.places).map(seen).collect();
        let axes: Vec<Vec<Vector6<f64>>> = robot.joints.iter().map(|joint| ways(joint, &reader.places)).collect();
        let mut first = Vec::new();
        let mut count = 0;
        // The joint that carries each link.
        let mut above = vec![None; robot.links.len()];
        for (index, joint) in robot.joints.iter().enumerate() {
            first.push(count);
            count += axes[index].len();
            above[joint.child] = Some(index);
        }
        let mut matrix = DMatrix::zeros(count, count);
        for (index, joint) in robot.joints.iter().enumerate().rev() {
            let inertia = carried[joint.child];
            carried[joint.parent] += inertia;
            for (k, own) in axes[index].iter().enumerate() {
                let row = first[index] + k;
                let momentum = inertia * own;
                let mut link = joint.child;
                while let Some(other) = above[link] {
                    for (l, way) in axes[other].iter().enumerate() {
                        let column = first[other] + l;
                        matrix[(row, column)] = way.dot(&momentum);
                        matrix[(column, row)] = matrix[(row, column)];
                    }
                    link = robot.joints[other].parent;
                }
                matrix[(row, row)] += joint.armature;
            }
        }
        Self { matrix, first }
    }

    /// What a joint of one freedom feels where all others are held.
    fn alone(&self, joint: usize) -> f64 {
        self.matrix[(self.first[joint], self.first[joint])]
    }

    /// What something along a length feels where all other joints are held: 1 / sum(a^2 / m) of the factors a.
    pub fn along(&self, length: &Length) -> f64 {
        1.0 / length.parts.iter().map(|&(joint, each)| each * each / self.alone(joint)).sum::<f64>()
    }

    /// What each joint feels where all others are free; none where a freedom moves nothing.
    pub fn yielding(&self) -> Option<impl Fn(usize) -> f64 + '_> {
        let inverse = self.matrix.clone().cholesky()?.inverse();
        Some(move |joint: usize| 1.0 / inverse[(self.first[joint], self.first[joint])])
    }
}

/// The inertia as seen by angular velocity and the velocity of what is at the origin.
fn spatial(inertia: &Inertia) -> Matrix6<f64> {
    let Inertia { mass, center, tensor } = inertia;
    let arm = center.cross_matrix();
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&(tensor - *mass * arm * arm));
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&(*mass * arm));
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&(-*mass * arm));
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&(*mass * Matrix3::identity()));
    matrix
}

/// The motion of each freedom of a joint: angular velocity, and the velocity of what is at the origin.
fn ways(joint: &Joint, places: &[Pose]) -> Vec<Vector6<f64>> {
    let frame = places[joint.child].then(&joint.in_child);
    let turn = |axis: Vector3<f64>| {
        let at_origin = frame.place.cross(&axis);
        Vector6::new(axis.x, axis.y, axis.z, at_origin.x, at_origin.y, at_origin.z)
    };
    let shift = |axis: Vector3<f64>| Vector6::new(0.0, 0.0, 0.0, axis.x, axis.y, axis.z);
    let all = || (0..3).map(|k| frame.turned.column(k).into_owned());
    match joint.kind {
        JointKind::Revolute => vec![turn(frame.turned * joint.axis)],
        JointKind::Prismatic => vec![shift(frame.turned * joint.axis)],
        JointKind::Spherical => all().map(turn).collect(),
        JointKind::Free => all().map(shift).chain(all().map(turn)).collect(),
        _ => Vec::new(),
    }
}
