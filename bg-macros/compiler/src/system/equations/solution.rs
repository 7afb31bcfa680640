//! The reactions of rigid joints after they are solved for: symbols in the equations, each with its value.
//!
//! In: [`Solution`] from `reduce::reaction`. Out: values in the symbols' places, and how the reactions change with what
//! they depend on, from the factors that solve for them: (A l + b)' = 0 gives l' = -A^-1 (A' l + b').

use std::collections::BTreeMap;

use crate::expr::{Branch, Id, Node, Pool, Symbol, derivative, substitute, substitute_switched};
use crate::system::equations::definite::{Factors, filter};

/// The reactions with their values.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// The reactions, in the order of the rows.
    pub multipliers: Vec<Symbol>,
    /// A l + b, with the reactions as symbols.
    pub residuals: Vec<Id>,
    /// What each reaction applies: itself; of dry friction the effort of its law where it slides, of a stop 0 where
    /// nothing rests on it.
    pub efforts: Vec<Id>,
    /// The factors of A.
    pub factors: Factors,
    /// The reactions' values, in which none of the symbols occurs.
    pub values: Vec<Id>,
}

impl Solution {
    /// The row of a reaction.
    #[must_use]
    pub fn row(&self, symbol: Symbol) -> Option<usize> {
        self.multipliers.iter().position(|&multiplier| multiplier == symbol)
    }

    /// The reactions whose equations have a regular derivative by them: all, or none where there is dry friction or a
    /// stop.
    #[must_use]
    pub fn smooth(&self, pool: &Pool) -> &[Symbol] {
        let is_itself = |(&effort, &symbol): (&Id, &Symbol)| *pool.node(effort) == Node::Symbol(symbol);
        if self.efforts.iter().zip(&self.multipliers).all(is_itself) { &self.multipliers } else { &[] }
    }

    /// The value of a reaction.
    #[must_use]
    pub fn value(&self, symbol: Symbol) -> Option<Id> {
        Some(self.values[self.row(symbol)?])
    }

    /// Expressions with the reactions' values in the places of the symbols.
    pub fn closed(&self, pool: &mut Pool, ids: &[Id]) -> Vec<Id> {
        if self.values.is_empty() {
            return ids.to_vec();
        }
        substitute(pool, ids, &|symbol| self.value(symbol))
    }

    /// `seeds`, the rates of what the reactions depend on, with those of the reactions.
    #[must_use]
    pub fn with_rates(&self, pool: &mut Pool, seeds: &BTreeMap<Symbol, Id>) -> BTreeMap<Symbol, Id> {
        let residuals = derivative(pool, &self.residuals, seeds);
        let right: Vec<Id> = residuals.iter().map(|&residual| pool.neg(residual)).collect();
        let solved = self.factors.solve(pool, &right);
        let mut all = seeds.clone();
        all.extend(self.multipliers.iter().copied().zip(solved));
        let applied = derivative(pool, &self.efforts, &all);
        all.extend(self.multipliers.iter().copied().zip(applied));
        all
    }

    /// Replaces symbols and decides switches everywhere.
    pub fn replace(&mut self, pool: &mut Pool, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let roots =
            self.residuals.iter_mut().chain(&mut self.efforts).chain(self.factors.roots()).chain(&mut self.values);
        let roots: Vec<&mut Id> = roots.collect();
        let before: Vec<Id> = roots.iter().map(|id| **id).collect();
        let after = substitute_switched(pool, &before, replace, branch);
        roots.into_iter().zip(after).for_each(|(root, id)| *root = id);
    }

    /// For each reaction whether its value is known.
    #[must_use]
    pub fn known(&self, pool: &Pool, known: &Known) -> Vec<bool> {
        self.values.iter().map(|&value| known.has(pool, value)).collect()
    }

    /// Forgets the reactions that are not kept.
    pub fn retain(&mut self, kept: &[bool]) {
        let keep = |ids: &mut Vec<Id>| filter(ids, kept);
        keep(&mut self.residuals);
        keep(&mut self.efforts);
        keep(&mut self.values);
        self.factors.retain(kept);
        filter(&mut self.multipliers, kept);
    }
}

/// What a model still has after states and switches have gone.
#[derive(Clone, Debug)]
pub struct Known<'a> {
    /// For each state whether it is there.
    states: &'a [bool],
    /// For each switch.
    switches: &'a [bool],
    /// The reactions whose values are not known.
    unknown: Vec<Symbol>,
}

impl<'a> Known<'a> {
    /// What the marked states and switches leave.
    #[must_use]
    pub fn of(pool: &Pool, states: &'a [bool], switches: &'a [bool], solution: &Solution) -> Self {
        let mut known = Self { states, switches, unknown: Vec::new() };
        let reactions = solution.multipliers.iter().zip(&solution.values);
        let unknown = reactions.filter(|&(_, &value)| !known.has(pool, value)).map(|(&symbol, _)| symbol);
        known.unknown = unknown.collect();
        known
    }

    /// Whether a state is there.
    #[must_use]
    pub fn has_state(&self, state: usize) -> bool {
        self.states[state]
    }

    /// Whether a switch is there.
    #[must_use]
    pub fn has_switch(&self, switch: u32) -> bool {
        self.switches[switch as usize]
    }

    /// Whether an expression needs nothing that has gone.
    #[must_use]
    pub fn has(&self, pool: &Pool, id: Id) -> bool {
        pool.reachable(&[id]).into_iter().all(|id| match pool.node(id) {
            Node::Symbol(Symbol::State(state)) => self.states[*state as usize],
            Node::Symbol(symbol) => !self.unknown.contains(symbol),
            Node::Select { switch, .. } => self.switches[*switch as usize],
            _ => true,
        })
    }
}
