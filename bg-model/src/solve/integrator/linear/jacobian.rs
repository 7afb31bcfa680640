//! The Jacobian for a step, also where a law has an infinite derivative.
//!
//! In: a flow and a step from a point. Out: its derivatives there, in the order of its sparsity. Where one of them is
//! no number, as that of a square root at zero, a difference over the step stands in for it; where there are unknowns
//! beside the states, differences for all. An implicit method only needs a Jacobian that makes its iteration converge;
//! of a Rosenbrock method the error estimate shows what is amiss.

use alloc::vec::Vec;

use crate::model::linear::{Sparsity, differences};
use crate::solve::integrator::{Flow, PointRef, Scale, is_finite};

/// The derivatives of a rate at one point.
#[derive(Clone, Debug)]
pub(in crate::solve::integrator) struct Jacobian {
    /// df/dx in the order of the sparsity.
    pub entries: Vec<f64>,
    /// Whether the entries are differences in all places in place of the flow's own.
    pub is_replaced: bool,
    /// df/dt, per s.
    pub slope: Vec<f64>,
    /// A state and a rate, for differences.
    room: [Vec<f64>; 2],
}

impl Jacobian {
    /// Nothing yet; room is made at the first evaluation.
    pub fn new() -> Self {
        Self { entries: Vec::new(), is_replaced: false, slope: Vec::new(), room: [const { Vec::new() }; 2] }
    }

    /// Evaluates the derivatives for a step of size `h` (s) from `start`, whose rate is known. Gives whether all of
    /// them are finite.
    pub fn evaluate(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> bool {
        let n = flow.states();
        self.is_replaced = false;
        self.entries.resize(flow.sparsity().len(n), 0.0);
        self.slope.resize(n, 0.0);
        self.room.iter_mut().for_each(|room| room.resize(n, 0.0));
        flow.jacobian(start.t, start.x, &mut self.entries, &mut self.slope);
        if self.is_finite() {
            return true;
        }
        if matches!(flow.sparsity(), Sparsity::Bordered { .. }) {
            self.is_replaced = true;
            self.entries.resize(Sparsity::Full.len(n), 0.0);
            let Self { entries, slope, room: [room, _], .. } = self;
            differences(&mut |t, x, rate| flow.rate(t, x, rate), start.t, start.x, entries, slope, room);
        } else {
            self.replace_faulty(flow, start, h, scale);
        }
        self.is_finite()
    }

    /// Where the entries are.
    pub fn sparsity(&self, flow: &Flow<'_>) -> Sparsity {
        if self.is_replaced { Sparsity::Full } else { flow.sparsity() }
    }

    /// Whether all derivatives are finite.
    pub fn is_finite(&self) -> bool {
        is_finite(&self.entries) && is_finite(&self.slope)
    }

    /// Replaces each derivative that is not finite by a difference: of a state over as much as it changes in the step,
    /// and at least what its tolerance allows, of the time over the step.
    fn replace_faulty(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) {
        let (sparsity, n) = (flow.sparsity(), flow.states());
        let Self { entries, slope, room: [ahead, rate], .. } = self;
        ahead.copy_from_slice(start.x);
        for column in 0..n {
            let change = h * start.rate[column];
            let reach = change.abs().max(scale.allowed(column, start.x[column])).copysign(change);
            // The law may have no value on one side.
            for by in [reach, -reach] {
                let is_faulty = |k: &usize, entry: f64| sparsity.place(*k, n).1 == column && !entry.is_finite();
                if !entries.iter().enumerate().any(|(k, entry)| is_faulty(&k, *entry)) {
                    break;
                }
                ahead[column] = start.x[column] + by;
                flow.rate(start.t, ahead, rate);
                let distance = ahead[column] - start.x[column];
                ahead[column] = start.x[column];
                for (k, entry) in entries.iter_mut().enumerate().filter(|(k, entry)| is_faulty(k, **entry)) {
                    let row = sparsity.place(k, n).0;
                    *entry = (rate[row] - start.rate[row]) / distance;
                }
            }
        }
        if slope.iter().any(|slope| !slope.is_finite()) {
            flow.rate(start.t + h, start.x, rate);
            for (slope, (after, before)) in slope.iter_mut().zip(rate.iter().zip(start.rate)) {
                if !slope.is_finite() {
                    *slope = (after - before) / h;
                }
            }
        }
    }
}
