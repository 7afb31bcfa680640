//! The states of second order and their second derivatives.
//!
//! In: [`StateEquations`]. Out: the displacements and orientations that follow the momenta, each with d2x/dt2 as a function
//! of the states and their rates, in a [`Second`] with a pool of its own. In a bond graph these are the kinematics: where
//! things are follows from how they move. What a resistor moves, as a spring behind a damper, is of first order.

use std::collections::BTreeMap;

use crate::equations::{State, StateEquations};
use crate::expr::{Id, Node, Pool, Symbol, derivative};

/// Second derivatives as expressions.
#[derive(Clone, Debug)]
pub struct Second {
    /// The expressions.
    pub pool: Pool,
    /// The states of second order, ascending.
    pub states: Vec<usize>,
    /// d2x/dt2 of each, of states and [`Symbol::Rate`]s.
    pub derivatives: Vec<Id>,
    /// The rates of all states, with d2x/dt2 in the places of these, of states alone.
    pub forces: Vec<Id>,
}

/// Finds the states of second order and differentiates their rates along the flow.
#[must_use]
pub fn differentiate(equations: &StateEquations) -> Second {
    let mut pool = equations.pool.clone();
    let states: Vec<usize> =
        (0..equations.states.len()).filter(|&index| is_of_second_order(equations, index)).collect();
    let rates: Vec<Id> = states.iter().map(|&index| equations.states[index].rate).collect();
    let (mut given, mut known) = (BTreeMap::new(), BTreeMap::new());
    for symbol in pool.symbols(&rates) {
        if let Symbol::State(index) = symbol {
            given.insert(symbol, pool.symbol(Symbol::Rate(index)));
            known.insert(symbol, equations.states[index as usize].rate);
        }
    }
    let derivatives = derivative(&mut pool, &rates, &given);
    let mut forces: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    for (index, second) in states.iter().zip(derivative(&mut pool, &rates, &known)) {
        forces[*index] = second;
    }
    Second { pool, states, derivatives, forces }
}

/// Whether the state is a displacement or orientation whose rate is a function of momenta, positions and orientations alone,
/// without branches, and of one momentum at least.
fn is_of_second_order(equations: &StateEquations, index: usize) -> bool {
    let (pool, state): (&Pool, &State) = (&equations.pool, &equations.states[index]);
    let storage = |index: u32| equations.states[index as usize].storage;
    let is_kinematic = |id: &Id| match *pool.node(*id) {
        Node::Symbol(Symbol::State(index)) => matches!(storage(index), "I" | "position" | "orientation"),
        Node::Symbol(symbol) => matches!(symbol, Symbol::Parameter(_)),
        Node::Select { .. } => false,
        Node::Number(_) | Node::Sum { .. } | Node::Product(_) | Node::Call(..) => true,
    };
    let is_momentum = |symbol: Symbol| matches!(symbol, Symbol::State(index) if storage(index) == "I");
    matches!(state.storage, "position" | "orientation" | "C")
        && pool.reachable(&[state.rate]).iter().all(is_kinematic)
        && pool.symbols(&[state.rate]).into_iter().any(is_momentum)
}
