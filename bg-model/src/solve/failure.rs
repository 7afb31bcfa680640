//! Failures: why a run stopped before its end.
//!
//! In: what the driver found. Out: the cause with its time, step, state and value, and the last good point.

use alloc::borrow::ToOwned;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;

use thiserror::Error;

use crate::model::holding::{Redundancy, Slipping};
pub use crate::model::origin::Origin;
use crate::solve::finish::Finish;

/// A run that stopped before its end.
#[derive(Clone, PartialEq, Error)]
#[error("{cause}")]
pub struct Failure {
    /// Why.
    pub cause: Cause,
    /// The last good point, the branches there and the statistics up to it.
    pub last: Box<Finish>,
}

debug_is_display!(Failure);

/// Why a run stopped.
#[derive(Clone, PartialEq, Error)]
pub enum Cause {
    /// A number was not finite, however small the step.
    #[error("{}", not_finite(.origin.as_ref(), *.quantity, .name, *.index, *.value, *.t, *.h))]
    NonFinite {
        /// The input or element that it comes from, where that is known.
        origin: Option<Origin>,
        /// What it is.
        quantity: Quantity,
        /// The name of the state, or of the switch; of a switch without a name empty.
        name: &'static str,
        /// The index of the state or switch.
        index: usize,
        /// Its value.
        value: f64,
        /// The start of the step, s.
        t: f64,
        /// The size of the step, s; 0 at the start of the run.
        h: f64,
    },
    /// The condition that ends the run is not finite, however small the step.
    #[error(
        "the condition that ends the run is {value:?} {}; it must be a finite number all along the run",
        place(*.t, *.h)
    )]
    Condition {
        /// Its value.
        value: f64,
        /// The start of the step, s.
        t: f64,
        /// The size of the step, s; 0 at the start of a step.
        h: f64,
    },
    /// The tolerances call for a step that rounding does not allow.
    #[error(
        "the step fell to {h:.2e} s at t = {t:?} s, where `{state}` = {value:?} allows no larger one: it grows without \
         bound or jumps there, or the tolerances are too small"
    )]
    StepTooSmall {
        /// The name of the state with the largest error; without an error estimate, of that which changes fastest.
        state: &'static str,
        /// Its index.
        index: usize,
        /// Its value at `t`.
        value: f64,
        /// Time, s.
        t: f64,
        /// The step that was called for, s.
        h: f64,
    },
    /// The equations of an implicit step of a fixed size were not solved.
    #[error(
        "the equations of the step of {h:.2e} s from t = {t:?} s were not solved: the iteration does not converge; \
         try a smaller step, or an integrator that chooses its steps"
    )]
    NotSolved {
        /// The start of the step, s.
        t: f64,
        /// The size of the step, s.
        h: f64,
    },
    /// The limit of steps was reached.
    #[error(
        "the limit of {limit} attempted steps is used up at t = {t:?} s; \
         the last step was {h:.2e} s. Raise the limit, or for a stiff problem choose an implicit integrator"
    )]
    TooManySteps {
        /// The limit.
        limit: u64,
        /// Time, s.
        t: f64,
        /// The last step, s.
        h: f64,
    },
    /// A switch changes its branch again and again at one instant.
    #[error(
        "{} changes its branch without end at t = {t:?} s: in neither branch does its guard keep its sign",
        switch_text(.name, *.switch)
    )]
    EventsAccumulate {
        /// The index of the switch.
        switch: usize,
        /// Its name, such as ``if v < 0` of `valve``; empty where it has none.
        name: &'static str,
        /// Time, s.
        t: f64,
    },
    /// The steps creep into a singular pose, in which the joints do not say which way the mechanism goes on.
    #[error(
        "at t = {t:?} s the steps creep into a singular pose, in which {redundancy}; \
        explicit methods and `taylor` pass such a pose"
    )]
    Singular {
        /// Which joints.
        redundancy: Redundancy,
        /// When, s.
        t: f64,
    },
    /// A rigid joint holds a motion that no other does any more. At the start it followed from the others, so that it
    /// took no part since.
    #[error(
        "at t = {t:?} s {slipping}: at the start other rigid joints held this as well, now they do not; make the joint \
         compliant, or start in another pose"
    )]
    Torn {
        /// The joint.
        slipping: Slipping,
        /// When, s.
        t: f64,
    },
    /// A loop whose links follow in closed form comes to a pose where they may turn either way.
    #[error(
        "the loop that `{joint}` closes comes to its end at t = {t:?} s, a pose in which a dependent body may turn \
         either way: leave it out of `dependent`"
    )]
    LoopEnds {
        /// The joint that closes it.
        joint: &'static str,
        /// When, s.
        t: f64,
    },
    /// It was told to end ([`Request::interrupt`](crate::run::Request::interrupt)).
    #[error("the run was interrupted at t = {t:?} s")]
    Interrupted {
        /// When, s.
        t: f64,
    },
    /// What was to be recorded could not be calculated.
    #[error(transparent)]
    NoNumber(#[from] NoNumber),
    /// The run was not started.
    #[error(transparent)]
    BadInput(#[from] BadInput),
}

debug_is_display!(Cause);

/// A quantity that can fail to be finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A state.
    State,
    /// A state's rate.
    Rate,
    /// A derivative of a state's rate, by a state or by time; of a switch none is asked for.
    Derivative,
    /// A switch's guard.
    Guard,
}

impl core::fmt::Display for Quantity {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::State => "the value",
            Self::Rate => "the rate",
            Self::Derivative => "a derivative of the rate",
            Self::Guard => "the guard",
        })
    }
}

/// Something a run was asked for that cannot be.
#[derive(Clone, PartialEq, Error)]
pub enum BadInput {
    /// The relative tolerance is not a number, or below what rounding allows.
    #[error("the relative tolerance is {value:?}; it must be a finite number, at least {smallest:.2e}")]
    RelativeTolerance {
        /// The refused tolerance.
        value: f64,
        /// The smallest usable one.
        smallest: f64,
    },
    /// An absolute tolerance is not a positive number, or below the smallest normal one.
    #[error(
        "the absolute tolerance of `{state}` is {value:?}; it must be a finite number, at least {:.2e}",
        f64::MIN_POSITIVE
    )]
    AbsoluteTolerance {
        /// The state's name.
        state: &'static str,
        /// The refused tolerance.
        value: f64,
    },
    /// There are absolute tolerances for another number of states.
    #[error("there are {given} absolute tolerances for {states} states; give one for each, or one for all")]
    AbsoluteTolerances {
        /// The absolute tolerances.
        given: usize,
        /// The states of the system.
        states: usize,
    },
    /// The start is one of a system with another number of states.
    #[error("the start has {given} value(s) for {states} state(s); start from a state of this system")]
    States {
        /// The states of the start.
        given: usize,
        /// Those of the system.
        states: usize,
    },
    /// The integrator needs the Taylor series of the system.
    #[error(
        "the integrator {method} needs the system's Taylor series, which there is not where an input changes with \
         time, nor of a hand-written system without one; choose another integrator"
    )]
    NoSeries {
        /// The integrator's name.
        method: &'static str,
    },
    /// The end is before the start, or one of them or their difference is not finite.
    #[error("the span from t = {t0:?} s to {t_end:?} s {}", span_fault(*.t0, *.t_end))]
    Span {
        /// Start, s.
        t0: f64,
        /// End, s.
        t_end: f64,
    },
    /// A state is not finite at the start.
    #[error("the start value of `{state}` is {value:?}; it must be a finite number")]
    Start {
        /// The state's name.
        state: &'static str,
        /// Its value.
        value: f64,
    },
    /// A step size is not positive, or below what rounding allows; or a fixed one is not finite.
    #[error("the {which} step is {value:?} s; it must be {}number above {smallest:.2e} s", a_finite(.which))]
    Step {
        /// `first`, `largest` or `fixed`.
        which: &'static str,
        /// The refused step, s.
        value: f64,
        /// The largest step that is refused, s.
        smallest: f64,
    },
    /// The sample interval is not positive, or below what rounding allows.
    #[error("the sample interval is {value:?} s; it must be a number above {smallest:.2e} s")]
    SampleInterval {
        /// The refused interval, s.
        value: f64,
        /// The largest interval that is refused, s.
        smallest: f64,
    },
    /// A sample instant is outside the span, not a number or before the one in front of it.
    #[error(
        "sample instant {index}, t = {value:?} s, is outside the span, before the one in front of it, or not a number"
    )]
    SampleInstant {
        /// Its index.
        index: usize,
        /// The refused instant, s.
        value: f64,
    },
}

debug_is_display!(BadInput);

/// What is not finite, and where.
fn not_finite(
    origin: Option<&Origin>,
    quantity: Quantity,
    name: &str,
    index: usize,
    value: f64,
    t: f64,
    h: f64,
) -> String {
    let whose = if quantity == Quantity::Guard { switch_text(name, index) } else { format!("`{name}`") };
    let place = place(t, h);
    match origin {
        None => format!("{quantity} of {whose} is {value:?} {place}"),
        Some(origin) => format!(
            "{} `{}` gives {:?} {place}, and so {quantity} of {whose} is {value:?}; {}",
            origin.kind,
            origin.name,
            origin.value,
            origin.action()
        ),
    }
}

/// In which step.
fn place(t: f64, h: f64) -> String {
    if h == 0.0 { format!("at t = {t:?} s") } else { format!("in a step of {h:.2e} s from t = {t:?} s") }
}

/// A switch by its name, or its number where it has none.
pub(crate) fn switch_text(name: &str, index: usize) -> String {
    if name.is_empty() { format!("switch {index}") } else { name.to_owned() }
}

/// Why a span cannot be.
fn span_fault(t0: f64, t_end: f64) -> &'static str {
    if !(t0.is_finite() && t_end.is_finite()) {
        "must have finite ends"
    } else if t_end < t0 {
        "runs backward; the end must not be before the start"
    } else {
        "is too long for a number"
    }
}

fn a_finite(which: &str) -> &'static str {
    if which == "fixed" { "a finite " } else { "a " }
}

/// A value that is not finite at a sample.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}", self.text())]
pub struct NoNumber {
    /// The column.
    pub name: String,
    /// What it observes, as written, where it is an output.
    pub observes: Option<&'static str>,
    /// Its value.
    pub value: f64,
    /// When, s.
    pub t: f64,
    /// The input, law or algebraic loop that it comes from, where that is known.
    pub origin: Option<Origin>,
}

impl NoNumber {
    fn text(&self) -> String {
        let Self { name, observes, value, t, origin } = self;
        let law = observes.filter(|law| law != name).map_or_else(String::new, |law| format!(" = `{law}`"));
        let what = format!("`{name}`{law} is {value:?} at t = {t:?} s");
        match origin {
            None => format!("{what}: keep what it divides by, or takes a root, power or logarithm of, in range"),
            Some(origin) => format!(
                "{what}, since {} `{}` gives {:?} there; {}",
                origin.kind,
                origin.name,
                origin.value,
                origin.action()
            ),
        }
    }
}
