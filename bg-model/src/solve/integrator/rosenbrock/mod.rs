//! Rosenbrock methods: linearly implicit, with the exact Jacobian and df/dt, without an iteration.
//!
//! In: a step. Out: the state after it; of [`Rodas5p`] with an error estimate and a dense output of order 4. Sources:
//! see `tableau`.

mod step;
mod tableau;

use alloc::vec::Vec;

use super::tolerances::index_of_largest;
use super::{Flow, Method, PointRef, Scale, StepControl, hermite};
use step::{Stages, add};
use tableau::{RODAS5P, RODAS5P_DENSE, ROS2};

/// Steinebach's RODAS5P of order 5(4), stiffly accurate and L-stable: for stiff systems at tolerances from 1e-3 to
/// 1e-8. A step takes one Jacobian, one factorisation, eight solves and seven rates beside that at its start.
#[derive(Clone, Debug)]
pub struct Rodas5p {
    stages: Stages<8>,
    /// The dense output's coefficients.
    dense: [Vec<f64>; 3],
}

impl Rodas5p {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { stages: Stages::new(), dense: [const { Vec::new() }; 3] }
    }
}

impl Default for Rodas5p {
    fn default() -> Self {
        Self::new()
    }
}

impl Method for Rodas5p {
    fn name(&self) -> &'static str {
        "RODAS5P"
    }

    fn control(&self) -> StepControl {
        StepControl::Adaptive { order: 5.0 }
    }

    fn fit(&mut self, states: usize) {
        self.stages.fit(states);
        self.dense.iter_mut().for_each(|room| room.resize(states, 0.0));
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        match self.stages.evaluate(&RODAS5P, flow, start, h, scale) {
            None => f64::INFINITY,
            Some(false) => f64::NAN,
            Some(true) => {
                self.stages.write_end(&RODAS5P, start, end);
                self.stages.error(start, scale, end)
            }
        }
    }

    fn advance(&mut self) {
        self.stages.forget();
    }

    fn restart(&mut self) {
        self.stages.forget();
    }

    fn largest_error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> usize {
        index_of_largest(end.len(), |i| self.stages.part(i, start, scale, end))
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.stages.fault
    }

    fn prepare_dense(&mut self, _flow: &Flow<'_>, _start: PointRef<'_>, _h: f64, _end: PointRef<'_>) {
        for (v, weights) in self.dense.iter_mut().zip(&RODAS5P_DENSE) {
            v.fill(0.0);
            add(v, weights, &self.stages.u, 1.0);
        }
    }

    fn dense(&self, start: PointRef<'_>, _h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        let rest = 1.0 - theta;
        let [v0, v1, v2] = &self.dense;
        for n in 0..x.len() {
            let bulge = v0[n] + theta * (v1[n] + theta * v2[n]);
            x[n] = rest * start.x[n] + theta * (end.x[n] + rest * bulge);
        }
    }
}

/// ROS2 of order 2 with a fixed step, L-stable: the semi-implicit method for real-time use. Every step takes the same
/// work, one Jacobian, one factorisation, two solves and one rate beside that at its start, and stays stable however
/// stiff the system is. The dense output is the cubic through both ends.
#[derive(Clone, Debug)]
pub struct Ros2 {
    step: f64,
    stages: Stages<2>,
}

impl Ros2 {
    /// The method with steps of `step` (s); the driver refuses a step that is not positive and finite.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self { step, stages: Stages::new() }
    }
}

impl Method for Ros2 {
    fn name(&self) -> &'static str {
        "ROS2"
    }

    fn control(&self) -> StepControl {
        StepControl::Fixed { step: self.step }
    }

    fn fit(&mut self, states: usize) {
        self.stages.fit(states);
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        if self.stages.evaluate(&ROS2, flow, start, h, scale) != Some(true) {
            return f64::NAN;
        }
        self.stages.write_end(&ROS2, start, end);
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

    fn dense(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        hermite(start, h, end, theta, x);
    }
}
