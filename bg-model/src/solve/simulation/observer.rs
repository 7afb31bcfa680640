//! Observers: who is told what a run gives.

use nalgebra::SVector;

use crate::solve::statistics::Statistics;

/// Is told what a run gives, in the order of time. Every method does nothing by default.
pub trait Observer<const N: usize, const G: usize> {
    /// The state `x` at a sample instant `t` (s) and the branches of the step that leads there. At the instant of an impact it is
    /// the state before it; at the start of a run the state after it.
    fn sample(&mut self, _t: f64, _x: &SVector<f64, N>, _negative: &[bool; G]) {}

    /// Switch `switch` has changed its branch at `t` (s) and state `x`, or its stop was hit and is left again; `negative` are the
    /// branches after that, `x` the state after the impact.
    fn event(&mut self, _t: f64, _x: &SVector<f64, N>, _switch: usize, _negative: &[bool; G]) {}

    /// A step was accepted that leads to `t` (s), on the way to `t_end` (s).
    fn step(&mut self, _t: f64, _t_end: f64, _statistics: &Statistics) {}

    /// Whether the run ends here: asked after each accepted step, whose end then is the end of the run and its last sample.
    fn is_done(&self) -> bool {
        false
    }
}

impl<const N: usize, const G: usize> Observer<N, G> for () {}

/// Both are told, the first one first; the run ends as soon as one of them is done.
impl<A, B, const N: usize, const G: usize> Observer<N, G> for (A, B)
where
    A: Observer<N, G>,
    B: Observer<N, G>,
{
    fn sample(&mut self, t: f64, x: &SVector<f64, N>, negative: &[bool; G]) {
        self.0.sample(t, x, negative);
        self.1.sample(t, x, negative);
    }

    fn event(&mut self, t: f64, x: &SVector<f64, N>, switch: usize, negative: &[bool; G]) {
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

impl<F: FnMut(f64), const N: usize, const G: usize> Observer<N, G> for EachStep<F> {
    fn step(&mut self, t: f64, _t_end: f64, _statistics: &Statistics) {
        (self.0)(t);
    }
}

impl<F, const N: usize, const G: usize> Observer<N, G> for EachSample<F>
where
    F: FnMut(f64, &SVector<f64, N>, &[bool; G]),
{
    fn sample(&mut self, t: f64, x: &SVector<f64, N>, negative: &[bool; G]) {
        (self.0)(t, x, negative);
    }
}
