//! A mechanism that cannot move: its rigid joints hold every motion.
//!
//! In: a system in its start pose, with what its joints hold. Out: the joints that clash, where nothing can move.
//!
//! Joints hold as many independent motions as there are momenta: no motion is left. That is no fault where a source
//! gives a flow, nor of bodies each of which one joint fixes, such as a frame.

use alloc::vec::Vec;

use super::Hold;
use super::factors::Factors;
use crate::model::scalar::Scalar;

/// The joints that leave no motion; none where there is one, or none is meant to be. `factors` are those of the matrix
/// of `hold`.
pub(super) fn immobile<S: Scalar>(hold: &Hold<S>, factors: &Factors<S>) -> Option<Vec<&'static str>> {
    let held = hold.held;
    let rank = (0..held.rigid.len()).filter(|&row| !factors.follows(row)).count();
    if rank == 0 || rank < held.moved.len() || held.is_driven {
        return None;
    }
    let mut joints: Vec<(&'static str, usize, usize)> = Vec::new();
    for slip in held.rigid {
        match joints.iter_mut().find(|(joint, ..)| *joint == slip.joint) {
            Some((_, rows, _)) => *rows += 1,
            None => joints.push((slip.joint, 1, 0)),
        }
    }
    for (joint, _, alone) in &mut joints {
        let own: Vec<bool> = held.rigid.iter().map(|slip| slip.joint == *joint).collect();
        *alone = rank - Factors::rank(hold.matrix(), &own);
    }
    let clashing: Vec<&'static str> =
        joints.iter().filter(|(_, rows, alone)| alone < rows).map(|(joint, ..)| *joint).collect();
    if !clashing.is_empty() {
        return Some(clashing);
    }
    // Each joint holds what no other one does. Without a loop they are joints without a free axis, of a frame.
    (!held.closing.is_empty()).then(|| joints.iter().map(|(joint, ..)| *joint).collect())
}
