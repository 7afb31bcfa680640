//! The driver: integrates a system over a span of time, step by step.
//!
//! In: a system, a method, the start, the span and the settings. Out: the state at the end, with samples and events told
//! to an observer on the way, or a typed failure with the last good state. Switches change their branch at located
//! instants only ([`crate::system::System`]); a step never runs over such an instant.

mod observer;
mod pace;
mod recording;
mod rounding;
mod sampling;
mod settings;

use nalgebra::SVector;

pub use observer::{EachSample, EachStep, Observer};
pub use recording::{Column, MissingColumn, Part, Recorder, Recording};
pub use settings::{Samples, Settings, Span};

use crate::model::capability::Joints;
use crate::model::input;
use crate::model::reactions::Independence;
use crate::model::system::System;
use crate::solve::event::Watch;
use crate::solve::failure::{Cause, Failure, Quantity};
pub use crate::solve::finish::Finish;
use crate::solve::integrator::{Method, Point, Scale, StepControl, first_not_finite, is_finite};
use crate::solve::stepper::Stepper;
use pace::Pace;
use rounding::RoundingWatch;
use sampling::Sampling;

/// The state at `span.t_end`, from `start` at `span.t0`.
///
/// The branches at the start follow from the signs of the guards there; a guard that is exactly zero is decided by its
/// sign a little later. The observer gets the samples and events in the order of time. Nothing is allocated on the way.
///
/// # Errors
/// [`Failure`]: input that cannot be, a number that is not finite, a step or an interval between events that rounding
/// does not allow, or too many steps; with the last good state, which the failing step has not touched.
pub fn integrate<Sys, M, O, const N: usize, const G: usize>(
    system: &Sys,
    method: &mut M,
    start: &SVector<f64, N>,
    span: Span,
    settings: &Settings<N>,
    observer: &mut O,
) -> Result<Finish<N, G>, Failure<N, G>>
where
    Sys: System<f64, N, G>,
    M: Method<N>,
    O: Observer<N, G>,
{
    let control = method.control();
    let needs_series = method.needs_series().then(|| method.name());
    let mut run = Run {
        stepper: Stepper::new(system, method, Scale::from(&settings.tolerances), Point::at(span.t0, *start)),
        watch: Watch::new(),
        pace: Pace::new(control, span, settings),
        sampling: Sampling::new(&settings.samples, span),
        span,
        attempts: 0,
        limit: settings.step_limit,
        faulty_guard: None,
        independence: system.joints().and_then(|joints| Independence::new(joints.held())),
        rounding: RoundingWatch::new(settings.tolerances.relative),
    };
    let outcome = settings::check(system, control, start, span, settings)
        .and_then(|()| settings::check_series(system, needs_series))
        .map_err(Cause::from)
        .and_then(|()| run.begin(control, settings))
        .and_then(|()| run.advance_to_end(observer));
    match outcome {
        Ok(()) => Ok(run.finish()),
        Err(cause) => Err(Failure { cause, last: Box::new(run.finish()) }),
    }
}

/// A run under way.
struct Run<'a, Sys, M, const N: usize, const G: usize> {
    stepper: Stepper<'a, Sys, M, N, G>,
    watch: Watch<G>,
    pace: Pace,
    sampling: Sampling<'a>,
    span: Span,
    attempts: u64,
    limit: u64,
    /// The guard that was not finite at the end of a longer step from the present start, and its value.
    faulty_guard: Option<(usize, f64)>,
    /// Of the rigid joints, where there are any.
    independence: Option<Independence>,
    /// Of the error estimates, where the tolerances may be below it.
    rounding: Option<RoundingWatch>,
}

impl<Sys, M, const N: usize, const G: usize> Run<'_, Sys, M, N, G>
where
    Sys: System<f64, N, G>,
    M: Method<N>,
{
    /// Finds the first step and the branches at the start.
    fn begin(&mut self, control: StepControl, settings: &Settings<N>) -> Result<(), Cause> {
        self.watch.begin_by_sign(&mut self.stepper);
        self.stepper.evaluate_start();
        self.check_start()?;
        let longest = self.span.length().min(settings.largest_step);
        if let (Some(order), None) = (control.order(), settings.first_step) {
            let (_, flow, start, _, scale) = self.stepper.split();
            let first = pace::first_step(&flow, start, scale, order, longest);
            self.pace.begin(first);
        }
        self.watch.begin_by_probe(&mut self.stepper, self.pace.reach());
        self.stepper.end = self.stepper.start;
        self.check_start()?;
        let Stepper { system, start, negative, .. } = &self.stepper;
        let (Some(independence), Some(joints)) = (&mut self.independence, system.joints()) else { return Ok(()) };
        let found = independence.begin(joints, (start.t, &start.x), negative);
        found.map_or(Ok(()), |redundancy| Err(Cause::Redundant { redundancy, t: start.t }))
    }

    /// Sees to it that the rigid joints hold each a motion of its own over the whole step.
    fn check_joints(&mut self) -> Result<(), Cause> {
        let Stepper { system, start, h, end, negative, .. } = self.stepper;
        let (Some(independence), Some(joints)) = (&mut self.independence, system.joints()) else { return Ok(()) };
        let inside = |part: f64| (start.t + part * h, self.stepper.dense(part));
        let found = independence.check(joints, (end.t, &end.x), &negative, inside);
        found.map_or(Ok(()), |(t, redundancy)| Err(Cause::Redundant { redundancy, t }))
    }

    fn check_start(&self) -> Result<(), Cause> {
        match first_not_finite(&self.stepper.start.rate) {
            Some(fault) => Err(self.not_finite(Quantity::Rate, fault, 0.0)),
            None => self.watch.check_start().map_err(|fault| self.not_finite(Quantity::Guard, fault, 0.0)),
        }
    }

    fn advance_to_end(&mut self, observer: &mut impl Observer<N, G>) -> Result<(), Cause> {
        self.sample(observer, self.span.t0);
        while self.stepper.start.t < self.span.t_end {
            self.try_steps()?;
            match self.watch.inspect(&mut self.stepper) {
                Err(fault) => self.retreat(fault)?,
                Ok(None) => {
                    self.accept(observer)?;
                    self.watch.advance();
                }
                Ok(Some(crossing)) => {
                    if !crossing.is_at_start {
                        self.accept(observer)?;
                    }
                    let before = self.stepper.negative;
                    let h = self.stepper.h;
                    self.switch(crossing.switches, observer)?;
                    if crossing.is_at_start && self.stepper.negative == before {
                        // The branch is right, so the step was too long for the guard's course.
                        self.stepper.statistics.rejected += 1;
                        self.pace.reject(h, f64::NAN);
                        if self.pace.is_lost(self.stepper.start.t) {
                            return Err(self.accumulate(crossing.switches));
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Tries steps until one satisfies the tolerances; its end is projected and the rate there is known.
    fn try_steps(&mut self) -> Result<(), Cause> {
        let t = self.stepper.start.t;
        let mut error = 0.0_f64;
        loop {
            if self.pace.is_lost(t) {
                return Err(self.lost(error));
            }
            if self.attempts >= self.limit {
                return Err(Cause::TooManySteps { limit: self.limit, t, h: self.stepper.h });
            }
            self.attempts += 1;
            let t_new = self.pace.next_end(t);
            let h = t_new - t;
            error = self.stepper.attempt(h);
            self.pace.follow(self.stepper.method.control());
            self.stepper.end.t = t_new;
            if error <= 1.0 && is_finite(&self.stepper.end.x) {
                self.stepper.project();
                self.stepper.evaluate_end();
                if is_finite(&self.stepper.end.x) && is_finite(&self.stepper.end.rate) {
                    self.pace.accept(t_new, h, error);
                    return Ok(());
                }
            }
            if error <= 1.0 {
                error = f64::NAN;
            }
            self.stepper.statistics.rejected += 1;
            self.pace.reject(h, error);
            if !self.pace.is_adaptive() {
                return Err(self.lost(error));
            }
        }
    }

    /// Gives up a step at whose end the guard of `fault` is not finite, for a shorter one.
    fn retreat(&mut self, fault: (usize, f64)) -> Result<(), Cause> {
        let h = self.stepper.h;
        self.stepper.statistics.rejected += 1;
        self.pace.reject(h, f64::NAN);
        self.faulty_guard = Some(fault);
        let is_last = !self.pace.is_adaptive() || self.pace.is_lost(self.stepper.start.t);
        if is_last { Err(self.not_finite(Quantity::Guard, fault, h)) } else { Ok(()) }
    }

    /// Why no step from the start of the last attempt succeeds.
    fn lost(&self, error: f64) -> Cause {
        let Stepper { method, start, end, h, scale, .. } = &self.stepper;
        if let Some(fault) = self.faulty_guard {
            return self.not_finite(Quantity::Guard, fault, *h);
        }
        if !error.is_finite() {
            if let Some(fault) = method.faulty_rate() {
                return self.not_finite(Quantity::Rate, fault, *h);
            }
            if let Some(fault) = first_not_finite(&end.x) {
                return self.not_finite(Quantity::State, fault, *h);
            }
            if let Some(fault) = first_not_finite(&end.rate) {
                return self.not_finite(Quantity::Rate, fault, *h);
            }
            if let Some(fault) = self.stepper.faulty_derivative() {
                return self.not_finite(Quantity::Derivative, fault, 0.0);
            }
            if !self.pace.is_adaptive() {
                return Cause::NotSolved { t: start.t, h: *h };
            }
        }
        let index = if error.is_finite() { method.largest_error(start, scale, &end.x) } else { scale.fastest(start) };
        let state = self.stepper.system.state_name(index);
        Cause::StepTooSmall { state, index, value: start.x[index], t: start.t, h: self.pace.step() }
    }

    fn not_finite(&self, quantity: Quantity, (index, value): (usize, f64), h: f64) -> Cause {
        let (name, origin) = match quantity {
            Quantity::Guard => (self.stepper.system.switch_name(index).unwrap_or_default(), None),
            Quantity::State | Quantity::Rate => (self.stepper.system.state_name(index), self.stepper.origin(0.0)),
            Quantity::Derivative => {
                // By time an input's derivative may be a difference.
                let reach = input::reach(self.stepper.start.t);
                (self.stepper.system.state_name(index), self.stepper.origin(reach))
            }
        };
        Cause::NonFinite { origin, quantity, name, index, value, t: self.stepper.start.t, h }
    }

    /// Takes the step over: gives its samples and makes its end the start of the next one.
    fn accept(&mut self, observer: &mut impl Observer<N, G>) -> Result<(), Cause> {
        self.check_joints()?;
        self.faulty_guard = None;
        if let Some(rounding) = &mut self.rounding {
            rounding.follow(&mut self.stepper);
        }
        self.stepper.statistics.record(self.stepper.h);
        self.sampling.next_step();
        let t = self.stepper.end.t;
        self.sample(observer, t);
        self.stepper.advance();
        observer.step(t, self.span.t_end, &self.stepper.statistics);
        Ok(())
    }

    /// Gives the samples up to the end of the step at `t`.
    fn sample(&mut self, observer: &mut impl Observer<N, G>, t: f64) {
        while let Some(instant) = self.sampling.next_up_to(t) {
            if instant >= t {
                observer.sample(t, &self.stepper.end.x, &self.stepper.negative);
                continue;
            }
            let part = (instant - self.stepper.start.t) / self.stepper.h;
            let mut x = self.stepper.dense(part.min(1.0));
            self.stepper.system.project(&mut x);
            observer.sample(instant, &x, &self.stepper.negative);
        }
    }

    /// Lets the switches whose guards are at zero find their branches at the start of the next step.
    fn switch(&mut self, switches: [bool; G], observer: &mut impl Observer<N, G>) -> Result<(), Cause> {
        let t = self.stepper.start.t;
        let before = self.stepper.negative;
        self.watch.settle(&mut self.stepper, switches, self.pace.reach());
        self.check_start()?;
        for (switch, before) in before.into_iter().enumerate() {
            if self.stepper.negative[switch] != before {
                self.stepper.statistics.events += 1;
                observer.event(t, &self.stepper.start.x, switch, &self.stepper.negative);
            }
        }
        let is_crowded = self.watch.is_crowded(t, self.span.t_end - self.span.t0);
        if is_crowded { Err(self.accumulate(switches)) } else { Ok(()) }
    }

    /// The first of `switches` finds no branch.
    fn accumulate(&self, switches: [bool; G]) -> Cause {
        let switch = switches.iter().position(|switch| *switch).unwrap_or(0);
        let name = self.stepper.system.switch_name(switch).unwrap_or_default();
        Cause::EventsAccumulate { switch, name, t: self.stepper.start.t }
    }

    fn finish(self) -> Finish<N, G> {
        let Stepper { start, negative, statistics, .. } = self.stepper;
        Finish { t: start.t, x: start.x, negative, statistics }
    }
}
