//! Constant states.
//!
//! In: equations. Out: the same without the states that keep their start value.
//! Method: assume every state constant at its start value, derive, drop the assumptions whose rate (or projection) does
//! not come out so, repeat until none is dropped. What remains is the greatest set of states whose rates vanish wherever
//! all of them have their start values; by induction in time they keep them.

use std::collections::BTreeSet;

use super::report::{Fate, Report, show};
use super::{is_constant, settle_switches, state_of};
use crate::equations::StateEquations;
use crate::expr::{Id, Symbol, substitute};

/// Folds the constant states.
pub(super) fn fold(equations: &mut StateEquations, report: &mut Report) {
    let constant = constants(equations);
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    for (state, _) in constant.0.iter().enumerate().filter(|(_, constant)| **constant) {
        report.say(state, Fate::Constant(show(equations, starts[state])));
    }
    let (constant, idle) = constant;
    let zero = equations.pool.zero();
    equations.replace(&|symbol| match state_of(symbol) {
        Some(state) => constant[state].then_some(starts[state]),
        None => idle.contains(&symbol).then_some(zero),
    });
    equations.reactions.retain(|reaction| !idle.contains(&reaction.multiplier));
    let kept: Vec<bool> = constant.iter().map(|constant| !constant).collect();
    super::live::keep_states(equations, report, &kept);
    settle_switches(equations);
}

/// Which states are proved constant, and which multipliers zero.
///
/// A constraint whose flow and gap vanish identically while the constants hold needs no reaction; where several such
/// constraints share a load, the one without any is taken.
fn constants(equations: &mut StateEquations) -> (Vec<bool>, BTreeSet<Symbol>) {
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let projections = equations.projections.clone();
    let projected: Vec<Id> = projections.iter().map(|&(_, id)| id).collect();
    let reactions = equations.reactions.clone();
    let zero = equations.pool.zero();
    let kept: Vec<Id> = reactions.iter().flat_map(|reaction| [reaction.flow, reaction.gap.unwrap_or(zero)]).collect();
    let mut idle: BTreeSet<Symbol> = reactions.iter().map(|reaction| reaction.multiplier).collect();
    let pool = &mut equations.pool;
    let mut assumed: Vec<bool> = starts.iter().map(|&start| is_constant(pool, start)).collect();
    loop {
        let at = |symbol| match state_of(symbol) {
            Some(state) => assumed[state].then_some(starts[state]),
            None => idle.contains(&symbol).then_some(zero),
        };
        let kept = substitute(pool, &kept, &at);
        let rates = substitute(pool, &rates, &at);
        let projected = substitute(pool, &projected, &at);
        let mut holds: Vec<bool> = rates.iter().map(|&rate| pool.is_zero(rate)).collect();
        for (&(state, _), &image) in projections.iter().zip(&projected) {
            holds[state] &= image == starts[state];
        }
        let next: Vec<bool> = assumed.iter().zip(&holds).map(|(&assumed, &holds)| assumed && holds).collect();
        let moved =
            reactions.iter().zip(kept.chunks_exact(2)).filter(|(_, pair)| !pair.iter().all(|&id| pool.is_zero(id)));
        let moved: Vec<Symbol> = moved.map(|(reaction, _)| reaction.multiplier).collect();
        let before = idle.len();
        idle.retain(|symbol| !moved.contains(symbol));
        if next == assumed && idle.len() == before {
            return (assumed, idle);
        }
        assumed = next;
    }
}
