//! Constant states.
//!
//! In: equations. Out: the same without the states that keep their start value.
//! Method: assume every state constant at its start value, derive, drop the assumptions whose rate (or projection) does
//! not come out so, repeat until none is dropped. What remains is the greatest set of states whose rates vanish wherever
//! all of them have their start values; by induction in time they keep them.

use super::report::{Fate, Report, show};
use super::{is_constant, settle_switches, state_of};
use crate::equations::StateEquations;
use crate::expr::{Id, substitute};

/// Folds the constant states.
pub(super) fn fold(equations: &mut StateEquations, report: &mut Report) {
    let constant = constants(equations);
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    for (state, _) in constant.iter().enumerate().filter(|(_, constant)| **constant) {
        report.say(state, Fate::Constant(show(equations, starts[state])));
    }
    equations.replace(&|symbol| state_of(symbol).filter(|&state| constant[state]).map(|state| starts[state]));
    let kept: Vec<bool> = constant.iter().map(|constant| !constant).collect();
    super::live::keep_states(equations, report, &kept);
    settle_switches(equations);
}

/// Which states are proved constant.
fn constants(equations: &mut StateEquations) -> Vec<bool> {
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let projections = equations.projections.clone();
    let projected: Vec<Id> = projections.iter().map(|&(_, id)| id).collect();
    let pool = &mut equations.pool;
    let mut assumed: Vec<bool> = starts.iter().map(|&start| is_constant(pool, start)).collect();
    loop {
        let at = |symbol| state_of(symbol).filter(|&state| assumed[state]).map(|state| starts[state]);
        let rates = substitute(pool, &rates, &at);
        let projected = substitute(pool, &projected, &at);
        let mut holds: Vec<bool> = rates.iter().map(|&rate| pool.is_zero(rate)).collect();
        for (&(state, _), &image) in projections.iter().zip(&projected) {
            holds[state] &= image == starts[state];
        }
        let next: Vec<bool> = assumed.iter().zip(&holds).map(|(&assumed, &holds)| assumed && holds).collect();
        if next == assumed {
            return assumed;
        }
        assumed = next;
    }
}
