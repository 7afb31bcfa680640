//! State equations: what every bond carries, as scalar expressions of states, parameters, inputs and time.
//!
//! In: [`CausalGraph`]. Out: [`StateEquations`]. No longer occurs: bonds, ports and junctions; scalars only from here.
//! Method: the causal strokes say which end gives effort and which gives flow, so every bond variable is one
//! expression; storages in integral causality turn theirs into rates, those in derivative causality differentiate
//! theirs. What depends on itself is an unknown with an equation, which is solved in symbols where it is linear, by an
//! iteration at run time where it is not.

pub mod definite;
mod dependent;
mod energy;
mod fallible;
mod fault;
mod friction;
mod holding;
pub mod impact;
mod independent;
mod iteration;
mod kinematics;
mod laws;
mod loops;
mod memo;
mod origin;
mod reactions;
mod replace;
mod requirements;
mod shown;
mod signals;
pub mod solution;
mod solving;
pub mod stage;
pub mod stop;
mod storage;
mod tables;
mod terms;
#[cfg(test)]
mod tests;
mod text;
mod unknowns;
mod ways;

use crate::expr::{Id, Pool, Symbol, text as expression_text};
use crate::fault::Staged;
use crate::graph::{CausalGraph, Delay, Input, Parameter};
use crate::system::inverse::InverseDynamics;
use crate::system::requirements::Requirements;
use independent::Kept;

pub use crate::system::equations::solution::Solution;
pub use fallible::FallibleLaw;
pub use fault::EquationFault;
pub use holding::{Holding, Slip};
pub use impact::{Impacts, Rebound, Struck, Unlocked};
pub use iteration::Iteration;
pub use origin::{Kind, Origin};
pub use shown::{Quantity, Shown};

/// The model as scalar expressions over one pool.
#[derive(Clone, Debug)]
pub struct StateEquations {
    /// The expressions.
    pub pool: Pool,
    /// Parameters; `Symbol::Parameter` counts them.
    pub parameters: Vec<Parameter>,
    /// Inputs; `Symbol::Input` counts them.
    pub inputs: Vec<Input>,
    /// The names of the positions and orientations that origins count.
    pub tracks: Vec<String>,
    /// States; `Symbol::State` counts them.
    pub states: Vec<State>,
    /// From what the start is made.
    pub assembly: Assembly,
    /// Switches.
    pub switches: Vec<Switch>,
    /// Scalar outputs.
    pub outputs: Vec<Output>,
    /// Energies and powers.
    pub balance: Balance,
    /// States of the pose with the expression that `project` gives them.
    pub projections: Vec<(usize, Id)>,
    /// Momenta with the expression that `project` gives them after that.
    pub settled: Vec<(usize, Id)>,
    /// The delays of signals; their states are the memories of these indices.
    pub delays: Vec<Delay>,
    /// What laws give that can make numbers which are not finite, in the order of evaluation.
    pub fallible: Vec<FallibleLaw>,
    /// The algebraic loops that are solved at run time.
    pub iterations: Vec<Iteration>,
    /// Reactions of rigid joints that are not solved for yet.
    pub reactions: Vec<Reaction>,
    /// Those that are: symbols in the equations until these are closed.
    pub solution: Solution,
    /// What joints hold.
    pub holding: Holding,
    /// Of bodies in the coordinates of joints the efforts that their accelerations take.
    pub inverse: Option<InverseDynamics>,
    /// Of a tree whose joints stops lock, the rates without these, until the reactions are solved for.
    pub unlocked: Option<Unlocked>,
    /// What impacts are calculated from.
    pub impacts: Impacts,
    /// The rate of Baumgarte's terms, 1/s; none where rigid joints are kept by projection.
    pub baumgarte: Option<f64>,
    /// What pictures show.
    pub shown: Shown,
    /// What is asked of the values that parameters give.
    pub requirements: Requirements,
    /// The equations of the causal graph as text, one line each.
    pub texts: Vec<String>,
}

/// From what the start is made: unknowns, which may be of the pose or velocities, that close gaps.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// First guess of each unknown, from parameters; `Symbol::Unknown` counts them.
    pub guesses: Vec<Id>,
    /// The unknowns that are velocities, ascending; the others are of the pose.
    pub speeds: Vec<usize>,
    /// Gaps, from parameters and unknowns.
    pub gaps: Vec<Gap>,
    /// What the sides of roots have the signs of, from parameters and unknowns; `Symbol::Side` counts them.
    pub sides: Vec<Id>,
    /// Whether impulses of the rigid joints make the start velocities fit.
    pub impulse: bool,
}

/// Energies, and powers over the boundary of a model: d(stored)/dt = supplied - dissipated.
#[derive(Clone, Debug)]
pub struct Balance {
    /// Energy in all storages, J.
    pub stored: Id,
    /// Energy in each storage whose state the model knows, J.
    pub energies: Vec<Id>,
    /// Power of all sources, W.
    pub supplied: Id,
    /// Power of all resistors, W.
    pub dissipated: Id,
}

/// A state.
#[derive(Clone, Debug)]
pub struct State {
    /// Its name, such as `rod.linear.p_x`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// What it is.
    pub origin: Origin,
    /// Its value at t = 0, from parameters and unknowns.
    pub start: Id,
    /// Its rate.
    pub rate: Id,
}

/// The reaction of a residual sink: the effort that keeps a flow at zero.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// What it holds: the flow to be kept at zero.
    pub slip: Slip,
    /// The effort.
    pub multiplier: Symbol,
    /// Of dry friction, which is no reaction while it slides, and of a stop, which is none while nothing rests on it.
    pub switched: Option<Switched>,
    /// Of a stop.
    pub rebound: Option<Rebound>,
}

impl Reaction {
    /// Every expression.
    pub fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        let switched = self.switched.iter_mut().flat_map(|switched| [&mut switched.effort, &mut switched.acts]);
        let leaving = self.rebound.iter_mut().flat_map(Rebound::roots);
        self.slip.roots().chain(switched).chain(leaving)
    }
}

/// What dry friction or a stop gives in place of its multiplier.
#[derive(Clone, Debug)]
pub struct Switched {
    /// The effort: the multiplier where it holds; where it does not, that of the law of sliding, of a stop 0.
    pub effort: Id,
    /// 1 where it sticks or something rests on it, else 0.
    pub acts: Id,
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
    /// What switches: an element, a `let` or an output.
    pub element: String,
    /// The comparison as written; of dry friction the way in which it slides, of a stop `clear`.
    pub condition: String,
    /// The guard: below zero the first branch holds.
    pub guard: Id,
    /// Whether the guard depends on the switch's own branch, so that the past decides: sliding ends where the flow is
    /// zero, sticking where the effort is at its limit.
    pub remembers: bool,
    /// The clock that it is of, if it is: its guard is 1, and only what computes samples at an instant takes the first
    /// branch.
    pub clock: Option<Clock>,
}

/// When a clock's samples are computed, s: at `first` + k `period`, k = 0, 1, 2...
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Clock {
    /// The time from one instant to the next, of parameters.
    pub period: Id,
    /// The first instant, of parameters.
    pub first: Id,
    /// Of the clock that reads the signals of a delay, `period` long, the delay's index.
    pub delay: Option<usize>,
}

/// The condition of a stop's switch.
const CLEAR: &str = "clear";

impl Switch {
    /// What holds in the first branch, and of whom.
    #[must_use]
    pub fn name(&self) -> String {
        let Self { element, condition, .. } = self;
        if self.clock.is_some() {
            return format!("an instant of `{condition}`");
        }
        if self.remembers && condition == CLEAR {
            format!("being clear of `{element}`")
        } else if self.remembers {
            format!("sliding {condition} of `{element}`")
        } else {
            format!("`if {condition}` of `{element}`")
        }
    }
}

/// A scalar output.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name with its component's suffix.
    pub name: String,
    /// The name without the suffix.
    pub of: String,
    /// What this observes, as written.
    pub observes: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: Id,
}

/// Derives the state equations.
///
/// # Errors
/// Algebraic loops that leave something open, storages in derivative causality whose states have no derivative,
/// transformers that are not linear, energies that cannot be found, numbers that no physics allows.
pub fn derive(causal: &CausalGraph) -> Staged<StateEquations> {
    let mut kept = Kept::default();
    loop {
        let mut signals = signals::Signals::new(causal, &kept);
        match signals.solve_bonds() {
            more if more.components.is_empty() => return signals.derive(),
            more => kept.extend(more),
        }
    }
}

impl StateEquations {
    /// An expression of a pool as text: the equations' own pool or one that grew from it.
    #[must_use]
    pub fn shown(&self, pool: &Pool, id: Id) -> String {
        expression_text(pool, id, &|symbol| self.symbol_name(symbol), &|switch| format!("guard_{switch}"))
    }

    /// A symbol's name in texts.
    #[must_use]
    pub fn symbol_name(&self, symbol: Symbol) -> String {
        symbol_name(symbol, &self.states, &self.parameters, &self.inputs)
    }
}

fn symbol_name(symbol: Symbol, states: &[State], parameters: &[Parameter], inputs: &[Input]) -> String {
    match symbol {
        Symbol::Time => "t".to_owned(),
        Symbol::State(index) => states[index as usize].name.clone(),
        Symbol::Parameter(index) => parameters[index as usize].name.text.clone(),
        Symbol::Input(index) => inputs[index as usize].name.text.clone(),
        Symbol::Unknown(index) => format!("unknown_{}", index + 1),
        Symbol::Law(index) => format!("law_{index}"),
        Symbol::Storage(index) => format!("storage_{index}"),
        Symbol::Flow(index) => format!("flow_{index}"),
        Symbol::Multiplier(index) => format!("multiplier_{index}"),
        Symbol::Kept(index) => format!("kept_{index}"),
        Symbol::Side(index) => format!("side_{index}"),
        Symbol::Turned(index) => format!("turned_{index}"),
        Symbol::Unsolved(index) => format!("unsolved_{index}"),
        Symbol::Found(index) => format!("found_{index}"),
        Symbol::Slope(index) => format!("{}'", inputs[index as usize].name.text),
        Symbol::Rate(index) => format!("{}'", states[index as usize].name),
        Symbol::Weight(index) => format!("weight_{index}"),
    }
}
