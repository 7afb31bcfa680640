//! What a run is asked for, and the check that it can be done.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::DVector;

use crate::model::dynamics::Dynamics;
use crate::solve::failure::{BadInput, Failure};
use crate::solve::finish::{Ended, Finish};
use crate::solve::integrator::{Absolute, StepControl, Tolerances};
use crate::solve::statistics::Statistics;

/// The time that a run covers, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Start.
    pub t0: f64,
    /// End, not before the start. Where both are equal the run gives its start only.
    pub t_end: f64,
}

impl Span {
    /// Its length, s; of an empty one 1 s: a step of a run that goes on shows the branches.
    pub(super) fn length(&self) -> f64 {
        if self.t_end > self.t0 { self.t_end - self.t0 } else { 1.0 }
    }

    /// The smallest difference of two instants of the span that rounding leaves some digits, s.
    pub(super) fn resolution(&self) -> f64 {
        16.0 * f64::EPSILON * self.t0.abs().max(self.t_end.abs())
    }
}

/// How a run is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The error allowed in a step; without effect on a fixed-step method.
    pub tolerances: Tolerances,
    /// The first step, s; by default it is estimated. One beyond the end of the run is one to the end. Without effect
    /// on a fixed-step method.
    pub first_step: Option<f64>,
    /// The largest step, s; infinity by default.
    pub largest_step: f64,
    /// The number of attempted steps, rejected ones included, after which the run gives up.
    pub step_limit: u64,
    /// The instants at which the state is handed to the observer.
    pub samples: Samples,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerances: Tolerances::default(),
            first_step: None,
            largest_step: f64::INFINITY,
            step_limit: 1_000_000_000,
            samples: Samples::Steps,
        }
    }
}

/// The instants at which the state is handed to the observer. They have no influence on the steps.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// The start and the end of every step.
    Steps,
    /// The start, the instants t0 + k dt, and the end of the run; of an infinite dt (s) the start and the end.
    Every(f64),
    /// These instants only, s: ascending and inside the span. Those after the end of a run that ends early are not
    /// given.
    At(Vec<f64>),
}

/// Refuses a start at `t` (s) of another number of states than the system has.
pub(super) fn check_fit(system: &dyn Dynamics, t: f64, start: &DVector<f64>) -> Result<(), Failure> {
    let (given, states) = (start.len(), system.states());
    if given == states {
        return Ok(());
    }
    let (negative, uncontrolled) = (vec![false; system.switches()], vec![false; given]);
    let (ended, statistics) = (Ended::ByFailure, Statistics::default());
    let last = Finish { t, x: start.clone(), negative, ended, uncontrolled, statistics };
    Err(Failure { cause: BadInput::States { given, states }.into(), last: Box::new(last) })
}

/// Refuses what cannot be done.
pub(super) fn check(
    system: &dyn Dynamics,
    control: StepControl,
    start: &[f64],
    span: Span,
    settings: &Settings,
) -> Result<(), BadInput> {
    let Span { t0, t_end } = span;
    if !(t0.is_finite() && t_end.is_finite() && t0 <= t_end && (t_end - t0).is_finite()) {
        return Err(BadInput::Span { t0, t_end });
    }
    check_tolerances(system, &settings.tolerances)?;
    if let Some((index, value)) = crate::solve::integrator::first_not_finite(start) {
        return Err(BadInput::Start { state: system.state_name(index), value });
    }
    let smallest = span.resolution();
    let step = |which, value: f64| {
        if value > smallest { Ok(()) } else { Err(BadInput::Step { which, value, smallest }) }
    };
    step("largest", settings.largest_step)?;
    match control {
        StepControl::Fixed { step: fixed } if fixed.is_finite() => step("fixed", fixed)?,
        StepControl::Fixed { step: value } => return Err(BadInput::Step { which: "fixed", value, smallest }),
        _ => {
            settings.first_step.map_or(Ok(()), |first| step("first", first))?;
        }
    }
    check_samples(span, &settings.samples)
}

/// Refuses the method of this name, if there is one, on a system without a Taylor series.
pub(super) fn check_series(system: &dyn Dynamics, method: Option<&'static str>) -> Result<(), BadInput> {
    match method {
        Some(method) if system.series().is_none() => Err(BadInput::NoSeries { method }),
        _ => Ok(()),
    }
}

fn check_tolerances(system: &dyn Dynamics, tolerances: &Tolerances) -> Result<(), BadInput> {
    let (value, smallest) = (tolerances.relative, Tolerances::SMALLEST_RELATIVE);
    if !(value.is_finite() && value >= smallest) {
        return Err(BadInput::RelativeTolerance { value, smallest });
    }
    let states = system.states();
    let faulty = |value: f64| !(value.is_finite() && value >= f64::MIN_POSITIVE);
    let (index, value) = match &tolerances.absolute {
        Absolute::Scalar(value) if states > 0 && faulty(*value) => (0, *value),
        Absolute::PerState(values) if values.len() != states => {
            return Err(BadInput::AbsoluteTolerances { given: values.len(), states });
        }
        Absolute::PerState(values) => match values.iter().position(|value| faulty(*value)) {
            Some(index) => (index, values[index]),
            None => return Ok(()),
        },
        Absolute::Scalar(_) | Absolute::OfSizes => return Ok(()),
    };
    Err(BadInput::AbsoluteTolerance { state: system.state_name(index), value })
}

fn check_samples(span: Span, samples: &Samples) -> Result<(), BadInput> {
    match samples {
        Samples::Steps => Ok(()),
        Samples::Every(interval) if *interval > span.resolution() => Ok(()),
        Samples::Every(interval) => Err(BadInput::SampleInterval { value: *interval, smallest: span.resolution() }),
        Samples::At(instants) => {
            let mut before = span.t0;
            for (index, &value) in instants.iter().enumerate() {
                if !(before <= value && value <= span.t_end) {
                    return Err(BadInput::SampleInstant { index, value });
                }
                before = value;
            }
            Ok(())
        }
    }
}
