//! State equations: what every bond carries, as scalar expressions of states, parameters, inputs and time.
//!
//! In: [`CausalGraph`]. Out: [`StateEquations`]. No longer occurs: bonds, ports and junctions; scalars only from here.
//! Method: the causal strokes say which end gives effort and which gives flow, so every bond variable is one expression;
//! storages in integral causality turn theirs into rates.

mod fault;
mod kinematics;
mod laws;
mod loops;
mod reactions;
mod signals;
mod storage;
mod terms;
#[cfg(test)]
mod tests;
mod text;
mod value;

use crate::causality::CausalGraph;
use crate::expr::{Id, Pool, Symbol};
use crate::fault::Staged;
use crate::graph::{Input, Parameter};

pub use fault::EquationFault;
pub use value::Value;

/// The model as scalar expressions over one pool.
#[derive(Debug)]
pub struct StateEquations {
    /// The expressions.
    pub pool: Pool,
    /// Parameters; `Symbol::Parameter` counts them.
    pub parameters: Vec<Parameter>,
    /// Inputs; `Symbol::Input` counts them.
    pub inputs: Vec<Input>,
    /// States; `Symbol::State` counts them.
    pub states: Vec<State>,
    /// First guess of each unknown of the assembly, from parameters; `Symbol::Unknown` counts them.
    pub guesses: Vec<Id>,
    /// Gaps of the assembly, from parameters and unknowns.
    pub gaps: Vec<Gap>,
    /// Switches.
    pub switches: Vec<Switch>,
    /// Scalar outputs.
    pub outputs: Vec<Output>,
    /// Energy in all storages, J.
    pub stored: Id,
    /// Power of all sources, W.
    pub supplied: Id,
    /// Power of all resistors, W.
    pub dissipated: Id,
    /// States with the expression that `project` gives them.
    pub projections: Vec<(usize, Id)>,
    /// Reactions of rigid joints that are not solved for yet.
    pub reactions: Vec<Reaction>,
    /// Effort and flow of every bond, component by component.
    pub bonds: Vec<(Vec<Id>, Vec<Id>)>,
    /// The equations of the causal graph as text, one line each.
    pub texts: Vec<String>,
}

/// A state.
#[derive(Clone, Debug)]
pub struct State {
    /// Its name, such as `rod.linear.p_x`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// `C`, `I`, `position`, `orientation` or `integral`.
    pub storage: &'static str,
    /// Its value at t = 0, from parameters and unknowns.
    pub start: Id,
    /// Its rate.
    pub rate: Id,
}

/// The reaction of a residual sink: the effort that keeps a flow at zero.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// The sink.
    pub element: String,
    /// The effort, an atom.
    pub multiplier: Symbol,
    /// The flow to be kept at zero.
    pub flow: Id,
    /// Its integral as the poses have it, where they do.
    pub gap: Option<Id>,
}

/// One residual of the assembly.
#[derive(Clone, Debug)]
pub struct Gap {
    /// The joint.
    pub joint: String,
    /// `x`, `y`, `z`, or empty for a scalar.
    pub component: &'static str,
    /// `m` or `rad`.
    pub unit: String,
    /// The gap at t = 0.
    pub value: Id,
}

/// A switch of a law.
#[derive(Clone, Debug)]
pub struct Switch {
    /// What switches.
    pub element: String,
    /// The guard: below zero the first branch holds.
    pub guard: Id,
}

/// A scalar output.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name with its component's suffix.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: Id,
}

/// Derives the state equations.
///
/// # Errors
/// Algebraic loops, transformers that are not linear, energies that cannot be found.
pub fn derive(causal: &CausalGraph) -> Staged<StateEquations> {
    signals::Signals::new(causal).derive()
}
