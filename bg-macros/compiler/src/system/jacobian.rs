//! The exact derivatives of the rates.
//!
//! In: [`StateEquations`]. Out: the places where df/dx can differ from zero, each with its expression, and df/dt, in a
//! [`Jacobian`] with a pool of its own, so that no other function's order of operations depends on it. An entry that is
//! identically zero has no place.
//! Method: forward accumulation, one sweep for each column (Griewank & Walther 2008, Evaluating Derivatives, ch. 3). What
//! the rates share, such as the force in a joint, is differentiated once for all rows, as equal expressions are one node.
//! The reactions of rigid joints couple every state with every other, while the equations that give them are sparse. So these
//! stand beside the rates, and the reactions beside the states: df/dx is f_x - f_l (r_l)^-1 r_x of the rates f(x, l) with
//! r(x, l) = 0, and nobody has to multiply it out. Dry friction among them keeps df/dx itself, by the implicit function
//! theorem from the factors that solve for the reactions: where others hold already what sticks, r_l has no inverse.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::expr::{Id, Pool, Symbol, derivative};
use crate::system::equations::StateEquations;
use crate::system::equations::solution::Solution;

/// df/dx and df/dt as expressions.
#[derive(Clone, Debug)]
pub struct Jacobian {
    /// The expressions.
    pub pool: Pool,
    /// The reactions that stand beside the states, each with the equation that gives it: rows and columns after those of
    /// the states.
    pub unknowns: Vec<Symbol>,
    /// The entries, row by row, in each row by column.
    pub entries: Vec<Entry>,
    /// df/dt of every rate, the reactions' change with time in it; an input contributes through its own derivative,
    /// [`Symbol::Slope`].
    pub slopes: Vec<Id>,
}

/// An entry that is not identically zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Entry {
    /// The rate's state, or, after the states, the unknown whose equation it is.
    pub row: usize,
    /// The state or the unknown that it is differentiated by.
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

    /// The entries whose rates and states are none of `second_order`.
    pub fn among_first_order(&self, second_order: &Range<usize>) -> impl Iterator<Item = &Entry> {
        let is_among = |entry: &&Entry| !second_order.contains(&entry.row) && !second_order.contains(&entry.column);
        self.entries.iter().filter(is_among)
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
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let unknowns = equations.solution.smooth(&pool).to_vec();
    let rows: Vec<Id> = rates.iter().copied().chain(equations_of(&mut pool, equations, &unknowns)).collect();
    let columns = (0..rates.len()).map(Symbol::state).chain(unknowns.iter().copied());
    let mut entries = Vec::new();
    for (column, symbol) in columns.enumerate() {
        let mut seeds = BTreeMap::from([(symbol, pool.one())]);
        if unknowns.is_empty() {
            seeds = equations.solution.with_rates(&mut pool, &seeds);
        }
        let values = derivative(&mut pool, &rows, &seeds);
        let entry = |(row, value)| Entry { row, column, value };
        entries.extend(values.into_iter().enumerate().map(entry).filter(|entry| !pool.is_zero(entry.value)));
    }
    entries.sort_by_key(|entry| (entry.row, entry.column));
    let slopes = slopes(&mut pool, equations, &rates);
    let mut jacobian = Jacobian { pool, unknowns, entries, slopes };
    jacobian.close(&equations.solution);
    jacobian
}

/// The equations of the unknowns: left sides that are zero. A reaction that is not kept is zero.
fn equations_of(pool: &mut Pool, equations: &StateEquations, unknowns: &[Symbol]) -> Vec<Id> {
    let mut equation = |(row, &unknown): (usize, &Symbol)| {
        let residual = equations.solution.residuals[row];
        let Some(kept) = equations.holding.kept(row) else { return residual };
        let (kept, unknown) = (pool.symbol(Symbol::Kept(kept)), pool.symbol(unknown));
        let (asked, left) = (pool.mul(kept, residual), pool.mul(kept, unknown));
        pool.linear(0.0, &[(asked, 1.0), (unknown, 1.0), (left, -1.0)])
    };
    unknowns.iter().enumerate().map(&mut equation).collect()
}

/// df/dt of every rate.
fn slopes(pool: &mut Pool, equations: &StateEquations, rates: &[Id]) -> Vec<Id> {
    let mut seeds = BTreeMap::from([(Symbol::Time, pool.one())]);
    for index in 0..equations.inputs.len() {
        let [input, slope] = [Symbol::Input, Symbol::Slope].map(|symbol| Symbol::numbered(symbol, index));
        seeds.insert(input, pool.symbol(slope));
    }
    let seeds = equations.solution.with_rates(pool, &seeds);
    derivative(pool, rates, &seeds)
}

impl Jacobian {
    /// Puts the reactions' values in their places.
    fn close(&mut self, solution: &Solution) {
        let roots = self.roots();
        let closed = solution.closed(&mut self.pool, &roots);
        let (entries, slopes) = closed.split_at(self.entries.len());
        self.entries.iter_mut().zip(entries).for_each(|(entry, &value)| entry.value = value);
        self.slopes = slopes.to_vec();
    }
}
