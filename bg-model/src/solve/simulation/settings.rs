//! What a run is asked for, and the check that it can be done.

use alloc::vec::Vec;

use nalgebra::SVector;

use crate::model::scalar::Scalar;
use crate::model::system::System;
use crate::solve::failure::BadInput;
use crate::solve::integrator::{Absolute, StepControl, Tolerances};

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
pub struct Settings<const N: usize> {
    /// The error allowed in a step; without effect on a fixed-step method.
    pub tolerances: Tolerances<N>,
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

impl<const N: usize> Default for Settings<N> {
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

/// Refuses what cannot be done.
pub(super) fn check<Sys, const N: usize, const G: usize>(
    system: &Sys,
    control: StepControl,
    start: &SVector<f64, N>,
    span: Span,
    settings: &Settings<N>,
) -> Result<(), BadInput>
where
    Sys: System<f64, N, G>,
{
    let Span { t0, t_end } = span;
    if !(t0.is_finite() && t_end.is_finite() && t0 <= t_end && (t_end - t0).is_finite()) {
        return Err(BadInput::Span { t0, t_end });
    }
    check_tolerances(system, &settings.tolerances)?;
    if let Some((index, value)) = crate::solve::integrator::first_not_finite(start.as_slice()) {
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
pub(super) fn check_series<Sys, const N: usize, const G: usize>(
    system: &Sys,
    method: Option<&'static str>,
) -> Result<(), BadInput>
where
    Sys: System<f64, N, G>,
{
    match method {
        Some(method) if system.series().is_none() => Err(BadInput::NoSeries { method }),
        _ => Ok(()),
    }
}

fn check_tolerances<Sys, S, const N: usize, const G: usize>(
    system: &Sys,
    tolerances: &Tolerances<N>,
) -> Result<(), BadInput>
where
    S: Scalar,
    Sys: System<S, N, G>,
{
    let (value, smallest) = (tolerances.relative, Tolerances::<N>::SMALLEST_RELATIVE);
    if !(value.is_finite() && value >= smallest) {
        return Err(BadInput::RelativeTolerance { value, smallest });
    }
    let faulty = |value: f64| !(value.is_finite() && value >= f64::MIN_POSITIVE);
    let (index, value) = match &tolerances.absolute {
        Absolute::Scalar(value) if N > 0 && faulty(*value) => (0, *value),
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
