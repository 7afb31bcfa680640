//! Rosenbrock methods: linearly implicit, with the exact Jacobian and df/dt, without an iteration.
//!
//! In: a step. Out: the state after it; of [`Rodas5p`] with an error estimate and a dense output of order 4. Sources: see
//! `tableau`.

mod step;
mod tableau;

use crate::solve::integrator::Arch;
use nalgebra::SVector;

use super::tolerances::index_of_largest;
use super::{Flow, Method, Point, Scale, StepControl, hermite};
use step::{Stages, add};
use tableau::{RODAS5P, RODAS5P_DENSE, ROS2};

/// Steinebach's RODAS5P of order 5(4), stiffly accurate and L-stable: for stiff systems at tolerances from 1e-3 to 1e-8.
/// A step takes one Jacobian, one factorisation, eight solves and seven rates beside that at its start.
#[derive(Clone, Debug)]
pub struct Rodas5p<const N: usize> {
    stages: Stages<8, N>,
    /// The dense output's coefficients.
    dense: [SVector<f64, N>; 3],
    /// The machine's vectors.
    pub(super) arch: Arch,
}

impl<const N: usize> Rodas5p<N> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { stages: Stages::new(), dense: [SVector::zeros(); 3], arch: Arch::new() }
    }
}

impl<const N: usize> Default for Rodas5p<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Method<N> for Rodas5p<N> {
    fn name(&self) -> &'static str {
        "RODAS5P"
    }

    fn control(&self) -> StepControl {
        StepControl::Adaptive { order: 5.0 }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        match self.stages.evaluate(self.arch, &RODAS5P, flow, start, h, scale) {
            None => f64::INFINITY,
            Some(false) => f64::NAN,
            Some(true) => {
                *end = self.stages.end(&RODAS5P, start);
                self.stages.error(&RODAS5P, start, scale, end)
            }
        }
    }

    fn advance(&mut self) {
        self.stages.forget();
    }

    fn restart(&mut self) {
        self.stages.forget();
    }

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        let errors = self.stages.errors(&RODAS5P, start, scale, end);
        index_of_largest::<N>(|i| errors[i])
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.stages.fault
    }

    fn prepare_dense(&mut self, _flow: &impl Flow<N>, _start: &Point<N>, _h: f64, _end: &Point<N>) {
        for (v, weights) in self.dense.iter_mut().zip(&RODAS5P_DENSE) {
            *v = SVector::zeros();
            add(v, weights, &self.stages.u, 1.0);
        }
    }

    fn dense(&self, start: &Point<N>, _h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        let rest = 1.0 - theta;
        let [v0, v1, v2] = &self.dense;
        for n in 0..N {
            let bulge = v0[n] + theta * (v1[n] + theta * v2[n]);
            x[n] = rest * start.x[n] + theta * (end.x[n] + rest * bulge);
        }
    }
}

/// ROS2 of order 2 with a fixed step, L-stable: the semi-implicit method for real-time use. Every step takes the same work,
/// one Jacobian, one factorisation, two solves and one rate beside that at its start, and stays stable however stiff the
/// system is. The dense output is the cubic through both ends.
#[derive(Clone, Debug)]
pub struct Ros2<const N: usize> {
    step: f64,
    stages: Stages<2, N>,
    /// The machine's vectors.
    pub(super) arch: Arch,
}

impl<const N: usize> Ros2<N> {
    /// The method with steps of `step` (s); the driver refuses a step that is not positive and finite.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self { step, stages: Stages::new(), arch: Arch::new() }
    }
}

impl<const N: usize> Method<N> for Ros2<N> {
    fn name(&self) -> &'static str {
        "ROS2"
    }

    fn control(&self) -> StepControl {
        StepControl::Fixed { step: self.step }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        if self.stages.evaluate(self.arch, &ROS2, flow, start, h, scale) != Some(true) {
            return f64::NAN;
        }
        *end = self.stages.end(&ROS2, start);
        0.0
    }

    fn advance(&mut self) {
        self.stages.forget();
    }

    fn restart(&mut self) {
        self.stages.forget();
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.stages.fault
    }

    fn dense(&self, start: &Point<N>, h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        hermite(start, h, end, theta, x);
    }
}
