//! Motion out of the plane of a hacksaw that is symmetric to it: a disturbance of the start must not grow.
//!
//! In: names of states. Out: which of them lead out of the plane, and how far a pose has left it. The exact motion
//! stays near the plane: its tilts are held by springs with strong dampers, its displacements ring and decay. An
//! explicit method at steps for the motion in the plane amplifies the disturbance, until its error estimate sees it.

/// The direction, -1 to 1, in which the state called `name` is disturbed; 0 of a state of the motion in the plane.
/// Pairs of orientation entries go opposite ways, so that the orientation stays one to first order.
#[must_use]
pub fn direction(name: &str) -> f64 {
    let is = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
    match name {
        _ if is(&["orientation_31", "orientation_32"]) => -sign(name),
        _ if is(&["orientation_13", "orientation_23"]) => sign(name),
        _ if is(&["position_z", "mass.p_z", "inertia.p_x", "inertia.p_y"]) => sign(name),
        _ => 0.0,
    }
}

/// A sign for each body, so that they do not all go the same way.
fn sign(name: &str) -> f64 {
    if name.starts_with("crank") || name.starts_with("frame") { 1.0 } else { -1.0 }
}

/// How far the poses called `names` are out of the plane: the largest of the z coordinates (m) and of the orientations'
/// entries that vanish in the plane.
#[must_use]
pub fn departure(names: &[String], row: &[f64]) -> f64 {
    let leaves = |name: &str| ["_z", "_13", "_23", "_31", "_32"].iter().any(|ending| name.ends_with(ending));
    names.iter().zip(row).filter(|(name, _)| leaves(name)).map(|(_, value)| value.abs()).fold(0.0, f64::max)
}
