//! Numbers, vectors and rotations as a person would write them.
//!
//! Out: twelve significant digits at most, so that 0.1 + 0.2 is 0.3; what is 1e-12 beside 1 is 0.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

/// A number.
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    if rounded == 0.0 {
        return "0".to_owned();
    }
    let size = rounded.abs();
    if (1e-3..1e6).contains(&size) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A vector; what is nothing beside its largest component, or beside `scale`, is 0.
pub fn vector(value: &Vector3<f64>, scale: f64) -> String {
    let limit = 1e-12 * value.amax().max(scale);
    let parts: Vec<String> = value.iter().map(|&part| number(if part.abs() <= limit { 0.0 } else { part })).collect();
    format!("[{}]", parts.join(", "))
}

/// A matrix as its three rows.
pub fn matrix(value: &Matrix3<f64>) -> String {
    let rows: Vec<String> = value.row_iter().map(|row| vector(&row.transpose(), value.amax())).collect();
    format!("[{}]", rows.join(", "))
}

/// A rotation matrix as a product of rotations about axes; none where it turns nothing.
pub fn rotation(value: &Matrix3<f64>) -> Option<String> {
    if is_identity(value) {
        return None;
    }
    Some(factors(value).map_or_else(|| matrix(value), |factors| product(&factors)))
}

/// The inverse of a rotation matrix in the same way, with the same angles negated.
pub fn inverse_rotation(value: &Matrix3<f64>) -> Option<String> {
    if is_identity(value) {
        return None;
    }
    let back = |factors: Vec<Factor>| factors.into_iter().rev().map(|(axis, angle)| (axis, -angle)).collect::<Vec<_>>();
    Some(factors(value).map_or_else(|| matrix(&value.transpose()), |factors| product(&back(factors))))
}

/// An axis and an angle, rad.
type Factor = (&'static str, f64);

/// About one axis, else about z, y, x; none where rounding is in the way.
fn factors(value: &Matrix3<f64>) -> Option<Vec<Factor>> {
    let angle = |sine: (usize, usize), cosine: (usize, usize)| value[sine].atan2(value[cosine]);
    let about = [
        ("x", angle((2, 1), (1, 1)), value.column(0)),
        ("y", angle((0, 2), (0, 0)), value.column(1)),
        ("z", angle((1, 0), (0, 0)), value.column(2)),
    ];
    // By the sines: a cosine is 1 to rounding for angles of 1e-8.
    let is_kept = |(index, direction): (usize, &Vector3<f64>)| (direction - Vector3::ith(index, 1.0)).amax() < 1e-12;
    let kept = about.into_iter().enumerate().find(|(index, (.., image))| is_kept((*index, &image.into_owned())));
    if let Some((_, (axis, angle, _))) = kept {
        return Some(vec![(axis, angle)]);
    }
    let pitch = ("y", (-value[(2, 0)]).atan2(value[(0, 0)].hypot(value[(1, 0)])));
    // Where x looks along the inertial z, yaw and roll are about one axis.
    let choices = [
        [("z", angle((1, 0), (0, 0))), pitch, ("x", angle((2, 1), (2, 2)))],
        [("z", 0.0), pitch, ("x", (-value[(1, 2)]).atan2(value[(1, 1)]))],
    ];
    let is_same = |factors: &[Factor; 3]| {
        let product = factors.iter().fold(Matrix3::identity(), |product, (axis, angle)| product * turn(axis, *angle));
        (product - value).amax() < 1e-12
    };
    let found = choices.into_iter().find(is_same)?;
    Some(found.into_iter().filter(|(_, angle)| angle.abs() > 1e-12).collect())
}

fn product(factors: &[Factor]) -> String {
    factors.iter().map(|(axis, by)| format!("rotation_{axis}({})", angle(*by))).collect::<Vec<_>>().join(" * ")
}

/// An angle; quarter turns to all digits, so that sines and cosines are 0 and 1.
fn angle(value: f64) -> String {
    let quarters = (value / FRAC_PI_2).round() * FRAC_PI_2;
    if quarters != 0.0 && (value - quarters).abs() < 1e-11 { format!("{quarters}") } else { number(value) }
}

/// Whether a rotation turns nothing.
pub fn is_identity(value: &Matrix3<f64>) -> bool {
    (value - Matrix3::identity()).amax() < 1e-12
}

fn turn(axis: &str, angle: f64) -> Matrix3<f64> {
    let axis = match axis {
        "x" => Vector3::x_axis(),
        "y" => Vector3::y_axis(),
        _ => Vector3::z_axis(),
    };
    nalgebra::Rotation3::from_axis_angle(&axis, angle).into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_turn_about_another_axis_is_kept() {
        let turn = |axis: Vector3<f64>, angle: f64| nalgebra::Rotation3::new(axis * angle).into_inner();
        let value = turn(Vector3::y(), -5e-8) * turn(Vector3::x(), 1.5);
        let text = rotation(&value).expect("it turns");
        assert!(text.contains("rotation_y(-5e-8)") && text.contains("rotation_x(1.5)"), "{text}");
        assert_eq!(rotation(&turn(Vector3::x(), 1.5)).as_deref(), Some("rotation_x(1.5)"));
    }

    #[test]
    fn numbers_are_short_and_small_residues_are_nothing() {
        assert_eq!(
            ["0.3", "-1.2345", "1e-5", "2", "0"].map(str::to_owned),
            [0.1 + 0.2, -1.2345, 1e-5, 2.0, 0.0].map(number)
        );
        assert_eq!(vector(&Vector3::new(1.0, 6e-17, -0.5), 0.0), "[1, 0, -0.5]");
    }

    #[test]
    fn rotations_are_written_about_as_few_axes_as_do() {
        let text = |parts: &[(&str, f64)]| {
            rotation(&parts.iter().fold(Matrix3::identity(), |product, (axis, angle)| product * turn(axis, *angle)))
        };
        assert_eq!(text(&[]), None);
        let turned = turn("z", 0.4) * turn("x", 1.0);
        assert_eq!(inverse_rotation(&turned).as_deref(), Some("rotation_x(-1) * rotation_z(-0.4)"));
        assert_eq!(text(&[("y", 2.5)]).as_deref(), Some("rotation_y(2.5)"));
        assert_eq!(text(&[("x", 0.3), ("x", -0.1)]).as_deref(), Some("rotation_x(0.2)"));
        assert_eq!(text(&[("z", 0.4), ("x", 1.0)]).as_deref(), Some("rotation_z(0.4) * rotation_x(1)"));
        // Pitch of a right angle.
        let right = std::f64::consts::FRAC_PI_2;
        assert_eq!(
            text(&[("y", right), ("x", 0.7)]).as_deref(),
            Some("rotation_y(1.5707963267948966) * rotation_x(0.7)")
        );
    }
}
