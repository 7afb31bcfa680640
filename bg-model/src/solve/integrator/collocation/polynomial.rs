//! The collocation polynomial: states inside the step, and starting values for the next one.
//!
//! In: the increments at the nodes. Out: values of the polynomial of degree s through zero and them; its error falls
//! with the power s + 1 of the step. Source: Hairer, Wanner II, section IV.8, equations (8.14) and (8.17).

use alloc::vec::Vec;

use super::Collocation;
use super::tableau::Tableau;
use crate::solve::integrator::PointRef;

/// The step over the one before up to which the polynomial is extrapolated: error control stays far below it.
const FARTHEST: f64 = 100.0;

impl<const S: usize, const P: usize> Tableau<S, P> {
    /// The increments' weights at the part `theta` of the step: Lagrange's polynomials over zero and the nodes.
    pub(super) fn weights(&self, theta: f64) -> [f64; S] {
        let c = &self.c;
        core::array::from_fn(|j| {
            let others = (0..S).filter(|k| *k != j);
            others.fold(theta / c[j], |weight, k| weight * ((theta - c[k]) / (c[j] - c[k])))
        })
    }
}

impl<const S: usize, const P: usize> Collocation<S, P> {
    /// Writes the state at the part `theta` of the last attempt into `x`.
    pub fn dense(&self, start: PointRef<'_>, theta: f64, x: &mut [f64]) {
        let weights = self.tableau.weights(theta);
        for (i, (x, start)) in x.iter_mut().zip(start.x).enumerate() {
            *x = start + combine(&weights, &self.z, i);
        }
    }

    /// Starts the increments of a step of size `h` (s) on the polynomial of the step before, at zero where there is
    /// none or it was so short that nothing of it holds so far ahead.
    pub(super) fn extrapolate(&mut self, h: f64) {
        if self.step_before == 0.0 || h > FARTHEST * self.step_before {
            self.z.iter_mut().for_each(|z| z.fill(0.0));
            return;
        }
        let ratio = h / self.step_before;
        let end = self.tableau.weights(1.0);
        for (j, c) in self.tableau.c.iter().enumerate() {
            let ahead = self.tableau.weights(1.0 + c * ratio);
            let weights = core::array::from_fn(|k| ahead[k] - end[k]);
            for (i, z) in self.z[j].iter_mut().enumerate() {
                *z = combine(&weights, &self.before, i);
            }
        }
    }
}

/// Entry `i` of a linear combination.
#[inline(always)]
fn combine<const S: usize>(weights: &[f64; S], of: &[Vec<f64>; S], i: usize) -> f64 {
    let mut sum = weights[0] * of[0][i];
    for j in 1..S {
        sum += weights[j] * of[j][i];
    }
    sum
}
