//! Samples: what the model holds between the instants of its clocks.
//!
//! In: a system, its state, the clocks that have an instant. Out: the state with their samples computed anew.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::clock::{Clock, is_due};
use crate::model::dynamics::{Dynamics, branches};
use crate::model::scalar::Scalar;

/// Decides the branches in which samples are computed: of each switch that is not `fixed` and whose guard depends on
/// them, by its sign, again until nothing changes. `before` are the guards before the instant; `guards` writes them
/// into `value`.
pub(crate) fn decide<S: Scalar>(
    negative: &mut [bool],
    fixed: impl Fn(usize) -> bool,
    [before, value]: [&mut [S]; 2],
    mut guards: impl FnMut(&[bool], &mut [S]),
) {
    for _ in 0..=negative.len() {
        guards(negative, value);
        let mut agree = true;
        for (k, negative) in negative.iter_mut().enumerate() {
            let [before, value] = [before[k].to_f64(), value[k].to_f64()];
            let next = if fixed(k) || value == before || value == 0.0 { *negative } else { value < 0.0 };
            agree &= core::mem::replace(negative, next) == next;
        }
        if agree {
            return;
        }
    }
}

/// Computes the samples of the clocks with these switches at time `t` (s) in state `x`, whose switches have the
/// branches `negative`. Everything else of the state stays. Allocates.
pub(crate) fn compute<S: Scalar>(system: &dyn Dynamics<S>, ticking: &[usize], t: S, negative: &[bool], x: &mut [S]) {
    let remembers = system.first_branches();
    let mut room = vec![S::from_f64(0.0); 2 * negative.len()];
    let (before, value) = room.split_at_mut(negative.len());
    let switches = |negative: &[bool]| negative.iter().copied().map(S::Switch::from).collect::<Vec<_>>();
    system.guards(t, x, &switches(negative), before);
    let mut now = negative.to_vec();
    ticking.iter().for_each(|&switch| now[switch] = true);
    decide(
        &mut now,
        |k| remembers[k] || ticking.contains(&k),
        [before, value],
        |negative, value| {
            system.guards(t, x, &switches(negative), value);
        },
    );
    let mut projected = x.to_vec();
    system.project(t, &switches(&now), &mut projected);
    system.memories().into_iter().for_each(|held| x[held] = projected[held]);
}

/// The same of all clocks that have an instant at `t` (s).
pub(crate) fn compute_due<S: Scalar>(
    system: &dyn Dynamics<S>,
    clocks: &[Clock<S>],
    t: f64,
    negative: &[bool],
    x: &mut [S],
) {
    let due = clocks.iter().filter(|clock| clock.at(t).is_some());
    let due: Vec<usize> = due.map(|clock| clock.switch).collect();
    compute(system, &due, S::from_f64(t), negative, x);
}

/// The state of `system` after the samples of all clocks are computed that have an instant at `t` (s), from the state
/// `x` before, whose switches have the branches `negative`, or those of their signs. Allocates.
#[must_use]
pub fn computed(system: &dyn Dynamics, t: f64, x: &[f64], negative: Option<&[bool]>) -> Vec<f64> {
    let (clocks, mut after) = (system.clocks(), x.to_vec());
    if is_due(&clocks, t) {
        let negative = negative.map_or_else(|| branches(system, t, x), <[bool]>::to_vec);
        compute_due(system, &clocks, t, &negative, &mut after);
    }
    after
}
