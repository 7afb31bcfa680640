//! Balls by three angles.
//!
//! In: a tree, rows of joints that close loops. Out: the same tree in which a body on a ball that another ball, which
//! closes a loop, holds as well has three angles; the last is about the line through both, so that the loop does not
//! feel it. Method: the angles of a row of hinges, each across the one before. They are coordinates of the ball's
//! motion but where the second is a quarter turn: where the loop gives the first two, its pivot vanishes there.

use super::bodies::Body;
use super::guessed::Guessed;
use super::joints::{Joint, Kind};
use super::numbers::{self, Matrix, Vector};
use super::recognition;
use crate::expr::Environment;
use crate::system::equations::StateEquations;
use crate::system::reduce::{closing, friction};

/// The joints with such balls by angles; `starts` has the values of the states at the start, for guesses.
pub(super) fn by_angles(
    equations: &mut StateEquations,
    bodies: &[Body],
    mut joints: Vec<Joint>,
    (starts, guessed): (&Environment<'_>, &Guessed),
) -> Vec<Joint> {
    let rigid = friction::rigid(&equations.reactions);
    let is_left = |row: &usize| joints.iter().all(|joint| !joint.rows.contains(row));
    let left = closing::of_joints(&equations.reactions, (0..rigid).filter(is_left));
    for joint in joints.iter_mut().filter(|joint| joint.kind == Kind::Spherical) {
        let other =
            left.iter().find_map(|rows| recognition::ball(equations, bodies, rows, joint.child, (starts, guessed)));
        let Some(other) = other else { continue };
        let back = joint.at[1].negate(&mut equations.pool);
        let reach = other.add(&mut equations.pool, &back);
        let reach: Option<Vec<f64>> = reach.0.iter().map(|&id| equations.pool.as_number(id)).collect();
        let Some(along) = reach.and_then(|reach| numbers::unit(&[reach[0], reach[1], reach[2]])) else { continue };
        let axes = |body: &Body| -> Matrix { body.axes.map(|state| starts.states[state]) };
        let inertial = numbers::applied(&axes(&bodies[joint.child]), &along);
        let inside = match joint.parent {
            Some(parent) => numbers::applied(&numbers::transposed(&axes(&bodies[parent])), &inertial),
            None => inertial,
        };
        let across = (0..3).min_by(|&i, &j| inside[i].abs().total_cmp(&inside[j].abs())).unwrap_or(0);
        let first: Vector = std::array::from_fn(|k| f64::from(u8::from(k == across)));
        joint.kind = Kind::Angles;
        joint.frames = [first, numbers::cleaned(&along)].map(|axis| numbers::upright(&axis));
    }
    joints
}
