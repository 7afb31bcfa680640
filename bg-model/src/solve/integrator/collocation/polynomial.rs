//! The collocation polynomial: states inside the step, and starting values for the next one.
//!
//! In: the increments at the nodes. Out: values of the polynomial of degree s through zero and them; its error falls with
//! the power s + 1 of the step. Source: Hairer, Wanner II, section IV.8, equations (8.14) and (8.17).

use nalgebra::SVector;

use super::Collocation;
use super::tableau::Tableau;
use crate::solve::integrator::Point;

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

impl<const N: usize, const S: usize, const P: usize> Collocation<N, S, P> {
    /// Writes the state at the part `theta` of the last attempt into `x`. Compiled once, not again for each choice of methods.
    #[inline(never)]
    pub fn dense(&self, start: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        let weights = self.tableau.weights(theta);
        for i in 0..N {
            x.data.0[0][i] = start.x.data.0[0][i] + combine(&weights, &self.z, i);
        }
    }

    /// Starts the increments of a step of size `h` (s) on the polynomial of the step before, at zero where there is none or it
    /// was so short that nothing of it holds so far ahead.
    pub(super) fn extrapolate(&mut self, h: f64) {
        if self.step_before == 0.0 || h > FARTHEST * self.step_before {
            self.z = [SVector::zeros(); S];
            return;
        }
        let ratio = h / self.step_before;
        let end = self.tableau.weights(1.0);
        for (j, c) in self.tableau.c.iter().enumerate() {
            let ahead = self.tableau.weights(1.0 + c * ratio);
            let weights = core::array::from_fn(|k| ahead[k] - end[k]);
            for i in 0..N {
                self.z[j].data.0[0][i] = combine(&weights, &self.before, i);
            }
        }
    }
}

/// Entry `i` of a linear combination.
#[inline(always)]
fn combine<const N: usize, const S: usize>(weights: &[f64; S], of: &[SVector<f64, N>; S], i: usize) -> f64 {
    let mut sum = weights[0] * of[0].data.0[0][i];
    for j in 1..S {
        sum += weights[j] * of[j].data.0[0][i];
    }
    sum
}
