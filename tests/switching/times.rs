//! The times of events against the exact ones.

use std::fmt::Write;
use std::sync::OnceLock;

use bg_model::integrator::Integrator;
use bond_graph_tests::hardcases::integrators_of_rates;
use bond_graph_tests::switching::cases;

const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
/// An error up to this multiple of the tolerance, amplified, follows it.
const FOLLOWS: f64 = 100.0;
/// Errors below this are rounding: of times up to 50 s and of the states after up to 20 events.
const FLOOR: f64 = 3e-12;

/// The largest errors of a case's event times by an integrator, s: at the tolerances, or with steps of h to h / 8.
struct Row {
    case: &'static str,
    amplification: f64,
    integrator: Integrator,
    errors: [f64; 4],
}

/// All of them, run once.
fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let of_case = |case: bond_graph_tests::switching::case::Case| {
            integrators_of_rates().map(move |integrator| {
                let step = |column: usize| case.step / f64::from(1 << column);
                let errors = std::array::from_fn(|k| case.error(integrator, TOLERANCES[k], step(k)));
                Row { case: case.name, amplification: case.amplification, integrator, errors }
            })
        };
        cases().into_iter().flat_map(of_case).collect()
    })
}

/// The order of the method behind a fixed-step integrator.
fn order(integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Rk4 => 4.0,
        Integrator::Ros2 => 2.0,
        Integrator::Gauss6 => 6.0,
        other => panic!("{} has no fixed step", other.name()),
    }
}

/// The orders with which the errors fall, of those above rounding.
fn orders(errors: &[f64]) -> Vec<f64> {
    let pairs = errors.windows(2).filter(|pair| pair[1] > 10.0 * FLOOR);
    pairs.map(|pair| (pair[0] / pair[1]).log2()).collect()
}

#[test]
fn all_events_are_found_and_no_others() {
    for Row { case, integrator, errors, .. } in rows() {
        assert!(errors.iter().all(|error| error.is_finite()), "{case} by {}: {errors:?}", integrator.name());
    }
}

#[test]
fn where_the_method_is_exact_so_is_the_event() {
    let exact: Vec<&Row> = rows().iter().filter(|row| row.amplification == 0.0).collect();
    assert_eq!(exact.len(), 2 * integrators_of_rates().len());
    for Row { case, integrator, errors, .. } in exact {
        assert!(errors.iter().all(|error| *error <= FLOOR), "{case} by {}: {errors:?}", integrator.name());
    }
}

#[test]
fn event_times_follow_the_tolerance() {
    for Row { case, amplification, integrator, errors } in rows().iter().filter(|row| !row.integrator.has_fixed_step())
    {
        for (error, tolerance) in errors.iter().zip(TOLERANCES) {
            let bound = FLOOR.max(FOLLOWS * amplification * tolerance);
            assert!(*error <= bound, "{case} by {} at {tolerance:e}: {error:e}", integrator.name());
        }
    }
}

#[test]
fn event_times_of_fixed_steps_follow_the_order() {
    let mut count = 0;
    for Row { case, integrator, errors, .. } in rows().iter().filter(|row| row.integrator.has_fixed_step()) {
        let found = orders(errors);
        let mean = found.iter().sum::<f64>() / found.len() as f64;
        let expected = order(*integrator) - 0.6;
        assert!(found.is_empty() || mean > expected, "{case} by {}: {found:?}, {errors:?}", integrator.name());
        count += found.len();
    }
    assert!(count > 20, "orders were seen: {count}");
}

#[test]
fn a_table_of_event_times() {
    let mut text = String::from("largest error of an event time, s, at tolerances of 1e-4, 1e-6, 1e-8, 1e-10;\n");
    text += "of fixed steps, last in each table, with steps of h, h / 2, h / 4, h / 8\n";
    let shown = |error: &f64| if *error < FLOOR { format!("< {FLOOR:.0e}") } else { format!("{error:.1e}") };
    for case in cases() {
        let (name, events, source) = (case.name, case.events.len(), case.source);
        writeln!(text, "\n{name}, {events} events, h = {} s: {source}", case.step).expect("a string");
        for Row { integrator, errors, .. } in rows().iter().filter(|row| row.case == name) {
            let errors: String = errors.iter().map(|error| format!(" {:>8}", shown(error))).collect();
            writeln!(text, "{:<10}{errors}", integrator.name()).expect("a string");
        }
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("times", text));
}
