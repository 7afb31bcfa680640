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

/// The norm of a step of size `h` (s) from 0 with an absolute tolerance of 1.
fn norm(mut method: impl Method, rate: impl Fn(f64) -> f64, h: f64) -> f64 {
    let at_start = [rate(0.0)];
    let start = PointRef { t: 0.0, x: &[0.0], rate: &at_start };
    let scale = Scale { relative: 0.0, absolute: vec![1.0], coarsest: 1.0, growth: f64::INFINITY, weights: vec![1.0] };
    method.fit(1);
    let (clock, mut statistics) = (Clock(rate), Statistics::default());
    method.attempt(&Flow::new(&clock, &[], &mut statistics), start, h, &scale, &mut [0.0])
}

/// The combination of the stages' rates.
fn combined<T: Tableau>(row: Row, rate: impl Fn(f64) -> f64, h: f64) -> f64 {
    row.iter().map(|(stage, weight)| weight * rate(T::C[*stage] * h)).sum()
}

/// Hairer, Norsett, Wanner, section II.10, equation (10.17), and `dop853.f`: h e5 e5 / sqrt(e5 e5 + 0.01 e3 e3).
#[test]
fn the_third_order_estimate_of_dop853_has_the_weight_of_a_hundredth() {
    let h = 0.7;
    for power in [7, 9] {
        let rate = |t: f64| t.powi(power);
        let fifth = combined::<DormandPrince>(DormandPrince::ERROR, rate, h);
        let third = combined::<DormandPrince>(DormandPrince::B, rate, h)
            - combined::<DormandPrince>(DormandPrince::SECOND, rate, h);
        let expected = h * fifth * fifth / (fifth * fifth + 0.01 * third * third).sqrt();
        let found = norm(Dop853::new(), rate, h);
        assert!((found / expected - 1.0).abs() < 1e-9, "{power}: {found:e} for {expected:e}");
        // The second one matters here.
        assert!(third.abs() > 3.0 * fifth.abs() && expected < 0.98 * h * fifth.abs(), "{power}: {fifth:e} {third:e}");
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
