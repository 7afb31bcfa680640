//! A step with guards along it: what detection and location ask of it.
//!
//! In: a step that has been made. Out: its ends, the guards at any point of it, the same step with another size. The
//! guards are those of a system's switches, or a condition that ends the run (`condition`).

use nalgebra::SVector;

use crate::model::system::System;
use crate::solve::integrator::{Method, Point};
use crate::solve::stepper::Stepper;

/// A step with `G` guards along it.
pub(crate) trait Guarded<const N: usize, const G: usize> {
    /// Where it starts; the rate is known.
    fn start(&self) -> &Point<N>;

    /// Where the last attempt led.
    fn end(&self) -> &Point<N>;

    /// The size of the last attempt, s.
    fn size(&self) -> f64;

    /// Whether each guard is to be negative in the step.
    fn negative(&self) -> [bool; G];

    /// The guards at time `t` (s) and state `x`.
    fn guards(&mut self, t: f64, x: &SVector<f64, N>) -> SVector<f64, G>;

    /// The state at the part `theta` of the step, not projected. The rates at both ends must be known.
    fn dense(&mut self, theta: f64) -> SVector<f64, N>;

    /// Tries the step with size `h` (s); its end is projected until that moves it no more, the rate there is not known.
    fn resize(&mut self, h: f64);

    /// Evaluates the rate at the end of the step, which is not later than `latest` (s).
    fn close(&mut self, latest: f64);

    /// The guards at the part `theta` of the step, by the dense output.
    fn dense_guards(&mut self, theta: f64) -> SVector<f64, G> {
        let t = self.start().t + theta * self.size();
        let x = self.dense(theta);
        self.guards(t, &x)
    }
}

/// The switches of the system.
impl<Sys, M, const N: usize, const G: usize> Guarded<N, G> for Stepper<'_, Sys, M, N, G>
where
    Sys: System<f64, N, G>,
    M: Method,
{
    fn start(&self) -> &Point<N> {
        &self.start
    }

    fn end(&self) -> &Point<N> {
        &self.end
    }

    fn size(&self) -> f64 {
        self.h
    }

    fn negative(&self) -> [bool; G] {
        self.negative
    }

    fn guards(&mut self, t: f64, x: &SVector<f64, N>) -> SVector<f64, G> {
        let mut guards = SVector::zeros();
        self.statistics.guard_evaluations += 1;
        self.system.guards(t, x, &self.negative, &mut guards);
        guards
    }

    fn dense(&mut self, theta: f64) -> SVector<f64, N> {
        Stepper::dense(self, theta)
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
