//! Algebraic loops that are not linear: Newton's iteration at run time, its last step in the equations.
//!
//! In: groups of unknowns with the expressions g(u) that are zero where the unknowns have their values. Out: an
//! [`Iteration`] for each group, and in the place of each unknown one step of it, u - G(u)^-1 g(u) with G = dg/du, at
//! the u that it has found. Method: at a solution the derivatives of that step by everything but u are those of the
//! implicit function, -G^-1 dg, as g is zero there (Krantz and Parks 2013, The Implicit Function Theorem, ch. 1). So
//! Jacobians, second derivatives, dual numbers and series need nothing of their own, and numbers with more digits than
//! the iteration's gain as many again.

use std::collections::BTreeMap;

use super::StateEquations;
use super::unknowns::number;
use crate::expr::{Function, Id, Linear, Node, Number, Pool, Symbol, partial, solve_linear, substitute};

/// A group of unknowns that an iteration finds.
#[derive(Clone, Debug)]
pub struct Iteration {
    /// The elements in the loop.
    pub members: Vec<String>,
    /// The first of its [`Symbol::Found`].
    pub first: u32,
    /// What is zero at the solution.
    pub residuals: Vec<Id>,
    /// How large the terms of each residual are: what it is rounded beside.
    pub sizes: Vec<Id>,
    /// The derivatives of each residual by each unknown.
    pub slopes: Vec<Vec<Id>>,
    /// The unknowns: what is found, after one more step.
    pub values: Vec<Id>,
}

impl Iteration {
    /// Every expression.
    pub(super) fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        let slopes = self.slopes.iter_mut().flatten();
        self.residuals.iter_mut().chain(&mut self.sizes).chain(slopes).chain(&mut self.values)
    }

    /// The residuals, their sizes, then their derivatives by the unknowns, row by row.
    pub fn equations(&self) -> impl Iterator<Item = Id> {
        self.residuals.iter().chain(&self.sizes).chain(self.slopes.iter().flatten()).copied()
    }

    /// The symbols of what it finds.
    pub fn found(&self) -> impl Iterator<Item = Symbol> {
        (self.first..).map(Symbol::Found).take(self.residuals.len())
    }
}

/// An algebraic loop that is not linear.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    /// The elements in it.
    pub members: Vec<String>,
    /// The numbers of its unknowns.
    pub unknowns: Vec<u32>,
    /// What is zero at the solution, of these unknowns and those of earlier loops.
    pub residuals: Vec<Id>,
}

impl StateEquations {
    /// How many unknowns iterations find.
    #[must_use]
    pub fn found(&self) -> usize {
        self.iterations.last().map_or(0, |last| last.first as usize + last.residuals.len())
    }

    /// Puts the last step of its iteration in the place of each loop's unknowns.
    pub(super) fn iterate(&mut self, loops: Vec<Loop>) {
        let mut values: BTreeMap<u32, Id> = BTreeMap::new();
        let mut iterations: Vec<Iteration> = Vec::new();
        let mut first = 0;
        for Loop { members, unknowns, residuals } in loops {
            let pool = &mut self.pool;
            let found: Vec<Id> = (first..).map(|k| pool.symbol(Symbol::Found(k))).take(unknowns.len()).collect();
            let known = |symbol| {
                let number = number(symbol)?;
                let own = unknowns.iter().position(|&unknown| unknown == number);
                own.map(|own| found[own]).or_else(|| values.get(&number).copied())
            };
            let residuals = substitute(pool, &residuals, &known);
            let sizes = residuals.iter().map(|&residual| size(pool, residual)).collect();
            let mut iteration = Iteration { members, first, residuals, sizes, slopes: Vec::new(), values: Vec::new() };
            iteration.differentiate(pool);
            values.extend(unknowns.iter().copied().zip(iteration.values.iter().copied()));
            first += u32::try_from(unknowns.len()).expect("fewer than 2^32 unknowns");
            iterations.push(iteration);
        }
        self.iterations = iterations;
        self.replace(&|symbol| values.get(&number(symbol)?).copied());
    }
}

/// The sum of the absolute values of an expression's terms.
fn size(pool: &mut Pool, id: Id) -> Id {
    let (constant, terms) = match pool.node(id) {
        Node::Sum { constant, terms } => (constant.value().abs(), terms.to_vec()),
        _ => (0.0, vec![(id, Number::new(1.0))]),
    };
    let terms: Vec<(Id, f64)> = terms
        .into_iter()
        .map(|(term, coefficient)| (pool.call(Function::Abs, &[term]), coefficient.value().abs()))
        .collect();
    pool.linear(constant, &terms)
}

impl Iteration {
    fn differentiate(&mut self, pool: &mut Pool) {
        let found: Vec<Symbol> = self.found().collect();
        let columns: Vec<Vec<Id>> = found.iter().map(|&symbol| partial(pool, &self.residuals, symbol)).collect();
        self.slopes = (0..found.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect();
        let zero = pool.zero();
        let entries = |row: &Vec<Id>| row.iter().copied().enumerate().filter(|(_, slope)| *slope != zero).collect();
        let rows = self.slopes.iter().map(entries).collect();
        let right = self.residuals.iter().map(|&residual| pool.neg(residual)).collect();
        // Where this has no solution, neither has the iteration: its result is then not a number.
        let step = solve_linear(pool, Linear { rows, right }, &|_, _| false).map(|solution| solution.values);
        let step = step.unwrap_or_else(|_| vec![pool.number(f64::NAN); found.len()]);
        self.values = found
            .iter()
            .zip(step)
            .map(|(&symbol, step)| {
                let found = pool.symbol(symbol);
                pool.add(found, step)
            })
            .collect();
    }
}
