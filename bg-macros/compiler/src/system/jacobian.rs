//! The exact derivatives of the rates.
//!
//! In: [`StateEquations`]. Out: the places where df/dx can differ from zero, each with its expression, and df/dt, in a
//! [`Jacobian`] with a pool of its own, so that no other function's order of operations depends on it. An entry that is
//! identically zero has no place.
//! Method: forward accumulation, one sweep for each state (Griewank & Walther 2008, Evaluating Derivatives, ch. 3). What
//! the rates share, such as the force in a joint, is differentiated once for all rows, as equal expressions are one node.
//! The reactions of rigid joints follow from the factors that solve for them, by the implicit function theorem.

use std::collections::BTreeMap;

use crate::expr::{Id, Pool, Symbol, derivative};
use crate::system::equations::StateEquations;
use crate::system::equations::solution::Solution;

/// df/dx and df/dt as expressions.
#[derive(Clone, Debug)]
pub struct Jacobian {
    /// The expressions.
    pub pool: Pool,
    /// The entries, row by row, in each row by column.
    pub entries: Vec<Entry>,
    /// df/dt of every rate; an input contributes through its own derivative, [`Symbol::Slope`].
    pub slopes: Vec<Id>,
}

/// An entry of df/dx that is not identically zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Entry {
    /// The rate's state.
    pub row: usize,
    /// The state that the rate is differentiated by.
    pub column: usize,
    /// The derivative.
    pub value: Id,
}

impl Jacobian {
    /// Row and column of every entry.
    #[must_use]
    pub fn places(&self) -> Vec<(usize, usize)> {
        self.entries.iter().map(|entry| (entry.row, entry.column)).collect()
    }

    /// All derivatives: the entries, then the slopes.
    #[must_use]
    pub fn roots(&self) -> Vec<Id> {
        self.entries.iter().map(|entry| entry.value).chain(self.slopes.iter().copied()).collect()
    }
}

/// Differentiates the rates. Switched laws are differentiated branch by branch: a switch is frozen.
#[must_use]
pub fn differentiate(equations: &StateEquations) -> Jacobian {
    let mut pool = equations.pool.clone();
    let rates = Rates::of(equations);
    let mut entries = Vec::new();
    for column in 0..equations.states.len() {
        let seeds = BTreeMap::from([(Symbol::state(column), pool.one())]);
        let values = rates.along(&mut pool, &seeds);
        let entry = |(row, value)| Entry { row, column, value };
        entries.extend(values.into_iter().enumerate().map(entry).filter(|entry| !pool.is_zero(entry.value)));
    }
    entries.sort_by_key(|entry| (entry.row, entry.column));
    let mut seeds = BTreeMap::from([(Symbol::Time, pool.one())]);
    for index in 0..equations.inputs.len() {
        let [input, slope] = [Symbol::Input, Symbol::Slope].map(|symbol| Symbol::numbered(symbol, index));
        seeds.insert(input, pool.symbol(slope));
    }
    let slopes = rates.along(&mut pool, &seeds);
    Jacobian { pool, entries, slopes }
}

/// The rates, in which reactions of rigid joints are symbols.
struct Rates<'a> {
    open: Vec<Id>,
    solution: &'a Solution,
}

impl<'a> Rates<'a> {
    fn of(equations: &'a StateEquations) -> Self {
        Self { open: equations.states.iter().map(|state| state.rate).collect(), solution: &equations.solution }
    }

    /// The rates' derivatives where symbols change as `seeds` say, and the reactions with them.
    fn along(&self, pool: &mut Pool, seeds: &BTreeMap<Symbol, Id>) -> Vec<Id> {
        let seeds = self.solution.with_rates(pool, seeds);
        let values = derivative(pool, &self.open, &seeds);
        self.solution.closed(pool, &values)
    }
}
