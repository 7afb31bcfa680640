//! Collocation methods: the core that those of Radau and of Gauss share.
//!
//! In: a tableau and a step. Out: the increments of the stages, the error estimate, the collocation polynomial. The
//! polynomial u of degree s has u(t0) = x0 and u' = f(t, u) at the s nodes; its increments Z = u - x0 there solve
//! Z = h A f(x0 + Z). Source: Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd edition, section IV.8,
//! and their program `radau5.f`. Other than there, the residual is formed with A itself and only the correction goes
//! through the transformation, so that the solution is as exact as A; norms are maxima, as in `tolerances`; and a step
//! that does not converge with an old Jacobian is tried again with the one at its start before it is given up.

mod newton;
#[cfg(test)]
mod order;
mod polynomial;
mod radau9;
mod tableau;

use alloc::vec::Vec;

use nalgebra::Complex;

use self::newton::{Convergence, Goal};
pub(super) use self::radau9::RADAU9;
pub(super) use self::tableau::{GAUSS6, RADAU5, Tableau};
use super::tolerances::{index_of_largest, largest_of};
use super::{Arch, Flow, PointRef, Scale, first_not_finite, is_finite};
use crate::solve::integrator::linear::{Factors, Jacobian};

/// A Jacobian serves the next step as well if the corrections shrank at least by this factor (THET of `radau5.f`).
const KEEP: f64 = 1e-3;
/// Factors serve other steps that differ by this part at most: they then shrink corrections by about this factor.
const NEARLY: f64 = 1e-3;

/// What the attempts from the present start have come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Attempts {
    None,
    Rejected,
    /// The last one satisfied the tolerances.
    Satisfied,
}

/// A collocation method of `S` stages, of which `P` pairs have complex eigenvalues, with its work space.
#[derive(Clone, Debug)]
pub(super) struct Collocation<const S: usize, const P: usize> {
    pub tableau: &'static Tableau<S, P>,
    /// Whether every step is solved to rounding.
    is_exact: bool,
    /// The increments of the stages and the rates there.
    z: [Vec<f64>; S],
    f: [Vec<f64>; S],
    error: Vec<f64>,
    /// The state of a stage, and its rate; errors in parts of what is allowed.
    room: [Vec<f64>; 2],
    /// The right-hand sides of a correction.
    real_side: Vec<f64>,
    complex_sides: [Vec<Complex<f64>>; P],
    /// The increments of the step before and its size, s; zero where there is none.
    before: [Vec<f64>; S],
    step_before: f64,
    /// The size of the last attempt, s.
    h: f64,
    attempts: Attempts,
    jacobian: Jacobian,
    has_jacobian: bool,
    /// Whether the Jacobian is that of the present start.
    is_fresh: bool,
    /// The step that the factors belong to, s; zero where there are none.
    factored: f64,
    real: Factors<f64>,
    complex: [Factors<Complex<f64>>; P],
    /// The part by which the last corrections shrank, and that of the last one which the error left by it is. Other
    /// than in `radau5.f` the second holds for these factors only: one from a tiny step would end the next iteration at
    /// once.
    contraction: f64,
    remainder: f64,
    /// The machine's vectors.
    pub arch: Arch,
}

impl<const S: usize, const P: usize> Collocation<S, P> {
    pub fn new(tableau: &'static Tableau<S, P>, is_exact: bool) -> Self {
        Self {
            tableau,
            is_exact,
            z: [const { Vec::new() }; S],
            f: [const { Vec::new() }; S],
            error: Vec::new(),
            room: [const { Vec::new() }; 2],
            real_side: Vec::new(),
            complex_sides: [const { Vec::new() }; P],
            before: [const { Vec::new() }; S],
            step_before: 0.0,
            h: 0.0,
            attempts: Attempts::None,
            jacobian: Jacobian::new(),
            has_jacobian: false,
            is_fresh: false,
            factored: 0.0,
            real: Factors::new(),
            complex: core::array::from_fn(|_| Factors::new()),
            contraction: 0.0,
            remainder: 1.0,
            arch: Arch::new(),
        }
    }

    /// Makes room for so many states. Nothing is left of what was known of another number of them.
    pub fn fit(&mut self, states: usize) {
        if self.error.len() == states {
            return;
        }
        *self = Self { arch: self.arch, ..Self::new(self.tableau, self.is_exact) };
        let Self { z, f, error, room, real_side, complex_sides, before, .. } = self;
        let real = z.iter_mut().chain(f).chain(before).chain(room).chain([error, real_side]);
        real.for_each(|room| room.resize(states, 0.0));
        complex_sides.iter_mut().for_each(|room| room.resize(states, Complex::ZERO));
    }

    /// Nothing is known any more.
    pub fn restart(&mut self) {
        self.has_jacobian = false;
        self.step_before = 0.0;
        self.attempts = Attempts::None;
    }

    /// The last attempt is the step before from now on.
    pub fn advance(&mut self) {
        core::mem::swap(&mut self.before, &mut self.z);
        self.step_before = self.h;
        self.attempts = Attempts::None;
        self.is_fresh = false;
        if self.contraction > KEEP {
            self.has_jacobian = false;
        }
    }

    /// Solves for the increments of a step of size `h` (s). Fails with the error norm that stands for the cause.
    ///
    /// A step that satisfied the tolerances and is tried again with another size is part of a search for an event: it
    /// is solved to rounding, and like all attempts begins at the extrapolation of the step before, so its outcome
    /// depends on its size only.
    pub fn solve(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> Result<(), f64> {
        self.h = h;
        let goal = if self.is_exact || self.attempts == Attempts::Satisfied { Goal::Rounding } else { Goal::Tolerance };
        if !self.has_jacobian {
            self.evaluate_jacobian(flow, start, h, scale);
        }
        loop {
            let convergence = if self.factor(flow, h) {
                self.extrapolate(h);
                self.iterate(flow, start, h, scale, goal)
            } else {
                Convergence::Fails
            };
            match convergence {
                Convergence::Reached => return Ok(()),
                _ if !self.is_fresh => self.evaluate_jacobian(flow, start, h, scale),
                Convergence::Fails => return Err(f64::INFINITY),
                Convergence::NotFinite => return Err(f64::NAN),
            }
        }
    }

    fn evaluate_jacobian(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) {
        self.jacobian.evaluate(flow, start, h, scale);
        (self.has_jacobian, self.is_fresh, self.factored) = (true, true, 0.0);
    }

    /// Makes the factors for a step of size `h` (s) where those at hand do not serve. Gives whether there are any.
    fn factor(&mut self, flow: &Flow<'_>, h: f64) -> bool {
        if self.factored != 0.0 && (h - self.factored).abs() <= NEARLY * h.abs() {
            return true;
        }
        let tableau = self.tableau;
        let mut is_regular = self.real.factor(flow, h * tableau.real.value, &self.jacobian);
        for (factors, mode) in self.complex.iter_mut().zip(&tableau.pairs) {
            let [re, im] = mode.value;
            is_regular = is_regular && factors.factor(flow, Complex::new(h * re, h * im), &self.jacobian);
        }
        self.factored = if is_regular { h } else { 0.0 };
        self.remainder = 1.0;
        is_regular
    }

    /// The norm of the error estimate of the step solved last, up to `end`: of the polynomial's defect at its start,
    /// c (h f(t0, x0) - h u'(t0)), filtered by (I - h c J)^-1 with the real eigenvalue c of A.
    ///
    /// Section IV.8, equations (8.19) and (8.20): after a rejection and in a first step a large estimate is taken once
    /// more, with the rate at x0 and the estimate, because the first one is too large for stiff states.
    pub fn estimate(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &[f64]) -> f64 {
        let is_doubtful = self.attempts == Attempts::Rejected || self.step_before == 0.0;
        let mut norm = self.filtered_defect(flow, start, h, scale, end, None);
        if norm > 1.0 && is_doubtful {
            let Self { error, room: [x, rate], .. } = self;
            x.iter_mut().zip(start.x).zip(error).for_each(|((x, start), error)| *x = start + *error);
            flow.rate(start.t, x, rate);
            let rate = core::mem::take(rate);
            norm = self.filtered_defect(flow, start, h, scale, end, Some(&rate));
            self.room[1] = rate;
        }
        norm
    }

    /// The same of the rate at the start where no other one is given.
    fn filtered_defect(
        &mut self,
        flow: &Flow<'_>,
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        end: &[f64],
        rate: Option<&[f64]>,
    ) -> f64 {
        let (Tableau { real, slope, .. }, rate) = (self.tableau, rate.unwrap_or(start.rate));
        for (i, defect) in self.error.iter_mut().enumerate() {
            let mut sum = slope[0] * self.z[0][i];
            for (weight, z) in slope.iter().zip(&self.z).skip(1) {
                sum += weight * z[i];
            }
            *defect = real.value * (h * rate[i] - sum);
        }
        self.real.solve(flow, &mut self.error);
        if !is_finite(&self.error) {
            return f64::NAN;
        }
        largest_of(end.len(), |i| self.scaled_error(i, start, scale, end))
    }

    fn scaled_error(&self, i: usize, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> f64 {
        self.error[i].abs() / scale.allowed_between(i, start.x[i], end[i])
    }

    /// Takes note of the outcome of an attempt, its error norm.
    pub fn conclude(&mut self, error: f64) -> f64 {
        self.attempts = if error <= 1.0 { Attempts::Satisfied } else { Attempts::Rejected };
        error
    }

    /// The state with the largest error in the last attempt.
    pub fn largest_error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> usize {
        index_of_largest(end.len(), |i| self.scaled_error(i, start, scale, end))
    }

    /// The first state whose rate was not finite in a stage of the last attempt, and that rate.
    pub fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.f.iter().find_map(|rate| first_not_finite(rate))
    }

    /// The increment of the last stage.
    pub fn last_increment(&self) -> &[f64] {
        &self.z[S - 1]
    }

    /// The increment of the whole step by the quadrature, h times the sum of b f.
    pub fn quadrature(&self, i: usize, h: f64) -> f64 {
        let b = &self.tableau.b;
        let mut sum = b[0] * self.f[0][i];
        for (weight, f) in b.iter().zip(&self.f).skip(1) {
            sum += weight * f[i];
        }
        h * sum
    }
}
