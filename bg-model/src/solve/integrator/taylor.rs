//! The Taylor series method: explicit, of any order.
//!
//! In: a flow with its Taylor series ([`System::series`](crate::system::System::series)). Out: the state at the end of
//! a step, its error estimate, and the series itself for what is in between. One series serves all attempts from its
//! start. Error estimate: the last two terms, the one before the last raised to the power with which it would fall like
//! the last (Jorba & Zou, A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods, Experimental Mathematics 14 (2005), section 3.2); and the defect at the end, which shows what the series
//! cannot know: a kink, or a jump, inside the step. Where there is no series, as at the zero of a square root, BS5
//! makes the step, which needs no derivative: its error estimate makes it short.

use alloc::vec::Vec;

use super::compensated::CompensatedSum;
use super::side_by_side::{OfEach, SIDE_BY_SIDE, for_each, put, some};
use super::tolerances::{index_of_largest, largest};
use super::vectors::{Vectorised, attempt_in};
use super::{Arch, Bs5, Flow, Method, PointRef, Scale, StepControl, first_not_finite, is_finite};

/// The highest order.
const HIGHEST: usize = 30;

/// Numbers in a line of the cache. The work space of a series begins with one, so that no vector lies across two.
const LINE: usize = 8;

/// The Taylor series method.
#[derive(Clone, Debug)]
pub struct Taylor {
    /// The order that is asked for; else it follows from the tolerance.
    asked: Option<usize>,
    /// The part of an error that counts.
    counted: f64,
    /// The coefficients from the state at the start on, order by order, in units of `unit`.
    series: Vec<f64>,
    /// The order of the series; 0 where there is none yet.
    order: usize,
    /// The work space of the series.
    rows: Vec<f64>,
    /// The unit of time of the coefficients, s: the step that was tried first.
    unit: f64,
    /// Whether the series is that of the present start.
    is_current: bool,
    /// What rounding has kept from the states.
    sum: CompensatedSum<f64, SIDE_BY_SIDE>,
    /// Of each state: its change in the step, its slope at the end, the weight of its error, an error or a rate.
    room: [Vec<f64>; 4],
    /// The method that makes the step where the series is not of numbers, and whether it does.
    other: Bs5,
    is_by_other: bool,
    /// The machine's vectors.
    pub(super) arch: Arch,
}

impl Taylor {
    /// The method, its order chosen by the relative tolerance.
    #[must_use]
    pub fn new() -> Self {
        Self {
            asked: None,
            counted: 1.0,
            series: Vec::new(),
            order: 0,
            rows: Vec::new(),
            unit: 0.0,
            is_current: false,
            sum: CompensatedSum::new(0),
            room: [const { Vec::new() }; 4],
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

    /// The method that errs by `1 / counted` times what the tolerances allow.
    pub(super) fn with_errors_counted(counted: f64) -> Self {
        Self { counted, ..Self::new() }
    }

    /// Expands the flow from `start` to the order that `relative` calls for, with the unit of time `h` (s). Without a
    /// series, which the driver refuses, the other method makes the step.
    #[inline(always)]
    fn expand(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, relative: f64) {
        let size = flow.series();
        self.is_current = true;
        self.is_by_other = size.is_none();
        let Some(size) = size else { return };
        self.order = self.asked.unwrap_or_else(|| order_for(relative));
        self.series.resize((self.order + 1) * start.x.len(), 0.0);
        self.rows.resize(self.order * size.width + LINE - 1, 0.0);
        let first = self.rows.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE - 1);
        self.unit = h;
        self.series[..start.x.len()].copy_from_slice(start.x);
        flow.expand(start.t, h, &mut self.rows[first..], &mut self.series);
    }

    /// The coefficients of order `k` of `n` states.
    #[inline(always)]
    fn coefficients(&self, k: usize, n: usize) -> &[f64] {
        &self.series[k * n..][..n]
    }

    /// The error of a step of the series of `h` (s) from `start`, in parts of the tolerances; infinite where there is
    /// none. The method begins anew after it. The state that the step leads to becomes `end`.
    pub(super) fn error(
        &mut self,
        flow: &Flow<'_>,
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        end: &mut [f64],
    ) -> f64 {
        end.copy_from_slice(start.x);
        let norm = self.attempt(flow, start, h, scale, end);
        self.restart();
        if self.is_by_other || !is_finite(end) { f64::INFINITY } else { norm }
    }
}

/// Of the `series` at the part `theta` of the unit: the state less that at the start, and the slope of the series, in
/// the state's unit.
struct Sums<'a> {
    series: &'a [f64],
    theta: f64,
    change: &'a mut [f64],
    slope: &'a mut [f64],
}

impl OfEach for Sums<'_> {
    const CAN_REPEAT: bool = true;

    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let n = self.change.len();
        let (mut change, mut slope) = ([0.0; W], [0.0; W]);
        for coefficients in self.series[n..].chunks_exact(n).rev() {
            let coefficients: [f64; W] = some(coefficients, first);
            for i in 0..W {
                let sum = change[i] + coefficients[i];
                slope[i] = slope[i] * self.theta + sum;
                change[i] = sum * self.theta;
            }
        }
        put(self.change, first, change);
        put(self.slope, first, slope);
    }
}

/// The largest of these coefficients of order `k`, each in parts of what is allowed, by `weights`, at the part `theta`
/// of the unit. `errors` is work space.
#[inline(always)]
fn term(k: usize, coefficients: &[f64], theta: f64, weights: &[f64], errors: &mut [f64]) -> f64 {
    let power = if theta == 1.0 { 1.0 } else { libm::pow(theta, k as f64) };
    for ((error, coefficient), weight) in errors.iter_mut().zip(coefficients).zip(weights) {
        *error = (coefficient * weight).abs();
    }
    power * largest(errors)
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

impl Default for Taylor {
    fn default() -> Self {
        Self::new()
    }
}

/// Of a step that the other method makes, the norm is none.
impl Vectorised for Taylor {
    #[inline(always)]
    fn attempt_inlined(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        if !self.is_current {
            self.expand(flow, start, h, scale.relative / self.counted);
        }
        if self.is_by_other {
            return f64::NAN;
        }
        let (theta, n, order, counted) = (h / self.unit, flow.states(), self.order, self.counted);
        let Self { series, room: [change, slope, weights, errors], sum, .. } = self;
        let (change, slope, weights, errors) = (&mut change[..n], &mut slope[..n], &mut weights[..n], &mut errors[..n]);
        for_each(n, &mut Sums { series, theta, change, slope });
        for i in 0..n {
            let from = start.x[i];
            let to = sum.add(i, from, change[i]);
            end[i] = to;
            weights[i] = counted / scale.allowed_between(i, from, to);
        }
        // A coefficient that is no number leaves none at the end, so a step of numbers costs no more than this look.
        if !is_finite(end) && !is_finite(series) {
            self.is_by_other = true;
            return f64::NAN;
        }
        let last = term(order, &series[order * n..][..n], theta, weights, errors);
        let before = term(order - 1, &series[(order - 1) * n..][..n], theta, weights, errors);
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
        let (rate, unit) = (errors, self.unit);
        flow.rate(start.t + h, end, rate);
        for i in 0..n {
            rate[i] = ((unit * rate[i] - slope[i]) * weights[i]).abs();
        }
        let defect = theta * largest(rate) / slack(scale.relative / counted);
        if defect > 1.0 { defect } else { norm }
    }
}

impl Method for Taylor {
    fn name(&self) -> &'static str {
        "Taylor"
    }

    fn control(&self) -> StepControl {
        if self.is_by_other {
            return self.other.control();
        }
        StepControl::Stabilised { order: if self.order == 0 { 16.0 } else { self.order as f64 } }
    }

    fn needs_series(&self) -> bool {
        true
    }

    fn fit(&mut self, states: usize) {
        if self.room[0].len() != states {
            self.sum = CompensatedSum::new(states);
            self.room.iter_mut().for_each(|room| room.resize(states, 0.0));
            self.other.fit(states);
        }
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
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

    fn largest_error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> usize {
        if self.is_by_other {
            return self.other.largest_error(start, scale, end);
        }
        let last = self.coefficients(self.order, end.len());
        index_of_largest(end.len(), |i| last[i].abs() / scale.allowed_between(i, start.x[i], end[i]))
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        if self.is_by_other {
            return self.other.faulty_rate();
        }
        let n = self.room[0].len();
        self.series.chunks_exact(n.max(1)).skip(1).find_map(first_not_finite)
    }

    fn prepare_dense(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>) {
        if self.is_by_other {
            self.other.prepare_dense(flow, start, h, end);
        }
    }

    fn prepare_samples(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>, scale: &Scale) {
        if self.is_by_other {
            self.other.prepare_samples(flow, start, h, end, scale);
        }
    }

    fn sample(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        if self.is_by_other {
            return self.other.sample(start, h, end, theta, x);
        }
        self.dense(start, h, end, theta, x);
    }

    fn dense(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        if self.is_by_other {
            return self.other.dense(start, h, end, theta, x);
        }
        let (n, theta) = (x.len(), theta * h / self.unit);
        x.fill(0.0);
        for coefficients in self.series[n..].chunks_exact(n.max(1)).rev() {
            x.iter_mut().zip(coefficients).for_each(|(change, coefficient)| *change = (*change + coefficient) * theta);
        }
        x.iter_mut().zip(start.x).for_each(|(x, start)| *x += start);
    }
}
