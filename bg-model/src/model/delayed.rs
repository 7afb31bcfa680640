//! What a system delays: read, and as it is at a start.
//!
//! In: a system with delays, its state. Out: its signals at that instant; the states of the delays where nothing has
//! been yet.

use alloc::vec::Vec;

use crate::model::delay::{Delay, Signal, States};
use crate::model::dynamics::Dynamics;
use crate::model::scalar::Scalar;

/// The signals of all delays at time `t` (s) in state `x`, in the order of the delays: reads them into `x`.
pub(crate) fn read<S: Scalar>(system: &dyn Dynamics<S>, delays: &[Delay<S>], t: S, negative: &[bool], x: &mut [S]) {
    let is_read = |k: usize| negative[k] || delays.iter().any(|delay| delay.switch == k);
    let switches: Vec<S::Switch> = (0..negative.len()).map(|k| S::Switch::from(is_read(k))).collect();
    system.project(t, &switches, x);
}

/// Writes the states of the delays at a start at `t` (s): what the signals were before it is what is given, else what
/// they are there.
pub(crate) fn begin<S: Scalar>(system: &dyn Dynamics<S>, delays: &[Delay<S>], t: f64, negative: &[bool], x: &mut [S]) {
    let mut now = x.to_vec();
    read(system, delays, S::from_f64(t), negative, &mut now);
    for Delay { time, states: States { window: [from, until], signals, .. }, .. } in delays {
        (x[*from], x[*until]) = (S::from_f64(t), S::from_f64(t) + *time);
        for Signal { coefficients, is_given } in *signals {
            if let ([first, others @ ..], false) = (coefficients, is_given) {
                x[*first] = now[*first];
                others.iter().for_each(|&other| x[other] = S::from_f64(0.0));
            }
        }
    }
}
