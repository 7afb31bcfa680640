//! Frames of elements: `pos` with `quat`, `axisangle`, `euler`, `xyaxes` or `zaxis`.

use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use super::defaults::Element;
use crate::ImportError;
use crate::robot::{Pose, with_z};

/// The attributes of which an element may have one.
const ORIENTATIONS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];

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
        let given: Vec<&str> = ORIENTATIONS.into_iter().filter(|name| node.peek(name).is_some()).collect();
        if let [first, second, ..] = given[..] {
            let what = format!("<{}> has `{first}` and `{second}`: leave one of the two out", node.name);
            return Err(ImportError::Wrong { place: node.place.clone(), what });
        }
        // What the element itself says goes before what its class says, in whatever way.
        let own = |name: &str| {
            let is_other = given.first().is_some_and(|given| *given != name);
            if is_other {
                element.node.mark(name)
            }
            element.text(name).filter(|_| !is_other)
        };
        let direction = |name: &str, axis: Vector3<f64>| {
            let zero = || node.bad(name, element.text(name).unwrap_or_default(), "a direction, not zero");
            let size = axis.amax();
            if size > 1e-12 { Unit::try_new(axis / size, 0.5).ok_or_else(zero) } else { Err(zero()) }
        };
        if let Some(text) = own("quat") {
            let [w, x, y, z] = node.array::<4>("quat", text)?;
            let size = [w, x, y, z].into_iter().fold(0.0, |size: f64, part| size.max(part.abs()));
            if size < 1e-12 {
                return Err(node.bad("quat", text, "not zero"));
            }
            let quaternion = Quaternion::new(w / size, x / size, y / size, z / size);
            return Ok(UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix().into_inner());
        }
        if let Some(text) = own("axisangle") {
            let [x, y, z, angle] = node.array::<4>("axisangle", text)?;
            let axis = direction("axisangle", Vector3::new(x, y, z))?;
            return Ok(Rotation3::from_axis_angle(&axis, angle * self.unit).into_inner());
        }
        if let Some(text) = own("euler") {
            return Ok(self.euler(&Vector3::from(node.array::<3>("euler", text)?)));
        }
        if let Some(text) = own("xyaxes") {
            let [a, b, c, d, e, f] = node.array::<6>("xyaxes", text)?;
            let x = direction("xyaxes", Vector3::new(a, b, c))?.into_inner();
            let y = Vector3::new(d, e, f);
            let y = direction("xyaxes", y - x * x.dot(&y))?.into_inner();
            return Ok(Matrix3::from_columns(&[x, y, x.cross(&y)]));
        }
        if let Some(text) = own("zaxis") {
            return Ok(with_z(&*direction("zaxis", Vector3::from(node.array::<3>("zaxis", text)?))?));
        }
        Ok(Matrix3::identity())
    }

    /// The rotation of three angles about the axes of `eulerseq`.
    pub fn euler(&self, angles: &Vector3<f64>) -> Matrix3<f64> {
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
