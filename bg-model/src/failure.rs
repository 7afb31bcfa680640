//! Failures: why a run stopped before its end.
//!
//! In: what the driver found. Out: the cause with its time, step, state and value, and the last good point.

use thiserror::Error;

use crate::simulation::Finish;

/// A run that stopped before its end.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{cause}")]
pub struct Failure<const N: usize, const G: usize> {
    /// Why.
    pub cause: Cause,
    /// The last good point, the branches there and the statistics up to it.
    pub last: Box<Finish<N, G>>,
}

/// Why a run stopped.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Cause {
    /// A number was not finite, however small the step.
    #[error("{quantity} of `{name}` is {value} in a step of {h:e} s from t = {t} s")]
    NonFinite {
        /// What it is.
        quantity: Quantity,
        /// The name of the state; of a guard `switch`.
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
    /// The tolerances call for a step that rounding does not allow.
    #[error("the step fell to {h:e} s at t = {t} s; `{state}` = {value} has the largest error")]
    StepTooSmall {
        /// The name of the state with the largest error.
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
    /// The limit of steps was reached.
    #[error("{limit} steps were tried up to t = {t} s; the last was {h:e} s")]
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
        "switch {switch} changes its branch without end at t = {t} s: in neither branch does its guard keep its sign"
    )]
    EventsAccumulate {
        /// The index of the switch.
        switch: usize,
        /// Time, s.
        t: f64,
    },
    /// The run was not started.
    #[error(transparent)]
    BadInput(#[from] BadInput),
}

/// A quantity that can fail to be finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A state.
    State,
    /// A state's rate.
    Rate,
    /// A switch's guard.
    Guard,
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::State => "the value",
            Self::Rate => "the rate",
            Self::Guard => "the guard",
        })
    }
}

/// Something a run was asked for that cannot be.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BadInput {
    /// The relative tolerance is not a number, or below what rounding allows.
    #[error("the relative tolerance is {value}; it must be a finite number, at least {smallest:e}")]
    RelativeTolerance {
        /// The refused tolerance.
        value: f64,
        /// The smallest usable one.
        smallest: f64,
    },
    /// An absolute tolerance is not a positive number.
    #[error("the absolute tolerance of `{state}` is {value}; it must be a finite number above 0")]
    AbsoluteTolerance {
        /// The state's name.
        state: &'static str,
        /// The refused tolerance.
        value: f64,
    },
    /// The end is before the start, or one of them is not a number.
    #[error("the span from t = {t0} s to {t_end} s does not run forward")]
    Span {
        /// Start, s.
        t0: f64,
        /// End, s.
        t_end: f64,
    },
    /// A state is not finite at the start.
    #[error("the start value of `{state}` is {value}")]
    Start {
        /// The state's name.
        state: &'static str,
        /// Its value.
        value: f64,
    },
    /// A step size is not positive, or below what rounding allows.
    #[error("the {which} step is {value} s; it must be a number above {smallest:e} s")]
    Step {
        /// `first`, `largest` or `fixed`.
        which: &'static str,
        /// The refused step, s.
        value: f64,
        /// The largest step that is refused, s.
        smallest: f64,
    },
    /// The sample interval is not positive, or below what rounding allows.
    #[error("the sample interval is {value} s; it must be a number above {smallest:e} s")]
    SampleInterval {
        /// The refused interval, s.
        value: f64,
        /// The largest interval that is refused, s.
        smallest: f64,
    },
    /// A sample instant is outside the span, not a number or before the one in front of it.
    #[error("sample instant {index}, t = {value} s, is outside the span or out of order")]
    SampleInstant {
        /// Its index.
        index: usize,
        /// The refused instant, s.
        value: f64,
    },
}
