//! Values in the places of symbols, in all equations.
//!
//! In: [`StateEquations`], what stands for each symbol. Out: the same with it in every expression.

use super::{StateEquations, Unlocked};
use crate::expr::{Branch, Id, Pool, Symbol, substitute_switched};

impl StateEquations {
    /// Every expression of the model that depends on states.
    fn roots(&mut self) -> Vec<&mut Id> {
        let mut roots: Vec<&mut Id> = Vec::new();
        for state in &mut self.states {
            roots.push(&mut state.start);
            roots.push(&mut state.rate);
        }
        roots.extend(&mut self.assembly.guesses);
        roots.extend(self.assembly.gaps.iter_mut().map(|gap| &mut gap.value));
        for switch in &mut self.switches {
            roots.push(&mut switch.guard);
            roots.extend(switch.clock.iter_mut().flat_map(|clock| [&mut clock.period, &mut clock.first]));
        }
        roots.extend(self.outputs.iter_mut().map(|output| &mut output.value));
        for reaction in &mut self.reactions {
            roots.extend(reaction.roots());
        }
        roots.extend([&mut self.balance.stored, &mut self.balance.supplied, &mut self.balance.dissipated]);
        for iteration in &mut self.iterations {
            roots.extend(iteration.roots());
        }
        roots.extend(&mut self.assembly.sides);
        roots.extend(self.projections.iter_mut().chain(&mut self.settled).map(|(_, id)| id));
        roots.extend(self.unlocked.iter_mut().flat_map(Unlocked::roots));
        roots
    }

    /// Puts the values of the reactions in the places of their symbols, everywhere.
    ///
    /// Where joints close loops, outputs and what is shown keep the symbols: there a model shares reactions that are
    /// not unique before it evaluates these.
    pub(crate) fn close(&mut self) {
        let solution = std::mem::take(&mut self.solution);
        if solution.values.is_empty() {
            return;
        }
        let (outputs, shown) = (self.outputs.clone(), self.shown.clone());
        self.replace(&|symbol| solution.value(symbol));
        if self.holding.is_shared() {
            (self.outputs, self.shown) = (outputs, shown);
        }
        self.solution = solution;
    }

    /// Writes every expression that depends on states anew, as they are in a state that fits: not what makes it fit.
    pub fn rewrite(&mut self, written: &dyn Fn(&mut Pool, &[Id]) -> Vec<Id>) {
        let mut pool = std::mem::take(&mut self.pool);
        let projections = std::mem::take(&mut self.projections);
        let before: Vec<Id> = self.roots().into_iter().map(|id| *id).collect();
        let after = written(&mut pool, &before);
        self.roots().into_iter().zip(after).for_each(|(root, id)| *root = id);
        (self.pool, self.projections) = (pool, projections);
    }

    /// Replaces symbols everywhere.
    pub fn replace(&mut self, replace: &dyn Fn(Symbol) -> Option<Id>) {
        self.replace_switched(replace, &Branch::Kept);
    }

    /// Replaces symbols and decides switches everywhere.
    pub fn replace_switched(&mut self, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let mut pool = std::mem::take(&mut self.pool);
        let before: Vec<Id> = self.roots().into_iter().map(|id| *id).collect();
        let after = substitute_switched(&mut pool, &before, replace, branch);
        for (root, id) in self.roots().into_iter().zip(after) {
            *root = id;
        }
        let stops = self.unlocked.iter_mut().flat_map(|unlocked| &mut unlocked.stops);
        for stop in self.reactions.iter_mut().chain(stops).filter_map(|reaction| reaction.rebound.as_mut()) {
            if let Branch::Kept(number) = branch(stop.switch) {
                stop.switch = number;
            }
        }
        // By themselves, after the others: so they have no influence on the order of terms.
        let values: Vec<Id> = self.fallible.iter().map(|law| law.value).collect();
        let after = substitute_switched(&mut pool, &values, replace, branch);
        for (law, value) in self.fallible.iter_mut().zip(after) {
            law.value = value;
        }
        self.balance.energies = substitute_switched(&mut pool, &self.balance.energies, replace, branch);
        // What is held and shown comes after, so that it has no influence on the order of the rates' nodes.
        self.solution.replace(&mut pool, replace, branch);
        self.holding.replace(&mut pool, replace, branch);
        self.impacts.replace(&mut pool, replace, branch);
        self.shown.replace(&mut pool, replace, branch);
        if let Some(inverse) = &mut self.inverse {
            inverse.replace(&mut pool, replace, branch);
        }
        self.pool = pool;
    }
}
