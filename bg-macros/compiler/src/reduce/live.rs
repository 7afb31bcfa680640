//! States that nobody watches.
//!
//! In: equations. Out: the same without states and switches that reach no output.
//! Method: everything that an output depends on is live; so is what the rate, the projection or a switch of something
//! live depends on.

use super::report::{Fate, Report};
use super::{index, keep_switches, state_of};
use crate::equations::StateEquations;
use crate::expr::{Branch, Id, Node, Symbol};

/// Drops states and switches that no output needs.
pub(super) fn drop_unwatched(equations: &mut StateEquations, report: &mut Report) {
    let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
    let (live, switches) = live(equations, &outputs);
    for state in (0..live.len()).filter(|&state| !live[state]) {
        report.say(state, Fate::Unwatched);
    }
    for state in quadratures(equations) {
        if live[state] {
            report.say(state, Fate::Quadrature);
        }
    }
    let mut kept = 0;
    let branches: Vec<Branch> = switches
        .iter()
        .map(|&live| {
            kept += u32::from(live);
            if live { Branch::Kept(kept - 1) } else { Branch::Positive }
        })
        .collect();
    forget_energies(equations, &live);
    keep_states(equations, report, &live);
    keep_switches(equations, &branches);
}

/// States and switches that the roots need.
fn live(equations: &StateEquations, roots: &[Id]) -> (Vec<bool>, Vec<bool>) {
    let pool = &equations.pool;
    let mut states = vec![false; equations.states.len()];
    let mut switches = vec![false; equations.switches.len()];
    let mut open: Vec<Id> = roots.to_vec();
    while let Some(root) = open.pop() {
        for id in pool.reachable(&[root]) {
            match pool.node(id) {
                Node::Symbol(Symbol::State(state)) => {
                    let state = *state as usize;
                    if !std::mem::replace(&mut states[state], true) {
                        open.push(equations.states[state].rate);
                        let projections = equations.projections.iter().filter(|(of, _)| *of == state);
                        open.extend(projections.map(|(_, id)| *id));
                    }
                }
                Node::Select { switch, .. } => {
                    let switch = *switch as usize;
                    if !std::mem::replace(&mut switches[switch], true) {
                        open.push(equations.switches[switch].guard);
                    }
                }
                _ => {}
            }
        }
    }
    (states, switches)
}

/// Integrals that no rate and no guard depends on.
fn quadratures(equations: &StateEquations) -> Vec<usize> {
    let rates = equations.states.iter().map(|state| state.rate);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let used = equations.pool.symbols(&rates.chain(guards).collect::<Vec<_>>());
    let is_used = |state: usize| used.contains(&Symbol::State(index(state)));
    (0..equations.states.len())
        .filter(|&state| equations.states[state].storage == "integral" && !is_used(state))
        .collect()
}

/// Energies and powers that need a state which goes are not known in the scene: they become not-a-number.
fn forget_energies(equations: &mut StateEquations, live: &[bool]) {
    let unknown = equations.pool.number(f64::NAN);
    for quantity in [&mut equations.stored, &mut equations.supplied, &mut equations.dissipated] {
        if equations.pool.symbols(&[*quantity]).into_iter().filter_map(state_of).any(|state| !live[state]) {
            *quantity = unknown;
        }
    }
}

/// Takes away the states without `kept`, to which nothing refers any more, and numbers the others anew.
pub(super) fn keep_states(equations: &mut StateEquations, report: &mut Report, kept: &[bool]) {
    let mut next = 0;
    let numbers: Vec<usize> = kept
        .iter()
        .map(|&kept| {
            next += usize::from(kept);
            next.saturating_sub(1)
        })
        .collect();
    let is_kept = |state: usize| kept[state];
    let states = std::mem::take(&mut equations.states);
    equations.states = states.into_iter().enumerate().filter(|(k, _)| is_kept(*k)).map(|(_, state)| state).collect();
    equations.projections.retain(|(state, _)| is_kept(*state));
    for (state, _) in &mut equations.projections {
        *state = numbers[*state];
    }
    equations.bonds.clear();
    let symbols: Vec<Id> = numbers.iter().map(|&number| equations.pool.symbol(Symbol::State(index(number)))).collect();
    equations.replace(&|symbol| state_of(symbol).map(|state| symbols[state]));
    report.keep(kept);
}
