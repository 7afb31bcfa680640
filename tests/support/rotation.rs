//! Rotation matrices.

/// The rotation matrix of a unit quaternion, real part first, row by row; of another one that of its direction times
/// the square of its length.
#[must_use]
pub fn matrix([a, b, c, d]: [f64; 4]) -> [f64; 9] {
    [
        a * a + b * b - c * c - d * d,
        2.0 * (b * c - a * d),
        2.0 * (b * d + a * c),
        2.0 * (b * c + a * d),
        a * a - b * b + c * c - d * d,
        2.0 * (c * d - a * b),
        2.0 * (b * d - a * c),
        2.0 * (c * d + a * b),
        a * a - b * b - c * c + d * d,
    ]
}
