//! What a machine looks like over a run: its bodies with their poses, its joints with their forces.
//!
//! Lengths in m, forces in N, torques in N m; places and vectors in inertial axes unless said.

/// A machine in motion: every track has a value for each of `times`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// The samples, s, ascending.
    pub times: Vec<f64>,
    /// The bodies.
    pub bodies: Vec<BodyTrack>,
    /// Points of the ground.
    pub ground: Vec<NamedPoint>,
    /// The acceleration of gravity, m/s^2; zero where there is none.
    pub gravity: [f64; 3],
    /// The joints.
    pub joints: Vec<JointTrack>,
}

impl Animation {
    /// The turn after which things fall along -y: a unit quaternion x, y, z, w.
    #[must_use]
    pub fn upright(&self) -> [f64; 4] {
        let [x, y, z] = self.gravity;
        let length = x.hypot(y).hypot(z);
        let [x, y, z] = if length > 0.0 { [x, y, z].map(|part| -part / length) } else { [0.0, 1.0, 0.0] };
        // The turn from (x, y, z) to (0, 1, 0), of length one: about their vector product.
        let turn = [-z, 0.0, x, 1.0 + y];
        let length = turn.iter().map(|part| part * part).sum::<f64>().sqrt();
        if length > 1e-9 { turn.map(|part| part / length) } else { [1.0, 0.0, 0.0, 0.0] }
    }
}

/// A body over the run. One without solids is drawn as rods from its origin to its points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyTrack {
    /// Its name.
    pub name: String,
    /// What it is made of, in the body's axes.
    pub solids: Vec<Solid>,
    /// Its named points, in the body's axes.
    pub points: Vec<NamedPoint>,
    /// Where the origin of its axes is at each sample.
    pub position: Vec<[f64; 3]>,
    /// How its axes are turned at each sample: a unit quaternion x, y, z, w. Its sign does not jump between samples.
    pub orientation: Vec<[f64; 4]>,
}

/// A point with a name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedPoint {
    /// Its name.
    pub name: String,
    /// Its place: of a body in the body's axes, of the ground in inertial axes.
    pub at: [f64; 3],
}

/// A solid of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Kind and size.
    pub shape: Shape,
    /// Its centre in the body's axes.
    pub at: [f64; 3],
    /// The rows of the rotation matrix from the solid's to the body's axes.
    pub turned: [[f64; 3]; 3],
}

/// Kind and size of a solid about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A cuboid.
    Cuboid {
        /// Its edges along x, y and z.
        edges: [f64; 3],
    },
    /// A cylinder.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its length.
        length: f64,
        /// The axis that it lies along: 0, 1 or 2 for x, y or z.
        axis: usize,
    },
    /// A sphere.
    Sphere {
        /// Its radius.
        radius: f64,
    },
}

/// A joint over the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointTrack {
    /// Its name.
    pub name: String,
    /// What it is, such as `revolute`.
    pub kind: String,
    /// Where it is at each sample.
    pub place: Vec<[f64; 3]>,
    /// The force on its second body at each sample.
    pub force: Vec<[f64; 3]>,
    /// The torque on its second body at each sample; empty where it is not known.
    pub torque: Vec<[f64; 3]>,
}

#[cfg(test)]
mod tests {
    use super::super::mesh::turned;
    use super::*;

    #[test]
    fn things_fall_along_minus_y() {
        for gravity in [[0.0, -9.81, 0.0], [0.0, 0.0, -1.62], [3.0, 4.0, 0.0], [0.0, 2.0, 0.0], [1.0, -1.0, 1.0]] {
            let upright = Animation { gravity, ..Animation::default() }.upright();
            let fallen = turned(upright, gravity);
            let length = gravity.iter().map(|part| part * part).sum::<f64>().sqrt();
            assert!(
                fallen.iter().zip([0.0, -length, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12),
                "{gravity:?}: {fallen:?}"
            );
        }
        assert_eq!(Animation::default().upright(), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(Animation { gravity: [0.0, -9.81, 0.0], ..Animation::default() }.upright(), [0.0, 0.0, 0.0, 1.0]);
    }
}
