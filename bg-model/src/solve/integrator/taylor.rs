//! The Taylor series method: explicit, of any order.
//!
//! In: a flow with its Taylor series ([`System::series`](crate::system::System::series)). Out: the state at the end of a
//! step, its error estimate, and the series itself for what is in between. One series serves all attempts from its start.
//! Error estimate: the last two terms, the one before the last raised to the power with which it would fall like the last
//! (Jorba & Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods,
//! Experimental Mathematics 14 (2005), section 3.2); and the defect at the end, which shows what the series cannot know: a
//! kink, or a jump, inside the step. Where there is no series, as at the zero of a square root, BS5 makes the step, which
//! needs no derivative: its error estimate makes it short.

use alloc::vec::Vec;

use crate::solve::integrator::Arch;
use nalgebra::SVector;

use super::compensated::CompensatedSum;
use super::tolerances::{index_of_largest, largest};
use super::vectors::{Vectorised, attempt_in, rate_in};
use super::{Bs5, Flow, Method, Point, Scale, StepControl, first_not_finite, is_finite};
use crate::model::capability::Series;

/// The highest order.
const HIGHEST: usize = 30;

/// Numbers in a line of the cache. The work space of a series begins with one, so that no vector lies across two.
const LINE: usize = 8;

/// The Taylor series method.
#[derive(Clone, Debug)]
pub struct Taylor<const N: usize> {
    /// The order that is asked for; else it follows from the tolerance.
    asked: Option<usize>,
    /// The coefficients from the state at the start on, in units of `unit`; the order is one less than their number.
    series: Vec<SVector<f64, N>>,
    /// The work space of the series.
    rows: Vec<f64>,
    /// The unit of time of the coefficients, s: the step that was tried first.
    unit: f64,
    /// Whether the series is that of the present start.
    is_current: bool,
    /// What rounding has kept from the states.
    sum: CompensatedSum<f64, N>,
    /// The method that makes the step where the series is not of numbers, and whether it does.
    other: Bs5<N>,
    is_by_other: bool,
    /// The machine's vectors.
    pub(super) arch: Arch,
}

impl<const N: usize> Taylor<N> {
    /// The method, its order chosen by the relative tolerance.
    #[must_use]
    pub fn new() -> Self {
        Self {
            asked: None,
            series: Vec::new(),
            rows: Vec::new(),
            unit: 0.0,
            is_current: false,
            sum: CompensatedSum::new(),
            other: Bs5::new(),
            is_by_other: false,
            arch: Arch::new(),
        }
    }

    /// The method of the order `order`, from 2 to 30.
    #[must_use]
    pub fn of_order(order: usize) -> Self {
        Self { asked: Some(order.clamp(2, HIGHEST)), ..Self::new() }
    }

    /// The order.
    fn order(&self) -> usize {
        self.series.len() - 1
    }

    /// Expands the flow from `start` to the order that `relative` calls for, with the unit of time `h` (s). Without a
    /// series, which the driver refuses, the other method makes the step.
    #[inline(always)]
    fn expand(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, relative: f64) {
        let series = flow.series();
        self.is_current = true;
        self.is_by_other = series.is_none();
        let Some(series) = series else { return };
        let order = self.asked.unwrap_or_else(|| order_for(relative));
        self.series.resize(order + 1, SVector::zeros());
        self.rows.resize(order * series.width() + LINE - 1, 0.0);
        let first = self.rows.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE - 1);
        self.unit = h;
        self.series[0] = start.x;
        series.expand(start.t, h, &[], &mut self.rows[first..], &mut self.series);
    }

    /// At the part `theta` of the unit: the state less that at the start, and the slope of the series, in the state's unit.
    #[inline(always)]
    fn sums(&self, theta: f64) -> ([f64; N], [f64; N]) {
        let (mut change, mut slope) = ([0.0; N], [0.0; N]);
        for coefficients in self.series[1..].iter().rev() {
            for (i, coefficient) in coefficients.data.0[0].iter().enumerate() {
                let sum = change[i] + coefficient;
                slope[i] = slope[i] * theta + sum;
                change[i] = sum * theta;
            }
        }
        (change, slope)
    }

    /// The largest term of order `k` at the part `theta` of the unit; each state in parts of what is allowed, by `weights`.
    #[inline(always)]
    fn term(&self, k: usize, theta: f64, weights: &[f64; N]) -> f64 {
        let power = if theta == 1.0 { 1.0 } else { libm::pow(theta, k as f64) };
        power * largest::<f64, N>(&core::array::from_fn(|i| (self.series[k].data.0[0][i] * weights[i]).abs()))
    }

    /// The error of a step of the series of `h` (s) from `start`, in parts of the tolerances; infinite where there is none. The method
    /// begins anew after it.
    pub(super) fn error(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) -> f64 {
        let mut end = start.x;
        let norm = self.attempt(flow, start, h, scale, &mut end);
        self.restart();
        if self.is_by_other || !is_finite(&end) { f64::INFINITY } else { norm }
    }
}

/// The order for a relative tolerance, even: by measurement on the hacksaw, where two more or less cost some percent.
pub(super) fn order_for(relative: f64) -> usize {
    let half = libm::round(2.9 - 0.625 * libm::log10(relative));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 4 to 15")]
    let half = half.clamp(4.0, 15.0) as usize;
    2 * half
}

/// How far the defect may be above what is allowed. Of a smooth step it is a few times the error estimate at most, and
/// below a tolerance of 1e-11 what rounding makes of stiff forces.
fn slack(relative: f64) -> f64 {
    const SMOOTH: f64 = 16.0;
    const ROUNDING: f64 = 1e-11;
    if relative < ROUNDING { SMOOTH * ROUNDING / relative } else { SMOOTH }
}

impl<const N: usize> Default for Taylor<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Of a step that the other method makes, the norm is none.
impl<const N: usize> Vectorised<N> for Taylor<N> {
    #[inline(always)]
    fn attempt_inlined(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        if !self.is_current {
            self.expand(flow, start, h, scale.relative);
        }
        if self.is_by_other {
            return f64::NAN;
        }
        let theta = h / self.unit;
        let (change, slope) = self.sums(theta);
        let mut weights = [0.0; N];
        for i in 0..N {
            let from = start.x.data.0[0][i];
            let to = self.sum.add(i, from, change[i]);
            end.data.0[0][i] = to;
            weights[i] = 1.0 / scale.allowed_between(i, from, to);
        }
        // A coefficient that is no number leaves none at the end, so a step of numbers costs no more than this look.
        if !is_finite(end) && self.series.iter().any(|coefficients| !is_finite(coefficients)) {
            self.is_by_other = true;
            return f64::NAN;
        }
        let order = self.order();
        let (last, before) = (self.term(order, theta, &weights), self.term(order - 1, theta, &weights));
        // The power only matters where the term before the last is larger.
        let norm = if before > last {
            let before = libm::pow(before, order as f64 / (order - 1) as f64);
            if before > last { before } else { last }
        } else {
            last
        };
        if norm > 1.0 || norm.is_nan() {
            return norm;
        }
        let mut rate = SVector::zeros();
        rate_in(self.arch, flow, start.t + h, end, &mut rate);
        let unit = self.unit;
        let defect = theta
            * largest::<f64, N>(&core::array::from_fn(|i| ((unit * rate.data.0[0][i] - slope[i]) * weights[i]).abs()))
            / slack(scale.relative);
        if defect > 1.0 { defect } else { norm }
    }
}

impl<const N: usize> Method<N> for Taylor<N> {
    fn name(&self) -> &'static str {
        "Taylor"
    }

    fn control(&self) -> StepControl {
        if self.is_by_other {
            return self.other.control();
        }
        StepControl::Stabilised { order: if self.series.is_empty() { 16.0 } else { self.order() as f64 } }
    }

    fn needs_series(&self) -> bool {
        true
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let norm = attempt_in(self.arch, self, flow, start, h, scale, end);
        if self.is_by_other { self.other.attempt(flow, start, h, scale, end) } else { norm }
    }

    fn advance(&mut self) {
        self.is_current = false;
        if self.is_by_other {
            self.sum.restart();
        } else {
            self.sum.advance();
        }
    }

    fn restart(&mut self) {
        self.is_current = false;
        self.sum.restart();
    }

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        if self.is_by_other {
            return self.other.largest_error(start, scale, end);
        }
        let last = &self.series[self.order()];
        index_of_largest::<N>(|i| last[i].abs() / scale.allowed_between(i, start.x[i], end[i]))
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        if self.is_by_other {
            return self.other.faulty_rate();
        }
        self.series.iter().skip(1).find_map(first_not_finite)
    }

    fn prepare_dense(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        if self.is_by_other {
            self.other.prepare_dense(flow, start, h, end);
        }
    }

    /// Compiled once, not again for each choice of methods.
    #[inline(never)]
    fn dense(&self, start: &Point<N>, h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        if self.is_by_other {
            return self.other.dense(start, h, end, theta, x);
        }
        let (change, _) = self.sums(theta * h / self.unit);
        for (i, x) in x.iter_mut().enumerate() {
            *x = start.x[i] + change[i];
        }
    }
}
