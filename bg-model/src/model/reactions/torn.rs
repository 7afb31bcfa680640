//! Whether motions that were found to follow from others still do.
//!
//! In: the ends of accepted steps. Out: the joint that comes apart, since none of the others holds it any more: that is then an
//! end of the run, not a wrong result.

use nalgebra::SVector;

use super::{Hold, dropped, slipping};
use crate::model::capability::Joints;
use crate::model::holding::Slipping;

/// The fastest flow that follows from flows which are zero to rounding, in its unit.
const FOLLOWING: f64 = 1e-6;
/// How much faster than the fastest of the others it may be: Baumgarte's terms leave some flow.
const FASTER: f64 = 1e3;

/// What is looked at.
pub(crate) struct TornWatch {
    hold: Hold<f64>,
    dropped: Vec<bool>,
}

impl TornWatch {
    /// Room for what is held; none where every row takes part.
    pub fn new<J, const N: usize, const G: usize>(joints: &J) -> Option<Self>
    where
        J: Joints<f64, N, G>,
    {
        let dropped = dropped(joints);
        dropped.contains(&true).then(|| Self { hold: Hold::new(joints.held()), dropped })
    }

    /// The motion that has come apart most at time `t` (s) and state `x`. Allocates nothing.
    pub fn check<J, const N: usize, const G: usize>(
        &mut self,
        joints: &J,
        (t, x): (f64, &SVector<f64, N>),
        negative: &[bool; G],
    ) -> Option<Slipping>
    where
        J: Joints<f64, N, G>,
    {
        self.hold.read(joints, t, x, negative);
        let Self { hold, dropped } = self;
        let flows = &hold.flows()[..dropped.len()];
        let fastest = |is_dropped: bool| {
            let rows = (0..flows.len()).filter(|&row| dropped[row] == is_dropped);
            rows.max_by(|&a, &b| flows[a].abs().total_cmp(&flows[b].abs()))
        };
        let others = fastest(false).map_or(0.0, |row| flows[row].abs());
        let row = fastest(true).filter(|&row| flows[row].abs() > FOLLOWING + FASTER * others)?;
        Some(slipping(&hold.held, row, flows[row]))
    }
}
