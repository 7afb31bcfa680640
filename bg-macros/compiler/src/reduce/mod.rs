//! Reductions: only what a scene needs, with a proof for everything left out.
//!
//! In: [`StateEquations`] of the literal graph. Out: [`StateEquations`] without the states and parameters that the scene
//! does not need, and a [`Report`] that says why. Every reduction holds for all values of the tunable parameters; it is
//! proved on the equations by induction from the start values, never read off numbers.

mod affine;
mod angle;
mod equal;
mod invariant;
mod live;
mod reaction;
mod report;

use crate::equations::StateEquations;
use crate::expr::{Branch, Id, Pool, Symbol, substitute_switched};
use crate::program::{Counts, Request, schedule};

pub use reaction::solve as solve_reactions;
pub use report::{Count, Fate, Report};

/// Reduces the equations to what a scene needs. `tuned[k]` says that parameter `k` stays adjustable at run time.
///
/// The stages, in order: parameters that are not tuned become numbers; states whose rate vanishes become constants;
/// states that stay equal up to sign become one; with `angles`, orientations about one axis become angles; states that stay an affine combination of others are recovered from
/// them; states that reach no output are dropped.
#[must_use]
pub fn for_scene(mut equations: StateEquations, tuned: &[bool], angles: bool) -> (StateEquations, Report) {
    let mut report = Report::new(&equations);
    report.count("literal", &mut equations);
    fold_parameters(&mut equations, tuned);
    report.count("parameters folded", &mut equations);
    invariant::fold(&mut equations, &mut report);
    report.count("constant states folded", &mut equations);
    equal::merge(&mut equations, &mut report);
    report.count("equal states merged", &mut equations);
    if !equations.reactions.is_empty() {
        reaction::solve(&mut equations);
        report.count("reactions solved", &mut equations);
    }
    if angles {
        angle::integrate(&mut equations, &mut report);
        report.count("orientations turned into angles", &mut equations);
    }
    affine::recover(&mut equations, &mut report);
    report.count("affine states recovered", &mut equations);
    live::drop_unwatched(&mut equations, &mut report);
    report.count("unwatched states dropped", &mut equations);
    (equations, report)
}

/// Replaces parameters that no one tunes by their defaults; the others keep their order.
fn fold_parameters(equations: &mut StateEquations, tuned: &[bool]) {
    let mut images = Vec::new();
    let mut kept = Vec::new();
    for (parameter, &is_tuned) in equations.parameters.iter().zip(tuned) {
        images.push(if is_tuned {
            kept.push(parameter.clone());
            equations.pool.symbol(Symbol::Parameter(index(kept.len() - 1)))
        } else {
            equations.pool.number(parameter.default)
        });
    }
    equations.parameters = kept;
    equations.replace(&|symbol| match symbol {
        Symbol::Parameter(parameter) => images.get(parameter as usize).copied(),
        _ => None,
    });
    settle_switches(equations);
}

/// Switches whose guard has become a number are decided; their values become those of the branch.
fn settle_switches(equations: &mut StateEquations) {
    let mut kept = 0;
    let branches: Vec<Branch> = equations
        .switches
        .iter()
        .map(|switch| match equations.pool.as_number(switch.guard) {
            Some(value) if value < 0.0 => Branch::Negative,
            Some(_) => Branch::Positive,
            None => {
                kept += 1;
                Branch::Kept(kept - 1)
            }
        })
        .collect();
    keep_switches(equations, &branches);
}

/// Decides or renumbers every switch.
fn keep_switches(equations: &mut StateEquations, branches: &[Branch]) {
    let branch = |switch: u32| branches[switch as usize];
    equations.replace_switched(&|_| None, &branch);
    let kept = |switch: usize| matches!(branches[switch], Branch::Kept(_));
    let switches = std::mem::take(&mut equations.switches);
    equations.switches = switches.into_iter().enumerate().filter(|(k, _)| kept(*k)).map(|(_, s)| s).collect();
}

/// An index as symbols carry it.
fn index(of: usize) -> u32 {
    u32::try_from(of).expect("fewer than 2^32 symbols")
}

/// The index of a state symbol.
fn state_of(symbol: Symbol) -> Option<usize> {
    if let Symbol::State(state) = symbol { Some(state as usize) } else { None }
}

/// Whether an expression depends on parameters and numbers only.
fn is_constant(pool: &Pool, id: Id) -> bool {
    pool.symbols(&[id]).into_iter().all(|symbol| matches!(symbol, Symbol::Parameter(_)))
}

impl StateEquations {
    /// Every expression of the model that depends on states.
    fn roots(&mut self) -> Vec<&mut Id> {
        let mut roots: Vec<&mut Id> = Vec::new();
        for state in &mut self.states {
            roots.push(&mut state.start);
            roots.push(&mut state.rate);
        }
        roots.extend(&mut self.guesses);
        roots.extend(self.gaps.iter_mut().map(|gap| &mut gap.value));
        roots.extend(self.switches.iter_mut().map(|switch| &mut switch.guard));
        roots.extend(self.outputs.iter_mut().map(|output| &mut output.value));
        for reaction in &mut self.reactions {
            roots.push(&mut reaction.slip.flow);
            roots.extend(&mut reaction.gap);
        }
        roots.extend([&mut self.stored, &mut self.supplied, &mut self.dissipated]);
        roots.extend(self.projections.iter_mut().map(|(_, id)| id));
        for (efforts, flows) in &mut self.bonds {
            roots.extend(efforts);
            roots.extend(flows);
        }
        roots
    }

    /// Replaces symbols everywhere.
    fn replace(&mut self, replace: &dyn Fn(Symbol) -> Option<Id>) {
        self.replace_switched(replace, &Branch::Kept);
    }

    fn replace_switched(&mut self, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let mut pool = std::mem::take(&mut self.pool);
        let before: Vec<Id> = self.roots().into_iter().map(|id| *id).collect();
        let after = substitute_switched(&mut pool, &before, replace, branch);
        for (root, id) in self.roots().into_iter().zip(after) {
            *root = id;
        }
        // What is held comes after, so that it has no say in the order of the rates' nodes.
        self.holding.replace(&mut pool, replace, branch);
        self.pool = pool;
    }

    /// Operations of the rate function as it would be generated now.
    fn rate_operations(&mut self) -> Counts {
        let rates: Vec<Id> = self.states.iter().map(|state| state.rate).collect();
        let program = schedule(&mut self.pool, &[Request { name: "rate", roots: &rates }]);
        program.routines[0].counts
    }
}

#[cfg(test)]
mod tests;
