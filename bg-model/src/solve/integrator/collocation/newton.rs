//! The simplified Newton iteration for the increments of the stages.
//!
//! In: starting values, factors of I - h c J for the eigenvalues c of A. Out: the increments, or why there are none.
//! A correction D of Z solves (I - h A x J) D = h A f - Z; with A = sum of right c left over its eigenvalues it is one
//! real system and one complex system for each pair. Source: Hairer, Wanner II, section IV.8; the tests of convergence
//! and their constants are those of `radau5.f`.

use alloc::vec::Vec;

use nalgebra::Complex;
use pulp::NullaryFnOnce;

use super::{Collocation, KEEP, Tableau};
use crate::model::scalar::double::root;
use crate::solve::integrator::side_by_side::{OfEach, for_each, put, some};
use crate::solve::integrator::tolerances::largest;
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

struct Correction<'a, const S: usize, const P: usize> {
    core: &'a mut Collocation<S, P>,
    flow: &'a Flow<'a>,
    start: PointRef<'a>,
    h: f64,
    scale: &'a Scale,
}

impl<const S: usize, const P: usize> NullaryFnOnce for Correction<'_, S, P> {
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
        flow: &Flow<'_>,
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
    fn evaluate_stages(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64) -> bool {
        let Self { tableau, z, f, room: [x, _], .. } = self;
        for ((c, z), f) in tableau.c.iter().zip(z).zip(f) {
            x.iter_mut().zip(start.x).zip(z).for_each(|((x, start), z)| *x = start + *z);
            flow.rate(start.t + c * h, x, f);
            if !is_finite(f) {
                return false;
            }
        }
        true
    }

    /// Corrects the increments once. Gives the norm of the correction.
    fn correct(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> f64 {
        let arch = self.arch;
        arch.dispatch(Correction { core: self, flow, start, h, scale })
    }

    #[inline(always)]
    fn correct_inlined(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> f64 {
        let n = flow.states();
        let Self { tableau, z, f, room: [_, sizes], real_side, complex_sides, .. } = self;
        let tableau: &Tableau<S, P> = tableau;
        for_each(n, &mut Residuals { tableau, z, f, h, real: real_side, complex: complex_sides });
        self.real.solve(flow, &mut real_side[..n]);
        for (factors, complex) in self.complex.iter().zip(&mut *complex_sides) {
            factors.solve(flow, &mut complex[..n]);
        }
        let corrections =
            &mut Corrections { tableau, real: real_side, complex: complex_sides, scale, start: start.x, z, sizes };
        for_each(n, corrections);
        largest(&sizes[..n])
    }
}

/// The right-hand sides of a correction.
struct Residuals<'a, const S: usize, const P: usize> {
    tableau: &'a Tableau<S, P>,
    z: &'a [Vec<f64>; S],
    f: &'a [Vec<f64>; S],
    h: f64,
    real: &'a mut [f64],
    complex: &'a mut [Vec<Complex<f64>>; P],
}

impl<const S: usize, const P: usize> OfEach for Residuals<'_, S, P> {
    const CAN_REPEAT: bool = true;

    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { tableau, h, .. } = self;
        let (mut f, mut residuals) = ([[0.0; W]; S], [[0.0; W]; S]);
        for j in 0..S {
            f[j] = some(&self.f[j], first);
            residuals[j] = some(&self.z[j], first);
            for f in &mut f[j] {
                *f *= *h;
            }
        }
        for (residual, row) in residuals.iter_mut().zip(&tableau.a) {
            let sums = weighted(row, &f);
            for i in 0..W {
                residual[i] = sums[i] - residual[i];
            }
        }
        put(self.real, first, weighted(&tableau.real.left, &residuals));
        for (complex, mode) in self.complex.iter_mut().zip(&tableau.pairs) {
            let [re, im] = [0, 1].map(|part| weighted(&mode.left[part], &residuals));
            for i in 0..W {
                complex[first + i] = Complex::new(re[i], im[i]);
            }
        }
    }
}

/// The corrected increments, and the sizes of the corrections in parts of what is allowed.
struct Corrections<'a, const S: usize, const P: usize> {
    tableau: &'a Tableau<S, P>,
    real: &'a [f64],
    complex: &'a [Vec<Complex<f64>>; P],
    scale: &'a Scale,
    start: &'a [f64],
    z: &'a mut [Vec<f64>; S],
    sizes: &'a mut [f64],
}

impl<const S: usize, const P: usize> OfEach for Corrections<'_, S, P> {
    const CAN_REPEAT: bool = false;

    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { tableau, scale, .. } = self;
        let (real, start): ([f64; W], [f64; W]) = (some(self.real, first), some(self.start, first));
        let absolute: [f64; W] = some(&scale.absolute, first);
        let mut parts = [[[0.0; W]; 2]; P];
        for ([re, im], complex) in parts.iter_mut().zip(self.complex) {
            let complex: [Complex<f64>; W] = some(complex, first);
            for i in 0..W {
                (re[i], im[i]) = (complex[i].re, complex[i].im);
            }
        }
        let mut sizes = [0.0; W];
        for (j, z) in self.z.iter_mut().enumerate() {
            let mut corrections = [0.0; W];
            for i in 0..W {
                corrections[i] = tableau.real.right[j] * real[i];
            }
            for ([re, im], mode) in parts.iter().zip(&tableau.pairs) {
                for i in 0..W {
                    corrections[i] += mode.right[0][j] * re[i] - mode.right[1][j] * im[i];
                }
            }
            let mut increments: [f64; W] = some(z, first);
            for i in 0..W {
                increments[i] += corrections[i];
                // A correction that is no number shows as an infinite one.
                let size = if corrections[i].is_nan() { f64::INFINITY } else { corrections[i].abs() };
                sizes[i] = if size > sizes[i] { size } else { sizes[i] };
            }
            put(z, first, increments);
        }
        for i in 0..W {
            sizes[i] /= absolute[i] + start[i].abs() * scale.relative;
        }
        put(self.sizes, first, sizes);
    }
}

/// The sums of these numbers with weights, in their order.
#[inline(always)]
fn weighted<const S: usize, const W: usize>(weights: &[f64; S], of: &[[f64; W]; S]) -> [f64; W] {
    let mut sums = [0.0; W];
    for i in 0..W {
        sums[i] = weights[0] * of[0][i];
    }
    for j in 1..S {
        for i in 0..W {
            sums[i] += weights[j] * of[j][i];
        }
    }
    sums
}
