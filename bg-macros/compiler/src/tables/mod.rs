//! What a model consists of, as tables: all that is known of it beside its programs.
//!
//! In: a [`Compiled`]. Out: [`Tables`], plain data without an expression. [`crate::emit`] prints them as constants of
//! generated code; who runs programs without rustc reads them as they are.

mod description;
mod drawing;
mod elimination;
mod holding;
mod start;

pub(crate) use description::element_of;
pub use description::{
    Bond, Bounds, Description, Element, Input, Named, Output, Parameter, State, StateKind, Switch, declared,
    description, parameter,
};
pub use drawing::{Body, Drawing, Place, drawing};
pub use elimination::{EliminationTable, Slot, elimination};
pub use holding::{Held, Slip, Stop, Stops, held, stops};
pub use start::{Gap, Requirement, Start, requirements, start};

use std::ops::Range;

use crate::expr::Id;
use crate::graph::DelayedSignal;
use crate::pipeline::Compiled;
use crate::program::{SeriesSize, series_size};
use crate::system::equations::{Iteration, Origin, StateEquations};

/// What is known of a model beside its programs.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// What it consists of, in words.
    pub description: Description,
    /// What its start is checked against.
    pub start: Start,
    /// What is asked of its parameters.
    pub required: Vec<Requirement>,
    /// What joints hold; none where they hold nothing.
    pub held: Option<Held>,
    /// The stops that can be hit; none where there are none.
    pub stops: Option<Stops>,
    /// How many rows of joints that close loops may follow from others.
    pub closing_rows: usize,
    /// The states of the pose that a projection moves, in the order of its program.
    pub projected: Vec<usize>,
    /// The momenta that it moves after that.
    pub settled: Vec<usize>,
    /// What the Taylor series of the rates takes.
    pub series: SeriesSize,
    /// The states of second order.
    pub second: Range<usize>,
    /// For each switch whether the search for the first branches begins with its first branch.
    pub first_branches: Vec<bool>,
    /// The states that keep what memories have followed and what is held of samples.
    pub memories: Vec<usize>,
    /// The switches of clocks, those of delays among them.
    pub clocks: Vec<usize>,
    /// The delays of signals, one for each time.
    pub delays: Vec<Delay>,
    /// The laws that can give what is not finite, each the element's kind and name, in the order of the program.
    pub fallible: Vec<(&'static str, String)>,
    /// The joints of the loops whose pivots nothing shows to keep away from zero, in the order of the program.
    pub turning: Vec<String>,
    /// The groups of unknowns of algebraic loops.
    pub loops: Vec<Loop>,
    /// Row and column of each entry of the Jacobian.
    pub jacobian: Vec<(usize, usize)>,
    /// How many unknowns of loops border it.
    pub unknowns: usize,
}

/// The delays of signals by one time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Delay {
    /// The index of its clock among those of the model.
    pub clock: usize,
    /// The states of the times from which and until which its polynomials hold.
    pub window: [usize; 2],
    /// The states of the coefficients of each polynomial, and whether it is given what the signal was before the run.
    pub signals: Vec<(Vec<usize>, bool)>,
}

/// Unknowns of algebraic loops that are solved for together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loop {
    /// The first of the unknowns.
    pub first: usize,
    /// How many there are.
    pub unknowns: usize,
    /// The first of their equations among the results of the program: residuals, their sizes, then derivatives by rows.
    pub equation: usize,
}

impl Loop {
    /// How many results of the program are of its equations.
    #[must_use]
    pub const fn equations(&self) -> usize {
        2 * self.unknowns + self.unknowns * self.unknowns
    }
}

/// Of which programs the operations are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counted {
    /// Of all.
    #[default]
    All,
    /// Of those that are there without being asked for.
    Made,
}

/// The tables of a model.
#[must_use]
pub fn tables(model: &Compiled, counted: Counted) -> Tables {
    let equations = &model.equations;
    Tables {
        description: description(model, counted),
        start: start(model),
        required: requirements(model, false),
        held: held(model),
        stops: stops(model),
        closing_rows: holding::closing_rows(model),
        projected: states(&equations.projections),
        settled: states(&equations.settled),
        series: series_size(&model.programs.running.rate, equations.found() > 0),
        second: model.second_order.states.clone(),
        memories: (0..equations.states.len())
            .filter(|&state| matches!(equations.states[state].origin, Origin::Memory(_)))
            .collect(),
        clocks: (0..equations.switches.len()).filter(|&k| equations.switches[k].clock.is_some()).collect(),
        delays: delays(equations),
        first_branches: equations.switches.iter().map(|switch| switch.remembers).collect(),
        fallible: equations.fallible.iter().map(|law| (law.kind, law.element.clone())).collect(),
        turning: equations.turning().map(|law| law.element.clone()).collect(),
        loops: loops(&equations.iterations),
        jacobian: model.jacobian.places(),
        unknowns: model.jacobian.unknowns.len(),
    }
}

/// The delays whose states something reads.
fn delays(equations: &StateEquations) -> Vec<Delay> {
    let own = |index: usize| {
        equations.states.iter().position(|state| matches!(state.origin, Origin::Memory(of) if of == index))
    };
    let clocks = equations.switches.iter().filter_map(|switch| switch.clock).enumerate();
    let delays = clocks.filter_map(|(clock, of)| {
        let of = &equations.delays[of.delay?];
        let [Some(from), Some(until)] = of.window.map(own) else { return None };
        // A signal that is constant has no first coefficient, and the others stay 0; one that is another's has none.
        let signal = |of: &DelayedSignal| {
            own(of.coefficients[0])?;
            let all: Option<Vec<usize>> = of.coefficients.iter().map(|&coefficient| own(coefficient)).collect();
            Some((all.expect("what removes one coefficient removes the first"), of.is_given))
        };
        let signals = of.signals.iter().filter_map(signal);
        Some(Delay { clock, window: [from, until], signals: signals.collect() })
    });
    delays.collect()
}

fn states(of: &[(usize, Id)]) -> Vec<usize> {
    of.iter().map(|(state, _)| *state).collect()
}

/// The groups of unknowns of algebraic loops.
fn loops(of: &[Iteration]) -> Vec<Loop> {
    let mut behind = 0;
    let each = of.iter().map(|iteration| {
        let (first, unknowns) = (iteration.first as usize, iteration.residuals.len());
        let of = Loop { first, unknowns, equation: behind };
        behind += of.equations();
        of
    });
    each.collect()
}

/// Row and column of each derivative among states that are not of second order, which may have a program of their own.
#[must_use]
pub fn damping(model: &Compiled) -> Vec<(usize, usize)> {
    let entries = model.jacobian.among_first_order(&model.second_order.states);
    entries.map(|entry| (entry.row, entry.column)).collect()
}
