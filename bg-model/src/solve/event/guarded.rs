//! A step with guards along it: what detection and location ask of it.
//!
//! In: a step that has been made. Out: its ends, the guards at any point of it, the same step with another size. The
//! guards are those of a system's switches, or a condition that ends the run (`condition`).

use alloc::vec;
use alloc::vec::Vec;

use crate::solve::integrator::Point;
use crate::solve::stepper::Stepper;

/// An end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Where it starts.
    Start,
    /// Where the last attempt led.
    End,
}

/// A step with guards along it.
pub(crate) trait Guarded {
    /// An end of the step; at the start the rate is known.
    fn point(&self, end: End) -> &Point;

    /// The size of the last attempt, s.
    fn size(&self) -> f64;

    /// Whether each guard is to be negative in the step.
    fn negative(&self) -> &[bool];

    /// Writes the guards at time `t` (s) and state `x` into `guards`.
    fn read(&mut self, t: f64, x: &[f64], guards: &mut [f64]);

    /// Writes the guards at an end of the step into `guards`.
    fn read_end(&mut self, end: End, guards: &mut [f64]);

    /// Writes the state at the part `theta` of the step, not projected, into `x`. The rates at both ends must be known.
    fn dense(&mut self, theta: f64, x: &mut [f64]);

    /// Tries the step with size `h` (s); its end is projected until that moves it no more, the rate there is not known.
    fn resize(&mut self, h: f64);

    /// Evaluates the rate at the end of the step, which is not later than `latest` (s).
    fn close(&mut self, latest: f64);

    /// The guards at time `t` (s) and state `x`.
    fn guards(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        let mut guards = vec![0.0; self.negative().len()];
        self.read(t, x, &mut guards);
        guards
    }

    /// The guards at an end of the step.
    fn guards_of(&mut self, end: End) -> Vec<f64> {
        let mut guards = vec![0.0; self.negative().len()];
        self.read_end(end, &mut guards);
        guards
    }

    /// The time (s) and the state at the part `theta` of the step, by the dense output.
    fn inside(&mut self, theta: f64) -> (f64, Vec<f64>) {
        let Point { t, x, .. } = self.point(End::Start);
        let (t, mut x) = (t + theta * self.size(), vec![0.0; x.len()]);
        self.dense(theta, &mut x);
        (t, x)
    }

    /// The guards there.
    fn dense_guards(&mut self, theta: f64) -> Vec<f64> {
        let (t, x) = self.inside(theta);
        self.guards(t, &x)
    }
}

/// The switches of the system.
impl Guarded for Stepper<'_> {
    fn point(&self, end: End) -> &Point {
        match end {
            End::Start => &self.start,
            End::End => &self.end,
        }
    }

    fn size(&self) -> f64 {
        self.h
    }

    fn negative(&self) -> &[bool] {
        &self.negative
    }

    fn read(&mut self, t: f64, x: &[f64], guards: &mut [f64]) {
        self.statistics.guard_evaluations += 1;
        self.system.guards(t, x, &self.negative, guards);
    }

    fn read_end(&mut self, end: End, guards: &mut [f64]) {
        self.statistics.guard_evaluations += 1;
        let Point { t, x, .. } = self.point(end);
        self.system.guards(*t, x.as_slice(), &self.negative, guards);
    }

    fn dense(&mut self, theta: f64, x: &mut [f64]) {
        Stepper::dense(self, theta, x);
    }

    fn resize(&mut self, h: f64) {
        self.attempt(h);
        self.settle();
    }

    fn close(&mut self, latest: f64) {
        self.end.t = self.end.t.min(latest);
        self.evaluate_end();
    }
}
