//! The frames of a joint such that its axis is x, y or z of both.

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::robot::{Joint, JointKind, Pose};

/// A joint's frames.
pub struct Frames {
    /// The free axis.
    pub letter: &'static str,
    /// The joint goes from the child to the parent, whose motion against the child has the sign of the file's.
    pub reversed: bool,
    /// In the parent.
    pub in_parent: Pose,
    /// In the child.
    pub in_child: Pose,
}

/// Those of a joint; the axis is matched to rounding.
pub fn frames(joint: &Joint) -> Frames {
    let Joint { kind, in_parent, in_child, axis, .. } = joint;
    let (in_parent, in_child) = (*in_parent, *in_child);
    if !matches!(kind, JointKind::Revolute | JointKind::Prismatic | JointKind::Cylindrical) {
        return Frames { letter: "", reversed: false, in_parent, in_child };
    }
    match ["x", "y", "z"].into_iter().zip(axis.iter()).find(|(_, part)| axis.abs().sum() - part.abs() < 1e-12) {
        Some((letter, part)) => Frames { letter, reversed: *part < 0.0, in_parent, in_child },
        None => {
            let (letter, axes) = turned_to(axis);
            Frames {
                letter,
                reversed: false,
                in_parent: in_parent.with_axes(&axes),
                in_child: in_child.with_axes(&axes),
            }
        }
    }
}

/// A letter, and the rotation that takes this axis to a direction: about z or x alone where that does.
fn turned_to(direction: &Vector3<f64>) -> (&'static str, Matrix3<f64>) {
    if direction.x.abs() < 1e-15 {
        return ("z", Rotation3::from_axis_angle(&Vector3::x_axis(), (-direction.y).atan2(direction.z)).into_inner());
    }
    let yaw = Rotation3::from_axis_angle(&Vector3::z_axis(), direction.y.atan2(direction.x));
    if direction.z.abs() < 1e-15 {
        return ("x", yaw.into_inner());
    }
    let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), direction.xy().norm().atan2(direction.z));
    ("z", (yaw * tilt).into_inner())
}
