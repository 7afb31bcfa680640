//! The choice between an explicit, a partly implicit and an implicit method.

use crate::problems::*;
use bg_model::bond_graph;
use bg_model::integrator::{Auto, Cfmr7, Dop853, Integrator, Method, Radau9, Reason, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::run::{Simulation, Trajectory};
use bg_model::simulation::{Finish, Settings, Span, integrate};
use bg_model::system::Model;

/// Whether a method of this name is explicit.
fn is_explicit(name: &str) -> bool {
    ["DOP853", "CFMR7osc", "Nystrom", "Taylor"].contains(&name)
}

/// A run to `t_end` (s) from t = 0, and when which method took over.
fn chosen<const N: usize>(
    system: &Flow<Rate<N, 0>, 0>,
    start: [f64; N],
    t_end: f64,
) -> (Finish, Vec<(f64, &'static str)>) {
    let mut method = Auto::new();
    let span = Span { t0: 0.0, t_end };
    let finish = integrate(system, &mut method, &SVector::from(start), span, &settings(1e-6), &mut ()).unwrap();
    (finish, method.changes().iter().map(|change| (change.t, change.method)).collect())
}

#[test]
fn an_orbit_is_left_to_the_explicit_methods() {
    let (finish, changes) = chosen(&kepler(), kepler_start().data.0[0], 20.0);
    assert!(changes.iter().all(|(_, method)| is_explicit(method)), "{changes:?}");
    let (alone, _) = run(&kepler(), Dop853::new(), kepler_start(), 20.0, &settings(1e-6));
    assert!((&finish.x - &alone.x).amax() < 1e-4, "{:e}", (&finish.x - &alone.x).amax());
    assert!(finish.statistics.factorisations > 0, "the implicit method was tried");
}

/// An oscillator with a weak cubic spring: fast beside the time of a run.
fn oscillator() -> Flow<Rate<4, 0>, 0> {
    smooth(|t, x, _| [x[2], x[3], -x[0] * (1.0 + 0.01 * x[0] * x[0]), 0.01 * t.sin() - 0.25 * x[1]])
}

/// The rates of a run to `t_end` (s) with each method, and the explicit method that `auto` has at the end.
fn race(system: &Flow<Rate<4, 0>, 0>, t_end: f64, tolerance: f64) -> ([u64; 3], &'static str) {
    fn rates<M: Method>(system: &Flow<Rate<4, 0>, 0>, method: &mut M, t_end: f64, tolerance: f64) -> u64 {
        let span = Span { t0: 0.0, t_end };
        let finish = integrate(system, method, &kepler_start(), span, &settings(tolerance), &mut ()).unwrap();
        finish.statistics.rate_evaluations
    }
    let mut auto = Auto::new();
    let found = [
        rates(system, &mut auto, t_end, tolerance),
        rates(system, &mut Dop853::new(), t_end, tolerance),
        rates(system, &mut Cfmr7::new(), t_end, tolerance),
    ];
    (found, auto.changes().last().map_or("DOP853", |change| change.method))
}

#[test]
fn races_of_explicit_methods_cost_no_more_than_a_fiftieth() {
    // At 1e-6 both get as far on the orbit; elsewhere here DOP853 is ahead.
    for (system, t_end) in [(kepler(), 2000.0), (oscillator(), 5000.0)] {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let ([auto, dop853, cfmr7], last) = race(&system, t_end, tolerance);
            assert!(
                auto as f64 <= 1.02 * dop853.min(cfmr7) as f64,
                "{tolerance:e}: {auto}, {dop853} and {cfmr7} alone"
            );
            assert_eq!(last, "DOP853", "{tolerance:e}");
        }
    }
}

bond_graph! {
    /// Two masses on damped springs, one of which stiffens.
    pub graph Swing {
        param coupling: N/m = 25;
        param loss: N*s/m = 0.02;
        1 first: translation;
        1 second: translation;
        0 between: translation;
        I m1 = 1; I m2 = 0.7;
        C left(q) = 40 * q + 90 * q * q * q start 0.3;
        C right = coupling start -0.2;
        R damper = loss;
        first -> m1; first -> left; first -> damper;
        first -> between; between -> second; between -> right; second -> m2;
        observe { x: m = left.q; y: m = right.q }
    }
}

/// The methods of a run of the masses to 100 s, at a relative tolerance.
fn methods_of_swing(tolerance: f64) -> Vec<&'static str> {
    let (model, mut method) = (Swing::new(SwingParameters::default()).unwrap(), Auto::new());
    let span = Span { t0: 0.0, t_end: 100.0 };
    integrate(&model, &mut method, &model.start().unwrap(), span, &settings(tolerance), &mut ()).unwrap();
    method.changes().iter().map(|change| change.method).collect()
}

#[test]
fn taylor_series_take_over_where_they_get_further_with_their_price() {
    for tolerance in [1e-9, 1e-12] {
        assert_eq!(methods_of_swing(tolerance), ["Taylor"], "{tolerance:e}");
    }
    for tolerance in [1e-2, 1e-4] {
        assert!(!methods_of_swing(tolerance).contains(&"Taylor"), "{tolerance:e}");
    }
}

#[test]
fn a_stiff_equation_is_handed_over_and_its_fast_parts_are_taken_back() {
    let (finish, changes) = chosen(&van_der_pol(), VAN_DER_POL_START, 2.0);
    assert!((finish.x[0] - VAN_DER_POL_AT_2[0]).abs() < 1e-5, "{:?}", finish.x);
    assert_eq!(changes[0].1, "Radau IIA 9");
    assert!(changes[0].0 < 0.01, "{changes:?}");
    // An explicit method alone would need a step each 1e-6 s or so.
    assert!(finish.statistics.steps < 10_000, "{}", finish.statistics);
}

#[test]
fn a_slow_approach_to_rest_stays_with_the_implicit_method() {
    // A fast decay beside a slow one: at the end nothing moves and an explicit step may pass by luck.
    let rate: Rate<2, 0> = |_, x, _| [-1e6 * (x[0] - x[1]), -x[1]];
    let (finish, changes) = chosen(&smooth(rate), [1.0, 1.0], 30.0);
    let (alone, _) = run(&smooth(rate), Radau9::new(), [1.0, 1.0], 30.0, &settings(1e-6));
    assert!(finish.statistics.steps < 10 * alone.statistics.steps + 1000, "{} {changes:?}", finish.statistics);
}

/// Twenty masses in a row on springs, and strong dampers between the first three: momenta, then displacements.
fn row(t: f64, x: &SVector<f64, 40>, _: &[bool; 0]) -> [f64; 40] {
    let force = |i: usize| (if i < 2 { 1e7 } else { 0.1 }) * (x[i + 1] - x[i]) + 2000.0 * (x[21 + i] - x[20 + i]);
    std::array::from_fn(|k| match k {
        0 => force(0) - 2000.0 * x[20],
        19 => t.sin() - force(18),
        1..19 => force(k) - force(k - 1),
        _ => x[k - 20],
    })
}

#[test]
fn strong_dampers_in_few_of_many_states_are_handed_over_to_the_method_that_is_implicit_in_these() {
    let start: [f64; 40] = std::array::from_fn(|k| if k < 20 { 0.0 } else { 0.01 * ((k - 20) as f64).sin() });
    let (finish, changes) = chosen(&smooth(row as Rate<40, 0>), start, 5.0);
    assert_eq!(changes.iter().map(|(_, method)| *method).collect::<Vec<_>>(), ["ARK5(4)8L[2]SAb"], "{changes:?}");
    let (exact, _) = run(&smooth(row), Radau9::new(), start, 5.0, &settings(1e-12));
    assert!((&finish.x - &exact.x).amax() < 1e-5, "{:e}", (&finish.x - &exact.x).amax());
    // Below 1e-10 `Ark5` is not tried.
    let mut tight = Auto::new();
    let span = Span { t0: 0.0, t_end: 0.2 };
    integrate(&smooth(row), &mut tight, &SVector::from(start), span, &settings(1e-11), &mut ()).unwrap();
    assert!(tight.changes().iter().all(|change| change.method == "Radau IIA 9"), "{:?}", tight.changes());
    assert!(!tight.changes().is_empty());
}

/// What made the longest part of a run begins the next one, which has no trials then and ends where the other does; a
/// method that needs what the system lacks is no hint.
#[test]
fn a_run_begins_with_what_won_before() {
    let model = Swing::new(SwingParameters::default()).unwrap();
    let asked = || Simulation::new(&model).rtol(1e-9).until(100.0);
    let first = asked().run().unwrap();
    assert_eq!((first.methods.len(), first.hint()), (2, Some(Integrator::Taylor)), "{:?}", first.methods);
    let next = asked().hint(Integrator::Taylor).run().unwrap();
    let methods = |run: &Trajectory| run.methods.iter().map(|change| (change.t, change.method)).collect::<Vec<_>>();
    assert_eq!(methods(&next), [(0.0, "Taylor")]);
    assert!(next.statistics.factorisations == 0 && first.statistics.factorisations > 0, "{}", next.statistics);
    let at_end = |run: &Trajectory| *run["x"].last().unwrap();
    assert!((at_end(&next) - at_end(&first)).abs() < 1e-7, "{} {}", at_end(&next), at_end(&first));
    let again = asked().hint(Integrator::Taylor).run().unwrap();
    assert_eq!((&again["x"], &again.times), (&next["x"], &next.times));
    assert_eq!(asked().method(Integrator::Dop853).run().unwrap().hint(), None);

    let start = SVector::from(VAN_DER_POL_START);
    for (hint, begins) in [(Integrator::Radau9, "Radau IIA 9"), (Integrator::Taylor, "DOP853")] {
        let mut method = Auto::beginning_with(hint);
        let span = Span { t0: 0.0, t_end: 1e-3 };
        let finish = integrate(&van_der_pol(), &mut method, &start, span, &settings(1e-6), &mut ()).unwrap();
        assert!(finish.statistics.steps < 100 || begins == "DOP853", "{}", finish.statistics);
        let first = method.changes().first().map(|change| (change.method, change.reason));
        assert_eq!(first, (begins == "DOP853").then_some((begins, Reason::First)), "{hint}");
    }
}

/// A mass that swings fast and lightly damped under a load that a switch reverses at regular times: the ringing has to
/// be followed, however short a step is that an event or the end of the run leaves.
fn ringing() -> Flow<Rate<2, 1>, 1> {
    let guards: [fn(f64, &[f64]) -> f64; 1] = [|t, _| (40.0 * t).sin()];
    let rate: Rate<2, 1> = |_, x, negative| {
        let load = if negative[0] { 1.0 } else { -1.0 };
        [x[1], -1e6 * x[0] - x[1] + load]
    };
    switched(guards, rate)
}

#[test]
fn steps_cut_by_events_or_by_the_end_are_no_measure_of_stiffness() {
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-6] {
        for t_end in [1.0, 1.000_01, 1.1, 1.234_567] {
            let mut method = Auto::new();
            let span = Span { t0: 0.0, t_end };
            let start = SVector::from([1e-3, 0.0]);
            let mut settings = settings(tolerance);
            settings.tolerances = Tolerances::new(tolerance, 1e-6 * tolerance);
            integrate(&ringing(), &mut method, &start, span, &settings, &mut ()).unwrap();
            let changes = method.changes();
            assert!(changes.iter().all(|change| is_explicit(change.method)), "{tolerance} to {t_end}: {changes:?}");
        }
    }
}

#[test]
fn steps_that_rounding_shortens_are_no_stiffness_and_are_counted() {
    // A stiff, nearly undamped joint between two masses that are far from the origin: its force is the difference of
    // two states of 1, so rounding of them is 2e-9 of it.
    let rate: Rate<4, 0> = |_, x, _| {
        let force = 1e8 * (x[0] - x[1]);
        [x[2], x[3], -force, force]
    };
    let steps = |tolerance: f64| {
        let mut method = Auto::new();
        let settings = Settings { tolerances: Tolerances::new(tolerance, 1e-4 * tolerance), ..Settings::default() };
        let start = SVector::from([1.0, 1.0 + 1e-7, 0.0, 0.0]);
        let finish =
            integrate(&smooth(rate), &mut method, &start, Span { t0: 0.0, t_end: 2e-4 }, &settings, &mut ()).unwrap();
        let explicit = ["DOP853", "CFMR7osc"];
        assert!(
            method.changes().iter().all(|change| explicit.contains(&change.method)),
            "{tolerance}: {:?}",
            method.changes()
        );
        finish.statistics
    };
    let (loose, tight) = (steps(1e-8), steps(1e-12));
    assert_eq!(loose.rounded, 0);
    assert!(!loose.is_at_rounding() && tight.is_at_rounding(), "{tight}");
}

#[test]
fn an_explicit_step_without_a_number_is_no_success() {
    // A stiff law of a root: an explicit step as long as the implicit ones ends beyond its range, in no number.
    let rate: Rate<2, 0> = |t, x, _| [-1e8 * (x[0].sqrt() - x[1]), 0.5 * t.cos()];
    let (finish, changes) = chosen(&smooth(rate), [1.0, 1.0], 30.0);
    assert_eq!(changes.len(), 1, "{changes:?}");
    assert!((finish.x[0] - (1.0 + 0.5 * 30.0_f64.sin()).powi(2)).abs() < 1e-5, "{:?}", finish.x);
}

#[test]
fn a_law_too_stiff_for_a_single_explicit_step_is_handed_over() {
    for stiffness in [1e20, 1e60] {
        let rate = move |t: f64, x: &SVector<f64, 1>, _: &[bool; 0]| [-stiffness * (x[0] - t.cos())];
        let mut method = Auto::new();
        let span = Span { t0: 0.0, t_end: 1.0 };
        let finish =
            integrate(&smooth(rate), &mut method, &SVector::from([1.0]), span, &settings(1e-6), &mut ()).unwrap();
        assert!((finish.x[0] - 1.0_f64.cos()).abs() < 1e-6, "{stiffness}: {:?}", finish.x);
        assert_eq!(method.changes().len(), 1, "{stiffness}: {:?}", method.changes());
    }
}

#[test]
fn explicit_steps_at_the_limit_of_stability_that_switch_each_time_are_left() {
    // A stiff resistance whose coefficient depends on the sign of the flow, which alternates where a step is too long.
    let guards: [fn(f64, &[f64]) -> f64; 1] = [|_, x| x[0]];
    let rate: Rate<2, 1> = |t, x, negative| {
        let resistance = if negative[0] { 1e12 } else { 5e11 };
        [-resistance * x[0] + (3.0 * t).sin(), -x[1] + x[0]]
    };
    let mut method = Auto::new();
    let span = Span { t0: 0.0, t_end: 2.0 };
    let limited = Settings { step_limit: 20_000, ..settings(1e-6) };
    let start = SVector::from([1.0, 1.0]);
    let finish = integrate(&switched(guards, rate), &mut method, &start, span, &limited, &mut ()).unwrap();
    assert!((finish.x[1] - (-2.0_f64).exp()).abs() < 1e-5, "{:?}", finish.x);
    assert_eq!(method.changes().len(), 1, "{:?}", method.changes());
}
