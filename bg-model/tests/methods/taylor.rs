//! The Taylor series method: its orders, also with time in the rate, precision near rounding, dense output, what a
//! series cannot know, and systems without one.

use crate::problems::*;
use bg_model::capability::Series;
use bg_model::failure::{BadInput, Cause};
use bg_model::integrator::{Dop853, Method, Taylor};
use bg_model::nalgebra::SVector;
use bg_model::series;
use bg_model::simulation::{Samples, Settings, Span, integrate};
use bg_model::system::System;

/// One order of a system's series: from order `k`, the part of the unit at order 0 and 1 that time has, and the states'
/// coefficients to the rates' coefficients.
type Order<const N: usize, const W: usize> = fn(&mut [[f64; W]], usize, f64, &[f64; N]) -> [f64; N];

/// A system given by one order of its series; its rate is order 0. It has one switch, the sign of the first state, if
/// `G` is 1.
struct BySeries<const N: usize, const G: usize, const W: usize> {
    order: Order<N, W>,
}

impl<const N: usize, const G: usize, const W: usize> System<f64, N, G> for BySeries<N, G, W> {
    fn rate(&self, t: f64, x: &SVector<f64, N>, _: &[bool; G], dx: &mut SVector<f64, N>) {
        *dx = SVector::from((self.order)(&mut [[0.0; W]], 0, t, &x.data.0[0]));
    }
    fn guards(&self, _: f64, x: &SVector<f64, N>, _: &[bool; G], guards: &mut SVector<f64, G>) {
        guards.iter_mut().zip(x).for_each(|(guard, x)| *guard = *x);
    }
    fn series(&self) -> Option<&impl Series<f64, N, G>> {
        Some(self)
    }
}

impl<const N: usize, const G: usize, const W: usize> Series<f64, N, G> for BySeries<N, G, W> {
    fn width(&self) -> usize {
        W
    }
    fn expand(&self, t: f64, h: f64, _: &[bool; G], rows: &mut [f64], series: &mut [SVector<f64, N>]) {
        let rows = rows.as_chunks_mut::<W>().0;
        for k in 0..series.len() - 1 {
            let time = [t, h].get(k).copied().unwrap_or(0.0);
            let rate = (self.order)(rows, k, time, &series[k].data.0[0]);
            series[k + 1] = SVector::from(rate) * (h / (k + 1) as f64);
        }
    }
}

/// x' = x cos t.
fn growth() -> BySeries<1, 0, 5> {
    BySeries {
        order: |rows, k, t, x| {
            let cosine = series::cos(rows, k, 0, t);
            [series::product(rows, k, 3, x[0], cosine)]
        },
    }
}

/// See [`kepler`].
fn kepler_by_series() -> BySeries<4, 0, 10> {
    BySeries {
        order: |rows, k, _, x| {
            let square = series::product(rows, k, 0, x[0], x[0]) + series::product(rows, k, 2, x[1], x[1]);
            let pull = series::powf(rows, k, 4, square, -1.5);
            [x[2], x[3], -series::product(rows, k, 6, x[0], pull), -series::product(rows, k, 8, x[1], pull)]
        },
    }
}

/// A spring that is three times as stiff in tension, by an absolute value: a kink that is no switch.
fn kinked() -> BySeries<2, 0, 1> {
    BySeries { order: |rows, k, _, x| [x[1], -2.0 * x[0] - series::abs(rows, k, 0, x[0])] }
}

fn error_of_growth(method: Taylor, step: f64) -> f64 {
    let settings = Settings { first_step: Some(step), largest_step: step, ..settings(1.0) };
    let (finish, _) = run(&growth(), method, [1.0], 2.0, &settings);
    assert_eq!((finish.statistics.steps as f64, finish.statistics.rejected), (2.0 / step, 0));
    (finish.x[0] - libm::exp(libm::sin(2.0))).abs()
}

#[test]
fn it_has_the_order_that_is_asked_for() {
    for (order, step) in [(3_u8, 0.03125), (6, 0.125), (9, 0.25)] {
        let errors = [step, 0.5 * step].map(|step| error_of_growth(Taylor::of_order(order.into()), step));
        let observed = (errors[0] / errors[1]).log2();
        assert!((observed - f64::from(order)).abs() < 0.3, "{order}: {observed}");
    }
}

#[test]
fn kepler_is_exact_to_what_the_orbit_makes_of_rounding() {
    let error = |x: &SVector<f64, 4>| (x - SVector::from(KEPLER_AT_20)).norm();
    for (tolerance, allowed) in [(1e-6, 1e-4), (1e-10, 2e-9), (1e-13, 1e-11)] {
        let (finish, _) = run(&kepler_by_series(), Taylor::new(), kepler_start(), 20.0, &settings(tolerance));
        assert!(error(finish.state()) < allowed, "{tolerance:e}: {:e}", error(finish.state()));
        let (other, _) = run(&kepler_by_series(), Dop853::new(), kepler_start(), 20.0, &settings(tolerance));
        let orders = finish.statistics.series_orders;
        assert!(orders < 3 * other.statistics.rate_evaluations / 2, "{tolerance:e}: {orders}, {}", other.statistics);
    }
}

#[test]
fn the_dense_output_is_the_series() {
    let settings = Settings { samples: Samples::Every(0.01), ..settings(1e-10) };
    let (finish, record) = run(&growth(), Taylor::new(), [1.0], 6.0, &settings);
    assert!(finish.statistics.steps < 20 && finish.statistics.dense_evaluations == 0, "{}", finish.statistics);
    for (t, x, _) in &record.samples {
        assert!((x[0] - libm::exp(libm::sin(*t))).abs() < 1e-12, "{t}");
    }
}

#[test]
fn a_kink_that_is_no_switch_is_seen_by_the_defect() {
    // Half periods pi and pi / sqrt 3.
    let period = std::f64::consts::PI * (1.0 + 3.0_f64.sqrt().recip());
    for tolerance in [1e-4, 1e-8] {
        let (finish, _) = run(&kinked(), Taylor::new(), [0.0, 1.0], 2.0 * period, &settings(tolerance));
        let error = (finish.x - SVector::from([0.0, 1.0])).norm();
        // Where the steps fall about the kinks decides: with first steps of 0.1 to 1.3 times that it is up to 18 times.
        assert!(error < 20.0 * tolerance, "{tolerance:e}: {error:e}, {}", finish.statistics);
        assert!(finish.statistics.rejected > 4);
    }
}

#[test]
fn switchings_are_located_on_the_series() {
    // x'' = -x, told of each crossing of zero.
    let circle = BySeries::<2, 1, 1> { order: |_, _, _, x| [x[1], -x[0]] };
    let (finish, record) = run(&circle, Taylor::new(), [1.0, 0.0], 30.0, &settings(1e-10));
    assert_eq!(record.events.len(), 10);
    for (k, (t, ..)) in record.events.iter().enumerate() {
        let expected = std::f64::consts::PI * (k as f64 + 0.5);
        assert!((t - expected).abs() < 1e-13 * expected, "{k}: {t}");
    }
    assert!((finish.x - SVector::from([libm::cos(30.0), -libm::sin(30.0)])).norm() < 5e-13);
}

#[test]
fn a_rejected_step_takes_no_new_series() {
    let settings = Settings { first_step: Some(1.0), ..settings(1e-9) };
    let (finish, _) = run(&kepler_by_series(), Taylor::of_order(12), kepler_start(), 2.0, &settings);
    let statistics = finish.statistics;
    assert!(statistics.rejected > 3);
    assert_eq!(statistics.series_orders, 12 * statistics.steps);
}

#[test]
fn where_the_series_is_not_finite_another_method_makes_the_step() {
    // x' = 1 + sqrt x from rest: the rate is finite, its derivative is not. With u = sqrt x, t = 2 (u - ln(1 + u)).
    let root =
        BySeries::<1, 0, 1> { order: |rows, k, _, x| [series::constant(k, 1.0) + series::sqrt(rows, k, 0, x[0])] };
    for tolerance in [1e-4, 1e-8, 1e-11] {
        let settings = Settings { samples: Samples::Every(0.0625), ..settings(tolerance) };
        let (finish, record) = run(&root, Taylor::new(), [0.0], 1.0, &settings);
        for (t, x, _) in &record.samples {
            let u = x[0].sqrt();
            let error = (2.0 * (u - libm::log1p(u)) - t).abs();
            // The first step's estimate is less sharp than that of a smooth step.
            assert!(error < 30.0 * tolerance, "{tolerance:e}: {error:e} at {t}");
        }
        assert!(finish.statistics.steps < 100, "{tolerance:e}: {}", finish.statistics);
    }
    // At rest it stays at rest.
    let rest = BySeries::<1, 0, 1> { order: |rows, k, _, x| [-series::sqrt(rows, k, 0, x[0])] };
    let (finish, _) = run(&rest, Taylor::new(), [0.0], 1.0, &settings(1e-6));
    assert!(finish.x[0] == 0.0 && finish.statistics.steps < 30, "{}", finish.statistics);
}

#[test]
fn a_system_without_a_series_is_refused() {
    let span = Span { t0: 0.0, t_end: 1.0 };
    let mut recorder = Record::<4, 0>::default();
    let failure =
        integrate(&kepler(), &mut Taylor::new(), &kepler_start(), span, &settings(1e-6), &mut recorder).unwrap_err();
    assert_eq!(failure.cause, Cause::BadInput(BadInput::NoSeries { method: Method::name(&Taylor::new()) }));
    assert!(failure.to_string().starts_with("the integrator Taylor needs the system's Taylor series"), "{failure}");
}
