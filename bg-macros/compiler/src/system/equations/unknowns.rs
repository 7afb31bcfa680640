//! What has no value yet while the bonds are evaluated, with the equations that give it one.
//!
//! In: bond variables that need themselves, storages in derivative causality. Out: symbols in their places, and for
//! each an expression that is zero where the symbol has its value.
//! Method: tearing (Elmqvist and Otter 1994, Methods for tearing systems of equations in object-oriented modeling): the
//! variable at which a circle closes is the unknown, everything else in the circle an expression of it.

use std::collections::BTreeMap;

use proc_macro2::Span;

use super::signals::Signals;
use crate::expr::{Id, Pool, Symbol};
use crate::graph::{BondId, NodeId, Role};
use crate::system::Value;

/// What a component of an unknown belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Unknown {
    /// A bond variable that needs itself, and the number of the circle in which it was found to.
    Variable(Role, BondId, usize),
    /// The state of a storage in derivative causality.
    State(NodeId),
    /// What such a storage gives on its bond.
    Given(NodeId),
}

/// Bond variables each of which needs the next.
#[derive(Clone, Debug)]
pub(super) struct Circle {
    /// What they belong to; elements where there are any.
    pub nodes: Vec<NodeId>,
    /// The bond at which it closes.
    pub span: Span,
}

/// All unknowns so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Unknowns {
    /// `Symbol::Unsolved` counts them.
    pub all: Vec<Unknown>,
    pub circles: Vec<Circle>,
    /// What is zero where an unknown has its value.
    pub residuals: BTreeMap<u32, Id>,
}

impl Unknowns {
    /// New symbols, one for each component.
    pub fn symbols(&mut self, pool: &mut Pool, of: Unknown, components: usize) -> Value {
        let first = self.all.len();
        self.all.resize(first + components, of);
        Value((first..first + components).map(|k| pool.symbol(Symbol::numbered(Symbol::Unsolved, k))).collect())
    }

    /// The unknowns `of` are such that two values are equal.
    pub fn equate(&mut self, pool: &mut Pool, of: &Value, (left, right): (&Value, &Value)) {
        let numbers: Vec<u32> = pool.symbols(&of.0).into_iter().filter_map(number).collect();
        for (number, (&left, &right)) in numbers.into_iter().zip(left.0.iter().zip(&right.0)) {
            self.residuals.insert(number, pool.sub(left, right));
        }
    }
}

/// The number of an unknown.
pub(super) fn number(symbol: Symbol) -> Option<u32> {
    if let Symbol::Unsolved(number) = symbol { Some(number) } else { None }
}

impl Signals<'_> {
    /// Symbols in the place of a bond variable that needs itself.
    pub(super) fn torn(&mut self, variable: Role, bond: BondId) -> Value {
        let circle = self.circle(variable, bond);
        self.unknowns.circles.push(circle);
        let of = Unknown::Variable(variable, bond, self.unknowns.circles.len() - 1);
        self.unknowns.symbols(&mut self.pool, of, self.graph.bond(bond).cardinality)
    }

    /// The circle that ends where it began: at this variable.
    fn circle(&self, variable: Role, bond: BondId) -> Circle {
        let start = self.path.iter().position(|&step| step == (variable, bond)).unwrap_or(0);
        let mut nodes: Vec<NodeId> = Vec::new();
        for &(_, bond) in &self.path[start..] {
            let ends = self.graph.bond(bond);
            nodes.extend([ends.from, ends.to].into_iter().filter(|node| !nodes.contains(node)).collect::<Vec<_>>());
        }
        // Elements say more; a circle may have none.
        if nodes.iter().any(|&node| self.graph.element(node).is_some()) {
            nodes.retain(|&node| self.graph.element(node).is_some());
        }
        Circle { nodes, span: self.graph.bond(bond).span }
    }
}
