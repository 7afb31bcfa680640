//! The hacksaw made hard: stiff, undamped, out of its plane, at rest, reversed, blunt, long, finely sampled, cut off at
//! a switching instant, and with every parameter at its extremes.
//!
//! In: nothing. Out: cases like those of [`crate::hardcases`], and measures of what a case cannot hold. The suite
//! `hard_hacksaw` and the bench `stability` use them.

pub mod cases;
pub mod disturbed;
pub mod ending;
pub mod endurance;
pub mod extremes;
pub mod machine;
pub mod references;
pub mod reversal;
pub mod sampling;
pub mod sheets;

use crate::hardcases::problem::Request;

/// A request at `tolerance` up to the last of `instants` within `limit` attempted steps; fixed steps are of 1e-5 s.
#[must_use]
pub fn request(tolerance: f64, instants: &[f64], limit: u64) -> Request<'_> {
    Request { relative: tolerance, absolute: 1e-4 * tolerance, fixed_step: 1e-5, forced_step: None, instants, limit }
}
