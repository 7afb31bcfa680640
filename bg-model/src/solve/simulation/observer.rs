//! Observers of what a run gives.

use alloc::vec::Vec;

use crate::solve::integrator::{Point, Scale, hermite};
use crate::solve::statistics::Statistics;
use crate::solve::stepper::Stepper;

/// What happens at one instant: switches change their branches, something hits a stop.
#[derive(Clone, Debug)]
pub struct Switching {
    /// The end of the step that leads there, with the rate in the branches of that step.
    pub before: Point,
    /// The start of the next step, after an impact, with the rate in its branches.
    pub after: Point,
    /// The branches before.
    pub negative_before: Vec<bool>,
    /// The branches after.
    pub negative_after: Vec<bool>,
    /// The switches whose guards have come to zero, and those of clocks whose instant it is.
    pub reached: Vec<bool>,
    /// The switches of stops that something has hit and left again.
    pub left: Vec<bool>,
    /// Whether the state has jumped.
    pub jumps: bool,
}

/// A step that was accepted, with the states inside of it. A part `theta` of it is between 0, its start, and 1, its
/// end.
pub struct Inside<'s, 'a> {
    stepper: &'s mut Stepper<'a>,
    projections: usize,
}

impl<'s, 'a> Inside<'s, 'a> {
    /// The step that was made last; states inside are projected so many times at most.
    pub(super) const fn of(stepper: &'s mut Stepper<'a>, projections: usize) -> Self {
        Self { stepper, projections }
    }

    /// Its size, s.
    #[must_use]
    pub fn h(&self) -> f64 {
        self.stepper.h
    }

    /// The time at the part `theta`, s.
    #[must_use]
    pub fn time(&self, theta: f64) -> f64 {
        if theta == 1.0 { self.stepper.end.t } else { self.stepper.start.t + theta * self.stepper.h }
    }

    /// The part at which the time is `t` (s): below 0 before the step, above 1 after it.
    #[must_use]
    pub fn part_at(&self, t: f64) -> f64 {
        (t - self.stepper.start.t) / self.stepper.h
    }

    /// The branches that hold during the step.
    #[must_use]
    pub fn negative(&self) -> &[bool] {
        &self.stepper.negative
    }

    /// The order of the method that has made it; none where steps are fixed.
    #[must_use]
    pub fn order(&self) -> Option<f64> {
        self.stepper.method.control().order()
    }

    /// Writes the state at the part `theta` into `x`, as exact as a sample is; gives the time, s.
    pub fn state(&mut self, theta: f64, x: &mut [f64]) -> f64 {
        let t = self.time(theta);
        match theta {
            0.0 => x.copy_from_slice(self.stepper.start.x.as_slice()),
            1.0 => x.copy_from_slice(self.stepper.end.x.as_slice()),
            _ => self.stepper.projected_sample(theta, t, self.projections, x),
        }
        t
    }

    /// The same by the cubic through states and rates at both ends, with an error of order h^4: without evaluations.
    pub fn cubic(&self, theta: f64, x: &mut [f64]) -> f64 {
        let Stepper { start, end, h, .. } = &*self.stepper;
        hermite(start.borrowed(), *h, end.borrowed(), theta, x);
        self.time(theta)
    }

    /// Writes the state that the rate at the start or at the end leads to over the part `beside` of the step, back
    /// where that is negative, into `x`; gives the time, s.
    pub fn along_rate(&self, is_at_end: bool, beside: f64, x: &mut [f64]) -> f64 {
        let Point { t, x: from, rate } = if is_at_end { &self.stepper.end } else { &self.stepper.start };
        let h = beside * self.stepper.h;
        for (x, (from, rate)) in x.iter_mut().zip(from.iter().zip(rate.iter())) {
            *x = from + h * rate;
        }
        t + h
    }
}

/// Is told what a run gives, in the order of time. Every method does nothing by default.
pub trait Observer {
    /// The state `x` at a sample instant `t` (s) and the branches of the step that leads there. At the instant of an
    /// impact it is the state before it; at the start of a run, and at the instants of clocks, the state after it.
    fn sample(&mut self, _t: f64, _x: &[f64], _negative: &[bool]) {}

    /// What errors are measured by from here on: told at the start, and before a step whose end has outgrown the sizes
    /// of the states.
    fn measured(&mut self, _scale: &Scale) {}

    /// A step was accepted, from `start` to `end` in the branches `negative`: told before the samples in it and before
    /// what happens at its end. The rates at both ends are those of these branches.
    fn passed(&mut self, _start: &Point, _end: &Point, _negative: &[bool]) {}

    /// Whether it is told of steps with the states inside of them.
    fn looks_inside(&self) -> bool {
        false
    }

    /// Whether it is to be told of a step of `h` (s) to `t` (s) and the state `x` with the states inside of it. Asked,
    /// of those who look inside, where runs are made side by side and these states are not at hand.
    fn asks(&mut self, _h: f64, _t: f64, _x: &[f64], _negative: &[bool]) -> bool {
        self.looks_inside()
    }

    /// The step of `h` (s) to `t` (s) was accepted of which it was asked last and wants to know no more.
    fn skipped(&mut self, _h: f64, _t: f64) {}

    /// The same step as told by [`Observer::passed`], with the states inside, after that and before the samples in it:
    /// for those who look inside.
    fn inside(&mut self, _step: &mut Inside<'_, '_>) {}

    /// Branches have changed, or the state has jumped, at the end of the last step: told before the events of the
    /// switches.
    fn switched(&mut self, _switching: &Switching) {}

    /// Switch `switch` has changed its branch at `t` (s) and state `x`, or its stop was hit and is left again;
    /// `negative` are the branches after that, `x` the state after the impact.
    fn event(&mut self, _t: f64, _x: &[f64], _switch: usize, _negative: &[bool]) {}

    /// A step was accepted that leads to `t` (s), on the way to `t_end` (s).
    fn step(&mut self, _t: f64, _t_end: f64, _statistics: &Statistics) {}

    /// Whether the run ends here: asked after each accepted step, whose end then is the end of the run and its last
    /// sample.
    fn is_done(&self) -> bool {
        false
    }
}

impl Observer for () {}

/// Both are told, the first one first; the run ends as soon as one of them is done.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        self.0.sample(t, x, negative);
        self.1.sample(t, x, negative);
    }

    fn measured(&mut self, scale: &Scale) {
        self.0.measured(scale);
        self.1.measured(scale);
    }

    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        self.0.passed(start, end, negative);
        self.1.passed(start, end, negative);
    }

    fn looks_inside(&self) -> bool {
        self.0.looks_inside() || self.1.looks_inside()
    }

    fn asks(&mut self, h: f64, t: f64, x: &[f64], negative: &[bool]) -> bool {
        // Both are asked.
        self.0.asks(h, t, x, negative) | self.1.asks(h, t, x, negative)
    }

    fn skipped(&mut self, h: f64, t: f64) {
        self.0.skipped(h, t);
        self.1.skipped(h, t);
    }

    fn inside(&mut self, step: &mut Inside<'_, '_>) {
        self.0.inside(step);
        self.1.inside(step);
    }

    fn switched(&mut self, switching: &Switching) {
        self.0.switched(switching);
        self.1.switched(switching);
    }

    fn event(&mut self, t: f64, x: &[f64], switch: usize, negative: &[bool]) {
        self.0.event(t, x, switch, negative);
        self.1.event(t, x, switch, negative);
    }

    fn step(&mut self, t: f64, t_end: f64, statistics: &Statistics) {
        self.0.step(t, t_end, statistics);
        self.1.step(t, t_end, statistics);
    }

    fn is_done(&self) -> bool {
        self.0.is_done() || self.1.is_done()
    }
}

/// An observer, where there is one.
impl<O: Observer> Observer for Option<O> {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        if let Some(observer) = self {
            observer.sample(t, x, negative);
        }
    }

    fn measured(&mut self, scale: &Scale) {
        if let Some(observer) = self {
            observer.measured(scale);
        }
    }

    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        if let Some(observer) = self {
            observer.passed(start, end, negative);
        }
    }

    fn looks_inside(&self) -> bool {
        self.as_ref().is_some_and(O::looks_inside)
    }

    fn asks(&mut self, h: f64, t: f64, x: &[f64], negative: &[bool]) -> bool {
        self.as_mut().is_some_and(|observer| observer.asks(h, t, x, negative))
    }

    fn skipped(&mut self, h: f64, t: f64) {
        if let Some(observer) = self {
            observer.skipped(h, t);
        }
    }

    fn inside(&mut self, step: &mut Inside<'_, '_>) {
        if let Some(observer) = self {
            observer.inside(step);
        }
    }

    fn switched(&mut self, switching: &Switching) {
        if let Some(observer) = self {
            observer.switched(switching);
        }
    }

    fn event(&mut self, t: f64, x: &[f64], switch: usize, negative: &[bool]) {
        if let Some(observer) = self {
            observer.event(t, x, switch, negative);
        }
    }

    fn step(&mut self, t: f64, t_end: f64, statistics: &Statistics) {
        if let Some(observer) = self {
            observer.step(t, t_end, statistics);
        }
    }

    fn is_done(&self) -> bool {
        self.as_ref().is_some_and(O::is_done)
    }
}

/// The observer behind it is told.
impl<O: Observer + ?Sized> Observer for &mut O {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        (**self).sample(t, x, negative);
    }

    fn measured(&mut self, scale: &Scale) {
        (**self).measured(scale);
    }

    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        (**self).passed(start, end, negative);
    }

    fn looks_inside(&self) -> bool {
        (**self).looks_inside()
    }

    fn asks(&mut self, h: f64, t: f64, x: &[f64], negative: &[bool]) -> bool {
        (**self).asks(h, t, x, negative)
    }

    fn skipped(&mut self, h: f64, t: f64) {
        (**self).skipped(h, t);
    }

    fn inside(&mut self, step: &mut Inside<'_, '_>) {
        (**self).inside(step);
    }

    fn switched(&mut self, switching: &Switching) {
        (**self).switched(switching);
    }

    fn event(&mut self, t: f64, x: &[f64], switch: usize, negative: &[bool]) {
        (**self).event(t, x, switch, negative);
    }

    fn step(&mut self, t: f64, t_end: f64, statistics: &Statistics) {
        (**self).step(t, t_end, statistics);
    }

    fn is_done(&self) -> bool {
        (**self).is_done()
    }
}

/// An observer that hands every sample to a closure of time (s), state and branches.
#[derive(Clone, Debug)]
pub struct EachSample<F>(pub F);

/// An observer that hands the time (s) to which each accepted step leads to a closure, for the progress of a run.
#[derive(Clone, Debug)]
pub struct EachStep<F>(pub F);

impl<F: FnMut(f64)> Observer for EachStep<F> {
    fn step(&mut self, t: f64, _t_end: f64, _statistics: &Statistics) {
        (self.0)(t);
    }
}

impl<F: FnMut(f64, &[f64], &[bool])> Observer for EachSample<F> {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        (self.0)(t, x, negative);
    }
}
