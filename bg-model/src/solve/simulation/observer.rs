//! Observers of what a run gives.

use alloc::vec::Vec;

use crate::solve::integrator::{Point, Scale};
use crate::solve::statistics::Statistics;

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
    /// The switches whose guards have come to zero.
    pub reached: Vec<bool>,
    /// The switches of stops that something has hit and left again.
    pub left: Vec<bool>,
    /// Whether the state has jumped.
    pub jumps: bool,
}

/// Is told what a run gives, in the order of time. Every method does nothing by default.
pub trait Observer {
    /// The state `x` at a sample instant `t` (s) and the branches of the step that leads there. At the instant of an
    /// impact it is the state before it; at the start of a run the state after it.
    fn sample(&mut self, _t: f64, _x: &[f64], _negative: &[bool]) {}

    /// What errors are measured by from here on: told at the start, and before a step whose end has outgrown the sizes
    /// of the states.
    fn measured(&mut self, _scale: &Scale) {}

    /// A step was accepted, from `start` to `end` in the branches `negative`: told before the samples in it and before
    /// what happens at its end. The rates at both ends are those of these branches.
    fn passed(&mut self, _start: &Point, _end: &Point, _negative: &[bool]) {}

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
