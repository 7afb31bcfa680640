//! Collocation methods: orders, dense output, counts, events.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::auto::{Swing, SwingParameters};
use crate::problems::*;
use bg_model::capability::Elimination;
use bg_model::dynamics::{Dynamics, Typed};
use bg_model::failure::Cause;
use bg_model::integrator::{self, Gauss6, Method, Point, Radau5, Radau9, Scale, Tolerances};
use bg_model::linear::Field;
use bg_model::nalgebra::{Complex, DVector, SVector};
use bg_model::simulation::{Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::values;

fn assert_orders(errors: &[f64], expected: std::ops::Range<f64>) {
    let found = orders(errors);
    assert!(found.iter().all(|order| expected.contains(order)), "{found:?}: {errors:?}");
}

/// A system given by a closure.
struct Free<F, const N: usize>(F);

impl<F: Fn(f64, &SVector<f64, N>) -> [f64; N], const N: usize> Dynamics for Free<F, N> {
    fn states(&self) -> usize {
        N
    }

    fn rate(&self, t: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        dx.copy_from_slice(&(self.0)(t, &SVector::from_column_slice(x)));
    }
}

/// The end of `steps` equal steps from t = 0 to `t_end`, whatever the error; each is tried twice, because a step tried
/// again after a success is solved to rounding.
fn even<M: Method, const N: usize>(
    rate: impl Fn(f64, &SVector<f64, N>) -> [f64; N],
    mut method: M,
    start: [f64; N],
    t_end: f64,
    steps: u32,
) -> SVector<f64, N> {
    let (system, mut statistics) = (Free::<_, N>(rate), Statistics::default());
    let flow = integrator::Flow::new(&system, &[], &mut statistics);
    let scales = [Tolerances::new(1.0, 1e10), Tolerances::new(1e-10, 1e-10)].map(|of| Scale::new(&of, N));
    let h = t_end / f64::from(steps);
    let mut point = Point::at(0.0, DVector::from_column_slice(&start));
    method.fit(N);
    method.restart();
    for step in 0..steps {
        point.t = f64::from(step) * h;
        flow.rate(point.t, point.x.as_slice(), point.rate.as_mut_slice());
        let mut end = point.x.clone();
        for scale in &scales {
            let error = method.attempt(&flow, point.borrowed(), h, scale, end.as_mut_slice());
            assert!(error.is_finite(), "step {step} of {steps}: {error}");
        }
        method.advance();
        point.x = end;
    }
    *values(point.x.as_slice())
}

/// The errors at t = 2 of x' = x cos t, x(0) = 1.
fn smooth_errors<M: Method>(method: impl Fn() -> M, steps: &[u32]) -> Vec<f64> {
    let rate = |t: f64, x: &SVector<f64, 1>| [x[0] * libm::cos(t)];
    let error = |steps: &u32| (even(rate, method(), [1.0], 2.0, *steps)[0] - libm::exp(libm::sin(2.0))).abs();
    steps.iter().map(error).collect()
}

#[test]
fn orders_with_time_in_the_rate() {
    assert_orders(&smooth_errors(Radau5::new, &[10, 20, 40]), 4.8..5.2);
    assert_orders(&smooth_errors(Radau9::new, &[4, 8]), 8.5..9.5);
    assert_orders(&smooth_errors(Gauss6::adaptive, &[10, 20, 40]), 5.9..6.1);
}

/// The errors at the end of one turn on a circle.
fn circle_errors<M: Method>(method: impl Fn() -> M, steps: &[u32]) -> Vec<f64> {
    let start = [1.0, 0.0, 0.0, 1.0];
    let rate = |t: f64, x: &SVector<f64, 4>| (kepler().rate)(t, x, &[]);
    let error = |steps: &u32| (even(rate, method(), start, 2.0 * PI, *steps) - SVector::from(start)).norm();
    steps.iter().map(error).collect()
}

#[test]
fn orders_on_a_nonlinear_system() {
    assert_orders(&circle_errors(Radau5::new, &[40, 80, 160]), 4.8..5.2);
    assert_orders(&circle_errors(Radau9::new, &[8, 16, 32]), 8.5..9.5);
    assert_orders(&circle_errors(Gauss6::adaptive, &[20, 40, 80]), 5.8..6.2);
}

/// The errors at t = 1 of Prothero and Robinson's x' = lambda (x - cos t) - sin t with lambda = -1e6: solution cos t
/// (Mathematics of Computation 28, 1974).
fn prothero_robinson<M: Method>(method: impl Fn() -> M, steps: &[u32]) -> Vec<f64> {
    let rate = |t: f64, x: &SVector<f64, 1>| [-1e6 * (x[0] - libm::cos(t)) - libm::sin(t)];
    let error = |steps: &u32| (even(rate, method(), [1.0], 1.0, *steps)[0] - 1.0_f64.cos()).abs();
    steps.iter().map(error).collect()
}

#[test]
fn order_reduction_on_a_stiff_problem() {
    // Radau keeps the order s of its stages, with an error divided by lambda h; Gauss about s, undivided.
    let errors = prothero_robinson(Radau5::new, &[4, 8, 16]);
    assert_orders(&errors, 2.8..3.3);
    assert!(errors[0] < 2e-10, "{errors:?}");
    let errors = prothero_robinson(Radau9::new, &[1, 2]);
    assert_orders(&errors, 4.5..5.5);
    assert!(errors[0] < 1e-10, "{errors:?}");
    let errors = prothero_robinson(Gauss6::adaptive, &[4, 8, 16]);
    assert_orders(&errors, 3.5..4.5);
    assert!(errors[0] > 1e-7, "{errors:?}");
}

/// The largest errors inside a single step of the oscillator.
fn dense_errors<M: Method>(method: impl Fn() -> M, steps: &[f64]) -> Vec<f64> {
    let system = smooth(|_, x: &SVector<f64, 2>, _: &[bool; 0]| [x[1], -x[0]]);
    let of = |step: &f64| {
        let settings = Settings {
            tolerances: Tolerances::new(1e-14, 1e9),
            first_step: Some(*step),
            samples: Samples::Every(step / 32.0),
            ..Settings::default()
        };
        let (finish, record) = run(&system, method(), [0.6, 0.8], *step, &settings);
        assert_eq!((finish.statistics.steps, record.samples.len()), (1, 33));
        let error = |(t, x, _): &(f64, SVector<f64, 2>, _)| {
            (x - SVector::from([0.6 * t.cos() + 0.8 * t.sin(), 0.8 * t.cos() - 0.6 * t.sin()])).norm()
        };
        record.samples.iter().map(error).fold(0.0, f64::max)
    };
    steps.iter().map(of).collect()
}

#[test]
fn the_dense_output_falls_with_one_power_more_than_there_are_stages() {
    // The system is linear, so the first correction is exact.
    assert_orders(&dense_errors(Radau5::new, &[0.4, 0.2, 0.1]), 3.8..4.2);
    assert_orders(&dense_errors(Radau9::new, &[0.8, 0.4, 0.2]), 5.7..6.3);
    assert_orders(&dense_errors(Gauss6::adaptive, &[0.4, 0.2, 0.1]), 3.8..4.2);
}

fn kepler_counts<M: Method>(method: M) -> Statistics {
    run(&kepler(), method, kepler_start(), 20.0, &settings(1e-9)).0.statistics
}

#[test]
fn counts_are_those_of_the_methods() {
    let counts = |of: Statistics| [of.steps, of.rejected, of.jacobian_evaluations, of.factorisations];
    // Pinned; to be renewed only with a reason.
    assert_eq!(counts(kepler_counts(Radau5::new())), [3149, 0, 64, 2848]);
    assert_eq!(counts(kepler_counts(Radau9::new())), [478, 3, 44, 927]);
    assert_eq!(counts(kepler_counts(Gauss6::adaptive())), [2496, 0, 17, 2222]);
}

#[test]
fn an_even_linear_run_takes_one_jacobian_and_one_factorisation() {
    let system = smooth(|_, x: &SVector<f64, 2>, _: &[bool; 0]| [x[1], -x[0]]);
    let (finish, _) = run(&system, Gauss6::new(0.125), [1.0, 0.0], 100.0, &settings(1e-9));
    let counts = finish.statistics;
    assert_eq!((counts.steps, counts.jacobian_evaluations, counts.factorisations), (800, 1, 2));
}

/// The errors over the tolerances at t = 20 on Kepler's orbit.
fn ratios<M: Method>(method: impl Fn() -> M, exponents: &[i32]) -> Vec<f64> {
    let of = |exponent: &i32| {
        let tolerance = 10.0_f64.powi(*exponent);
        let (finish, _) = run(&kepler(), method(), kepler_start(), 20.0, &settings(tolerance));
        (finish.x - SVector::from(KEPLER_AT_20)).norm() / tolerance
    };
    exponents.iter().map(of).collect()
}

#[test]
fn the_error_stays_below_the_tolerance_times_the_orbits_sensitivity() {
    // The estimate is of order s, the step of order 2 s - 1: errors fall faster than tolerances.
    let found = [
        ratios(Radau5::new, &[-4, -6, -8, -10]),
        ratios(Radau9::new, &[-4, -6, -8, -10]),
        ratios(Gauss6::adaptive, &[-4, -6, -8, -10]),
    ];
    assert!(found.iter().flatten().all(|ratio| (1e-3..20.0).contains(ratio)), "{found:?}");
}

/// The crossing times of [`bilinear`] from (1, 0): a quarter of a turn, then halves of both turns in alternation.
fn crossings(t_end: f64) -> Vec<f64> {
    let halves = [FRAC_PI_2, PI].into_iter().cycle();
    let times = halves.scan(FRAC_PI_2, |t, half| Some(std::mem::replace(t, *t + half)));
    times.take_while(|t| *t < t_end).collect()
}

/// The largest error of the crossing times at the given tolerance.
fn event_error<M: Method>(method: M, tolerance: f64) -> f64 {
    let (_, record) = run(&bilinear(), method, [1.0, 0.0], 30.0, &settings(tolerance));
    let exact = crossings(30.0);
    assert_eq!(record.events.len(), exact.len());
    assert!(record.events.iter().all(|(_, x, ..)| x[0].abs() <= 4.0 * f64::EPSILON), "{:?}", record.events);
    record.event_times().iter().zip(&exact).map(|(t, exact)| (t - exact).abs()).fold(0.0, f64::max)
}

#[test]
fn switch_times_have_the_integrations_accuracy() {
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let errors = [
            event_error(Radau5::new(), tolerance),
            event_error(Radau9::new(), tolerance),
            event_error(Gauss6::adaptive(), tolerance),
        ];
        assert!(errors.iter().all(|error| *error < 30.0 * tolerance), "{tolerance}: {errors:?}");
    }
    let error = event_error(Gauss6::new(0.01), 1.0);
    assert!(error < 1e-12, "{error}");
}

/// A stiff relaxation to t, from t = 0.5 on to 1 - t: the slow solutions are these lines themselves, so the switch at
/// 0.25 changes at 0.25 and 0.75.
fn sawtooth() -> Flow<Rate<1, 2>, 2> {
    let rate: Rate<1, 2> =
        |t, y, negative| [if negative[0] { 1e6 * (t - y[0]) + 1.0 } else { 1e6 * (1.0 - t - y[0]) - 1.0 }];
    switched([|t, _| t - 0.5, |_, y| y[0] - 0.25], rate)
}

#[test]
fn a_stiff_switching_system_is_located_to_rounding() {
    let check = |record: Record<1, 2>, x: f64| {
        let times = record.event_times();
        assert_eq!(times.len(), 3, "{times:?}");
        let errors = [times[0] - 0.25, times[1] - 0.5, times[2] - 0.75];
        assert!(errors.iter().all(|error| error.abs() < 1e-12), "{errors:?}");
        assert!(x.abs() < 1e-12, "{x}");
    };
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let (finish, record) = run(&sawtooth(), Radau5::new(), [0.0], 1.0, &settings(tolerance));
        check(record, finish.x[0]);
        let (finish, record) = run(&sawtooth(), Radau9::new(), [0.0], 1.0, &settings(tolerance));
        check(record, finish.x[0]);
    }
}

/// A mass that is pushed back with a constant force: an event a rounding error before the end of a fixed step leaves a
/// step of one rounding error, from whose polynomial nothing can be foreseen.
#[test]
fn a_sliver_of_a_step_does_not_spoil_the_next_one() {
    let system = switched([|_, x| x[0]], |_, x: &SVector<f64, 2>, negative: &[bool; 1]| {
        [x[1], if negative[0] { 1.0 } else { -1.0 }]
    });
    for step in [0.1, 0.05, 0.025, 0.0125] {
        let (finish, record) = run(&system, Gauss6::new(step), [0.5, 0.0], 20.0, &settings(1e-8));
        let exact = (0..10).map(|k| f64::from(1 + 2 * k));
        assert_eq!(record.events.len(), 10);
        for ((t, ..), exact) in record.events.iter().zip(exact) {
            assert!((t - exact).abs() < 1e-13, "{step}: {t} for {exact}; {}", finish.statistics);
        }
    }
}

#[test]
fn a_tiny_step_in_front_does_not_end_the_next_iteration_early() {
    // A pendulum on a stiff rod; the rate at which a tiny step converges says nothing about a long one.
    let rate = |_: f64, x: &SVector<f64, 4>| {
        let length = x[0].hypot(x[1]);
        let pull = 1e4 * (length - 1.0) / length;
        [x[2], x[3], -pull * x[0], -pull * x[1] - 9.81]
    };
    let (system, mut statistics) = (Free::<_, 4>(rate), Statistics::default());
    let flow = integrator::Flow::new(&system, &[], &mut statistics);
    let mut start = Point::at(0.0, DVector::from_column_slice(&[1.0, 0.0, 0.0, 1.0]));
    flow.rate(0.0, start.x.as_slice(), start.rate.as_mut_slice());
    let scale = Scale::new(&Tolerances::new(1e-4, 1e-4), 4);
    let mut method = Radau5::new();
    method.fit(4);
    let mut end_after = |steps: &[f64]| {
        method.restart();
        let mut end = start.x.clone();
        let attempt = |h: &f64| method.attempt(&flow, start.borrowed(), *h, &scale, end.as_mut_slice());
        let errors: Vec<f64> = steps.iter().map(attempt).collect();
        (end, errors)
    };
    let (tried, errors) = end_after(&[1e-6, 0.2, 0.05]);
    let (fresh, _) = end_after(&[0.05]);
    assert!(errors[0] < 1.0 && errors[1] > 1.0, "{errors:?}");
    assert!((&tried - &fresh).norm() < 1e-6, "{tried} {fresh}");
}

#[test]
fn samples_do_not_alter_the_steps_and_cost_no_rate() {
    let with = |samples| run(&kepler(), Radau5::new(), kepler_start(), 20.0, &Settings { samples, ..settings(1e-6) });
    let (plain, plain_record) = with(Samples::Steps);
    let (sampled, record) = with(Samples::Every(0.001));
    assert_eq!(plain.statistics.dense_evaluations, 0);
    assert_eq!((record.steps, sampled), (plain_record.steps, plain));
}

#[test]
fn a_pole_ends_the_run_and_keeps_the_last_state() {
    let system = smooth(|_, x: &SVector<f64, 1>, _: &[bool; 0]| [x[0] * x[0]]);
    let span = Span { t0: 0.0, t_end: 2.0 };
    let failure = integrate(&system, &mut Radau5::new(), &SVector::from([1.0]), span, &settings(1e-9), &mut ());
    let failure = failure.unwrap_err();
    assert!(matches!(failure.cause, Cause::StepTooSmall { .. } | Cause::NonFinite { .. }), "{failure}");
    assert!((failure.last.t - 1.0).abs() < 1e-6 && failure.last.x[0].is_finite(), "{failure}");
}

#[test]
fn a_fixed_step_that_does_not_converge_fails_at_once() {
    let system = smooth(|_, x: &SVector<f64, 1>, _: &[bool; 0]| [x[0] * x[0]]);
    let span = Span { t0: 0.0, t_end: 2.0 };
    let failure = integrate(&system, &mut Gauss6::new(0.4), &SVector::from([1.0]), span, &settings(1e-9), &mut ());
    let failure = failure.unwrap_err();
    assert!(failure.last.t < 1.0 && failure.last.statistics.rejected == 1, "{failure}");
}

/// The solution of (I - c J) y = b by the unrolled elimination and by the one in little code.
fn both_ways<F: Field<f64>, const N: usize>(model: &impl Elimination<f64, N>, c: F, entries: &[f64]) -> [[F; N]; 2] {
    let right = std::array::from_fn(|row| F::real(0.3 + row as f64));
    let mut factors = vec![F::real(f64::NAN); model.factors()];
    let [mut unrolled, mut compact] = [right; 2];
    assert!(model.eliminate(c, entries, &mut factors));
    model.substitute(&factors, &mut unrolled);
    factors.fill(F::real(f64::NAN));
    assert!(model.eliminate_compactly(c, entries, &mut factors));
    model.substitute_compactly(&factors, &mut compact);
    [unrolled, compact]
}

#[test]
fn eliminations_in_little_code_have_the_bits_of_unrolled_ones() {
    let model = Swing::new(SwingParameters::default()).unwrap();
    let over = Typed::model(&model);
    let (x, n) = ([0.3, -0.2, 0.7, -1.1], over.states());
    let (mut entries, mut slope) = (vec![f64::NAN; over.sparsity().len(n)], vec![f64::NAN; n]);
    over.jacobian(0.0, &x[..n], &[], &mut entries, &mut slope);
    for c in [1e-3, 0.2, 7.0] {
        let [unrolled, compact] = both_ways(&model, c, &entries);
        assert_eq!(unrolled.map(f64::to_bits), compact.map(f64::to_bits), "c = {c}");
        let bits = |of: [Complex<f64>; 4]| of.map(|of| [of.re.to_bits(), of.im.to_bits()]);
        let [unrolled, compact] = both_ways(&model, Complex::new(c, 0.4 * c), &entries).map(bits);
        assert_eq!(unrolled, compact, "c = {c}");
    }
}
