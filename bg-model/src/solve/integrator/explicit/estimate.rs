//! The error norms of methods with two estimates, against their definitions.

use super::{BogackiShampine, Bs5, Dop853, DormandPrince, Row, Tableau};
use crate::model::dynamics::Dynamics;
use crate::solve::integrator::{Flow, Method, PointRef, Scale};
use crate::solve::statistics::Statistics;

/// A rate that depends on time only: stage i has the value at c_i h.
struct Clock<F>(F);

impl<F: Fn(f64) -> f64> Dynamics for Clock<F> {
    fn states(&self) -> usize {
        1
    }

    fn rate(&self, t: f64, _: &[f64], _: &[bool], dx: &mut [f64]) {
        dx[0] = (self.0)(t);
    }
}

/// An absolute tolerance of 1.
fn one(states: usize) -> Scale {
    let ones = vec![1.0; states];
    Scale { relative: 0.0, absolute: ones.clone(), coarsest: 1.0, growth: f64::INFINITY, weights: ones }
}

/// The norm of a step of size `h` (s) from 0 with an absolute tolerance of 1.
fn norm(mut method: impl Method, rate: impl Fn(f64) -> f64, h: f64) -> f64 {
    let at_start = [rate(0.0)];
    let start = PointRef { t: 0.0, x: &[0.0], rate: &at_start };
    method.fit(1);
    let (clock, mut statistics) = (Clock(rate), Statistics::default());
    method.attempt(&Flow::new(&clock, &[], &mut statistics), start, h, &one(1), &mut [0.0])
}

/// z' = `rate` z, of real and imaginary part.
struct Exponential {
    rate: [f64; 2],
}

impl Dynamics for Exponential {
    fn states(&self) -> usize {
        2
    }

    fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        let [real, imaginary] = self.rate;
        dx.copy_from_slice(&[real * x[0] - imaginary * x[1], imaginary * x[0] + real * x[1]]);
    }
}

/// What DOP853 says that a step of 1 s of z' = `rate` z from 1 errs by, what it errs by at its end and, at most,
/// inside.
fn estimated_and_true(rate: [f64; 2]) -> [f64; 3] {
    let (system, mut statistics) = (Exponential { rate }, Statistics::default());
    let flow = Flow::new(&system, &[], &mut statistics);
    let exact = |t: f64| {
        let (size, angle) = ((rate[0] * t).exp(), rate[1] * t);
        [size * angle.cos(), size * angle.sin()]
    };
    let off = |x: &[f64; 2], t: f64| (x[0] - exact(t)[0]).abs().max((x[1] - exact(t)[1]).abs());
    let (x, mut end, mut at_end) = ([1.0, 0.0], [0.0; 2], [0.0; 2]);
    let start = PointRef { t: 0.0, x: &x, rate: &rate };
    let mut method = Dop853::new();
    method.fit(2);
    let estimated = method.attempt(&flow, start, 1.0, &one(2), &mut end);
    system.rate(1.0, &end, &[], &mut at_end);
    let point = PointRef { t: 1.0, x: &end, rate: &at_end };
    method.prepare_dense(&flow, start, 1.0, point);
    let inside = (1..20).map(|k| f64::from(k) / 20.0).map(|theta| {
        let mut there = [0.0; 2];
        method.dense(start, 1.0, point, theta, &mut there);
        off(&there, theta)
    });
    let inside = inside.fold(0.0, f64::max);
    [estimated, off(&end, 1.0), inside]
}

/// The estimate of `dop853.f` is zero at a rate of -5.685 per step.
#[test]
fn the_estimate_of_dop853_holds_up_to_the_limit_of_stability() {
    let real = (5..=620).map(|k| [-f64::from(k) / 100.0, 0.0]);
    let oscillating = (1..=50).map(|k| [0.0, f64::from(k) / 10.0]);
    let damped = [-1.0, -3.0, -5.0].into_iter().flat_map(|rate| [0.5, 1.0, 2.0, 3.0].map(|swing| [rate, swing]));
    for rate in real.chain(oscillating).chain(damped) {
        let [estimated, at_end, inside] = estimated_and_true(rate);
        let rounding = 1e-14;
        assert!(at_end <= 1.01 * estimated + rounding, "{rate:?}: {at_end:e} for {estimated:e}");
        assert!(inside <= 30.0 * estimated + rounding, "{rate:?}: {inside:e} inside for {estimated:e}");
    }
}

/// The combination of the stages' rates.
fn combined<T: Tableau>(row: Row, rate: impl Fn(f64) -> f64, h: f64) -> f64 {
    row.iter().map(|(stage, weight)| weight * rate(T::C[*stage] * h)).sum()
}

/// Hairer, Norsett, Wanner, section II.10, equation (10.17), and `dop853.f`: h e5 e5 / sqrt(e5 e5 + 0.01 e3 e3), with
/// the larger of two differences of order 5.
#[test]
fn the_third_order_estimate_of_dop853_has_the_weight_of_a_hundredth() {
    let h = 0.7;
    for power in [7, 9] {
        let rate = |t: f64| t.powi(power);
        let fifths = [DormandPrince::ERROR, DormandPrince::OTHER_ERROR];
        let fifth = fifths.map(|row| combined::<DormandPrince>(row, rate, h).abs()).into_iter().fold(0.0, f64::max);
        let third = combined::<DormandPrince>(DormandPrince::B, rate, h)
            - combined::<DormandPrince>(DormandPrince::SECOND, rate, h);
        let expected = h * fifth * fifth / (fifth * fifth + 0.01 * third * third).sqrt();
        let found = norm(Dop853::new(), rate, h);
        assert!((found / expected - 1.0).abs() < 1e-9, "{power}: {found:e} for {expected:e}");
        // The second one matters here.
        assert!(third.abs() > 3.0 * fifth && expected < 0.98 * h * fifth, "{power}: {fifth:e} {third:e}");
    }
}

/// A rate that sets in after the last stage but the two at the end of the step is seen by the second estimate of BS5
/// only, and in full.
#[test]
fn the_late_estimate_of_bs5_counts_in_full() {
    let (h, from) = (0.5, 0.45);
    let rate = |t: f64| if t < from { 0.0 } else { 100.0 };
    let first = combined::<BogackiShampine>(BogackiShampine::ERROR, rate, h);
    let late = h * combined::<BogackiShampine>(BogackiShampine::LATE, rate, h).abs();
    assert!(first == 0.0 && late > 1e-3, "{first:e} {late:e}");
    assert_eq!(norm(Bs5::new(), rate, h), late);
    // Elsewhere the larger one counts.
    let smooth = |t: f64| t.powi(6);
    let both =
        [BogackiShampine::ERROR, BogackiShampine::LATE].map(|row| h * combined::<BogackiShampine>(row, smooth, h));
    let larger = both[0].abs().max(both[1].abs());
    assert!((norm(Bs5::new(), smooth, h) / larger - 1.0).abs() < 1e-9, "{both:?}");
}
