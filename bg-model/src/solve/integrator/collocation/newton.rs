//! The simplified Newton iteration for the increments of the stages.
//!
//! In: starting values, factors of I - h c J for the eigenvalues c of A. Out: the increments, or why there are none.
//! A correction D of Z solves (I - h A x J) D = h A f - Z; with A = sum of right c left over its eigenvalues it is one
//! real system and one complex system for each pair. Source: Hairer, Wanner II, section IV.8; the tests of convergence
//! and their constants are those of `radau5.f`.

use nalgebra::Complex;
use pulp::NullaryFnOnce;

use super::{Collocation, KEEP};
use crate::model::scalar::double::root;
use crate::solve::integrator::tolerances::largest;
use crate::solve::integrator::vectors::rate_in;
use crate::solve::integrator::{Flow, PointRef, Scale, is_finite};

/// Corrections that shrink by less do not converge.
const SLOWEST: f64 = 0.99;
/// The error that may be left on the way to rounding, in rounding units: the same in every step, it would add up.
const REST: f64 = 1e-3;
/// The most corrections on the way to rounding.
const PATIENCE: usize = 50;

/// How far the iteration is to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// Until the tolerances do not notice what is missing.
    Tolerance,
    /// Until corrections stop shrinking.
    Rounding,
}

/// How the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Convergence {
    Reached,
    Fails,
    NotFinite,
}

/// What corrections are compared with, in units of the tolerances.
fn allowance(relative: f64) -> f64 {
    let loosest = if relative < 9e-4 { root(relative) } else { 0.03 };
    let tightest = 10.0 * f64::EPSILON / relative;
    if loosest > tightest { loosest } else { tightest }
}

struct Correction<'a, F: ?Sized, const S: usize, const P: usize> {
    core: &'a mut Collocation<S, P>,
    flow: &'a F,
    start: PointRef<'a>,
    h: f64,
    scale: &'a Scale,
}

impl<F: Flow + ?Sized, const S: usize, const P: usize> NullaryFnOnce for Correction<'_, F, S, P> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self { core, flow, start, h, scale } = self;
        core.correct_inlined(flow, start, h, scale)
    }
}

impl<const S: usize, const P: usize> Collocation<S, P> {
    /// The most corrections: 7 for three stages, five more for every two stages more, as in Hairer's `radau.f`.
    const MOST: usize = 7 + 5 * (S - 3) / 2;

    /// Iterates from the increments at hand.
    pub(super) fn iterate(
        &mut self,
        flow: &(impl Flow + ?Sized),
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        goal: Goal,
    ) -> Convergence {
        let allowance = allowance(scale.relative);
        let exact = REST * f64::EPSILON / scale.relative;
        let most = if goal == Goal::Rounding { PATIENCE } else { Self::MOST };
        let (mut size_before, mut ratio_before) = (0.0, 0.0);
        let mut is_near = false;
        self.remainder = libm::pow(self.remainder.max(KEEP), 0.8);
        self.contraction = 0.0;
        for done in 1..=most {
            if !self.evaluate_stages(flow, start, h) {
                return Convergence::NotFinite;
            }
            let size = self.correct(flow, start, h, scale);
            if !size.is_finite() {
                return Convergence::NotFinite;
            }
            if done > 1 && !is_near {
                let ratio = size / size_before;
                self.contraction = if done == 2 { ratio } else { root(ratio * ratio_before) };
                ratio_before = ratio;
                if self.contraction >= SLOWEST {
                    return Convergence::Fails;
                }
                self.remainder = self.contraction / (1.0 - self.contraction);
                let left = (most - done) as f64;
                if self.remainder * size * libm::pow(self.contraction, left) >= allowance {
                    return Convergence::Fails;
                }
            }
            if is_near && (size >= size_before || done == most) {
                return Convergence::Reached;
            }
            is_near = is_near || self.remainder * size <= allowance;
            let is_there = if goal == Goal::Rounding { self.remainder * size <= exact } else { is_near };
            if is_there && (done > 1 || goal == Goal::Tolerance || size == 0.0) {
                return Convergence::Reached;
            }
            size_before = size.max(f64::MIN_POSITIVE);
        }
        Convergence::Fails
    }

    /// Evaluates the rates of all stages. Gives whether they are finite; stops at the first that is not.
    fn evaluate_stages(&mut self, flow: &(impl Flow + ?Sized), start: PointRef<'_>, h: f64) -> bool {
        let Self { tableau, z, f, room: [x, _], arch, .. } = self;
        for ((c, z), f) in tableau.c.iter().zip(z).zip(f) {
            x.iter_mut().zip(start.x).zip(z).for_each(|((x, start), z)| *x = start + *z);
            rate_in(*arch, flow, start.t + c * h, x, f);
            if !is_finite(f) {
                return false;
            }
        }
        true
    }

    /// Corrects the increments once. Gives the norm of the correction.
    fn correct(&mut self, flow: &(impl Flow + ?Sized), start: PointRef<'_>, h: f64, scale: &Scale) -> f64 {
        let arch = self.arch;
        arch.dispatch(Correction { core: self, flow, start, h, scale })
    }

    #[inline(always)]
    fn correct_inlined(&mut self, flow: &(impl Flow + ?Sized), start: PointRef<'_>, h: f64, scale: &Scale) -> f64 {
        let n = flow.states();
        let Self { tableau, z, f, room: [_, sizes], real_side, complex_sides, .. } = self;
        let (z, f) = (z.each_mut().map(|z| &mut z[..n]), f.each_ref().map(|f| &f[..n]));
        let (real, sizes) = (&mut real_side[..n], &mut sizes[..n]);
        let mut complex = complex_sides.each_mut().map(|side| &mut side[..n]);
        for i in 0..n {
            let f: [f64; S] = core::array::from_fn(|j| h * f[j][i]);
            let residual: [f64; S] = core::array::from_fn(|j| dot(&tableau.a[j], &f) - z[j][i]);
            real[i] = dot(&tableau.real.left, &residual);
            for (complex, mode) in complex.iter_mut().zip(&tableau.pairs) {
                complex[i] = Complex::new(dot(&mode.left[0], &residual), dot(&mode.left[1], &residual));
            }
        }
        self.real.solve(self.arch, flow, real);
        for (factors, complex) in self.complex.iter().zip(&mut complex) {
            factors.solve(self.arch, flow, complex);
        }
        for i in 0..n {
            let allowed = scale.allowed(i, start.x[i]);
            let mut size = 0.0;
            for j in 0..S {
                let mut correction = tableau.real.right[j] * real[i];
                for (complex, mode) in complex.iter().zip(&tableau.pairs) {
                    correction += mode.right[0][j] * complex[i].re - mode.right[1][j] * complex[i].im;
                }
                z[j][i] += correction;
                // A correction that is no number shows as an infinite one.
                let correction = if correction.is_nan() { f64::INFINITY } else { correction.abs() };
                size = if correction > size { correction } else { size };
            }
            sizes[i] = size / allowed;
        }
        largest(sizes)
    }
}

#[inline(always)]
fn dot<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let mut sum = a[0] * b[0];
    for j in 1..S {
        sum += a[j] * b[j];
    }
    sum
}
