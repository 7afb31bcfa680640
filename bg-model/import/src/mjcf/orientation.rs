//! Frames of elements: `pos` with `quat`, `axisangle`, `euler`, `xyaxes` or `zaxis`.

use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use super::defaults::Element;
use crate::ImportError;
use crate::robot::Pose;
use crate::xml::{array, bad};

/// How the file gives angles.
pub struct Angles {
    /// rad.
    pub unit: f64,
    /// The axes of `euler` in their order; small letters turn with the body, capitals stay.
    sequence: String,
}

impl Angles {
    /// In degrees or radians.
    pub fn new(degrees: bool, sequence: &str) -> Self {
        Self { unit: if degrees { std::f64::consts::PI / 180.0 } else { 1.0 }, sequence: sequence.to_owned() }
    }

    /// The frame of an element.
    ///
    /// # Errors
    /// Words that are no numbers, axes that are zero.
    pub fn pose(&self, element: &Element) -> Result<Pose, ImportError> {
        Ok(Pose { place: element.vector("pos")?.unwrap_or_default(), turned: self.turned(element)? })
    }

    fn turned(&self, element: &Element) -> Result<Matrix3<f64>, ImportError> {
        let node = element.node;
        let direction = |name: &str, axis: Vector3<f64>| {
            let zero = || bad(node, name, element.text(name).unwrap_or_default(), "a direction, not zero");
            Unit::try_new(axis, 1e-12).ok_or_else(zero)
        };
        if let Some(text) = element.text("quat") {
            let [w, x, y, z] = array::<4>(node, "quat", text)?;
            let quaternion = Quaternion::new(w, x, y, z);
            if quaternion.norm() < 1e-12 {
                return Err(bad(node, "quat", text, "not zero"));
            }
            return Ok(UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix().into_inner());
        }
        if let Some(text) = element.text("axisangle") {
            let [x, y, z, angle] = array::<4>(node, "axisangle", text)?;
            let axis = direction("axisangle", Vector3::new(x, y, z))?;
            return Ok(Rotation3::from_axis_angle(&axis, angle * self.unit).into_inner());
        }
        if let Some(angles) = element.vector("euler")? {
            return Ok(self.euler(&angles));
        }
        if let Some(text) = element.text("xyaxes") {
            let [a, b, c, d, e, f] = array::<6>(node, "xyaxes", text)?;
            let x = direction("xyaxes", Vector3::new(a, b, c))?.into_inner();
            let y = Vector3::new(d, e, f);
            let y = direction("xyaxes", y - x * x.dot(&y))?.into_inner();
            return Ok(Matrix3::from_columns(&[x, y, x.cross(&y)]));
        }
        if let Some(axis) = element.vector("zaxis")? {
            return Ok(with_z(&*direction("zaxis", axis)?));
        }
        Ok(Matrix3::identity())
    }

    fn euler(&self, angles: &Vector3<f64>) -> Matrix3<f64> {
        self.sequence.chars().zip(angles.iter()).fold(Matrix3::identity(), |turned, (letter, angle)| {
            let axis = match letter.to_ascii_lowercase() {
                'x' => Vector3::x_axis(),
                'y' => Vector3::y_axis(),
                _ => Vector3::z_axis(),
            };
            let step = Rotation3::from_axis_angle(&axis, angle * self.unit).into_inner();
            if letter.is_ascii_lowercase() { turned * step } else { step * turned }
        })
    }
}

/// The shortest rotation that takes z to a direction.
pub fn with_z(direction: &Vector3<f64>) -> Matrix3<f64> {
    let half_turn = || Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    Rotation3::rotation_between(&Vector3::z(), direction).unwrap_or_else(half_turn).into_inner()
}
