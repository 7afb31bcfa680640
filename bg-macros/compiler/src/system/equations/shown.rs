//! What pictures show of a model beside its outputs: the look of its mechanism, effort and flow of every bond.
//!
//! In: the graph's drawing, bond variables. Out: [`Shown`], which the reductions carry along and that keeps nothing
//! alive: a quantity that needs a state which a scene leaves out is not known there.

use std::collections::BTreeSet;

use super::signals::Signals;
use crate::expr::{Branch, Id, Pool, Symbol, substitute_switched};
use crate::graph::Drawing;
use crate::system::equations::solution::Known;

/// The components of a quantity; none where it is not known.
pub type Quantity = Option<Vec<Id>>;

/// What pictures show.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The look of the mechanism.
    pub drawing: Drawing<Quantity>,
    /// Effort and flow of every bond.
    pub bonds: Vec<[Quantity; 2]>,
}

impl Shown {
    /// Every quantity: those of the drawing in its order, then effort and flow of each bond.
    #[must_use]
    pub fn quantities(&self) -> Vec<&Quantity> {
        let mut quantities = Vec::new();
        self.drawing.map(&mut |quantity| quantities.push(quantity));
        quantities.extend(self.bonds.iter().flatten());
        quantities
    }

    /// Replaces symbols and decides switches everywhere.
    pub fn replace(&mut self, pool: &mut Pool, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let before: Vec<Id> = self.quantities().into_iter().flatten().flatten().copied().collect();
        let mut after = substitute_switched(pool, &before, replace, branch).into_iter();
        self.map(|quantity| quantity.as_ref().map(|ids| after.by_ref().take(ids.len()).collect()));
    }

    /// Forgets what needs a state or switch that goes.
    pub fn prune(&mut self, pool: &Pool, known: &Known) {
        self.retain(|id| known.has(pool, id));
    }

    /// Forgets what reads one of these symbols.
    pub fn forget(&mut self, pool: &Pool, symbols: &BTreeSet<Symbol>) {
        self.retain(|id| pool.symbols(&[id]).iter().all(|symbol| !symbols.contains(symbol)));
    }

    /// Forgets the quantities of which not all components stay.
    fn retain(&mut self, stays: impl Fn(Id) -> bool) {
        self.map(|quantity| quantity.clone().filter(|ids| ids.iter().all(|&id| stays(id))));
    }

    fn map(&mut self, mut make: impl FnMut(&Quantity) -> Quantity) {
        self.drawing = self.drawing.map(&mut make);
        for quantity in self.bonds.iter_mut().flatten() {
            *quantity = make(quantity);
        }
    }
}

impl Signals<'_> {
    /// What pictures show, where bonds carry `bonds`. Comes last, so that it has no influence on the other expressions;
    /// what would need a switch of its own is not known.
    pub(super) fn shown(&mut self, bonds: Vec<[Quantity; 2]>) -> Shown {
        let (graph, switches, fallible) = (self.graph, self.switches.len(), self.fallible.len());
        let drawing = graph.drawing.map(&mut |term| {
            let value = self.evaluate(term, None);
            let is_known = self.switches.len() == switches;
            self.switches.truncate(switches);
            is_known.then_some(value.0)
        });
        self.fallible.truncate(fallible);
        Shown { drawing, bonds }
    }
}
