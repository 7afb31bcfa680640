//! The reverse sweeps of a model's functions.
//!
//! In: the programs of the running model. Out: for each function that a run is made of how a weighted sum of its
//! results depends on states and constants. Adjoint gradients follow a run backwards with them. Their operations are
//! those of the functions, in no other order.

use super::programs::Running;
use super::{Operand, Reverse, Routine, reverse};
use crate::expr::Symbol;

/// The reverse sweeps of functions that read the running model's table of constants.
#[derive(Debug)]
pub struct Reversed {
    /// Of the rates of all states.
    pub rate: Reverse,
    /// Of the outputs; none where they read reactions that are found while the model runs.
    pub outputs: Option<Reverse>,
    /// Of the states of the pose that a projection moves.
    pub project: Reverse,
    /// Of the momenta that it moves after that.
    pub settle: Reverse,
}

impl Reversed {
    /// All of them.
    pub fn sweeps(&self) -> impl Iterator<Item = &Reverse> {
        [&self.rate].into_iter().chain(&self.outputs).chain([&self.project, &self.settle])
    }
}

/// The reverse sweeps of the functions of a model with so many states.
#[must_use]
pub fn reversed(running: &Running, states: usize) -> Reversed {
    let of = |routine: &Routine| reverse(routine, routine.results.len(), &format!("reverse_{}", routine.name));
    Reversed {
        // What iterations find comes after the rates.
        rate: reverse(&running.rate, states, "reverse_rate"),
        outputs: (!reads_reactions(&running.outputs)).then(|| of(&running.outputs)),
        project: of(&running.project),
        settle: of(&running.settle),
    }
}

fn reads_reactions(routine: &Routine) -> bool {
    let operands = routine.assignments.iter().flat_map(|assignment| assignment.operation.operands());
    let mut all = operands.chain(routine.results.iter().copied());
    all.any(|operand| matches!(operand, Operand::Symbol(Symbol::Multiplier(_))))
}
