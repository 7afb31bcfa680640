//! The classical Runge-Kutta method of order 4 with a fixed step.
//!
//! In: the step. Out: the state after it; in between the cubic Hermite polynomial, whose error is of the same order as
//! the method's. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, table II.1.2.

use nalgebra::SVector;

use super::{Flow, Method, Point, Scale, StepControl, first_not_finite, hermite};

/// Kutta's method of order 4; four rates a step, no error estimate.
#[derive(Clone, Debug)]
pub struct Rk4<const N: usize> {
    step: f64,
    k: [SVector<f64, N>; 3],
}

/// Instants of the second to the fourth stage and the weight of the stage before in each.
const C: [f64; 3] = [0.5, 0.5, 1.0];
/// Weights of the four stages.
const B: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

impl<const N: usize> Rk4<N> {
    /// The method with steps of `step` (s); the driver refuses a step that is not positive and finite.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self { step, k: [SVector::zeros(); 3] }
    }
}

impl<const N: usize> Method<N> for Rk4<N> {
    fn name(&self) -> &'static str {
        "RK4"
    }

    fn control(&self) -> StepControl {
        StepControl::Fixed { step: self.step }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        _scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        for (stage, c) in C.into_iter().enumerate() {
            let before = if stage == 0 { &start.rate } else { &self.k[stage - 1] };
            let mut x = start.x;
            for i in 0..N {
                x.data.0[0][i] += h * (c * before.data.0[0][i]);
            }
            flow.rate(start.t + c * h, &x, &mut self.k[stage]);
        }
        let (k0, [k1, k2, k3]) = (&start.rate.data.0[0], &self.k);
        let (k1, k2, k3) = (&k1.data.0[0], &k2.data.0[0], &k3.data.0[0]);
        for i in 0..N {
            end.data.0[0][i] = start.x.data.0[0][i] + h * (B[0] * k0[i] + B[1] * k1[i] + B[2] * k2[i] + B[3] * k3[i]);
        }
        0.0
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.k.iter().find_map(first_not_finite)
    }

    fn dense(&self, start: &Point<N>, h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        hermite(start, h, end, theta, x);
    }
}
