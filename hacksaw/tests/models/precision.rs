//! What an error costs: true errors against the stored references and exact counts of some runs.
//!
//! Pinned; to be renewed only where an integrator, the step control or the generated code was meant to change.

use bg_model::integrator::Integrator;
use bg_model::simulation::Recording;
use bg_workbench::precision::measure::{self, Counts, Entry, Setting};
use hacksaw::command::program;
use hacksaw::precision::case::case;

fn tolerance(rtol: f64) -> Setting {
    Setting::Tolerance { rtol, atol: Some(0.1 * rtol) }
}

/// One run of the case called `name`.
fn measure(name: &str, method: Integrator, setting: Setting, reference: &Recording) -> Entry {
    measure::measure(&case(name), program().models(), method, setting, 1, reference).unwrap()
}

fn stored(name: &str) -> Recording {
    case(name).solve(program().models()).expect("a stored solution")
}

/// The largest pose error, m or rad, to two digits.
fn error(entry: &Entry) -> String {
    let poses = entry.errors.and_then(|errors| errors.poses).expect("the run reached its end");
    format!("{:.1e}", poses.largest)
}

/// Steps, rejected, rates, orders of series, Jacobians, factorisations, events.
fn counts(entry: &Entry) -> [u64; 7] {
    let Counts { steps, rejected, rates, orders, jacobians, factorisations, pivoted, events } = entry.counts;
    assert_eq!(pivoted, 0);
    [steps, rejected, rates, orders, jacobians, factorisations, events]
}

/// The first `rows` rows.
fn beginning(reference: &Recording, rows: usize) -> Recording {
    reference.at(&reference.times[..rows])
}

/// The errors and counts of these runs of the case called `name`, which a failure prints anew.
fn pinned<const RUNS: usize>(name: &str, expected: [(Integrator, f64, &str, [u64; 7]); RUNS]) {
    let reference = stored(name);
    let found = expected.map(|(method, rtol, ..)| {
        let entry = measure(name, method, tolerance(rtol), &reference);
        (method, rtol, error(&entry), counts(&entry))
    });
    assert_eq!(found, expected.map(|(method, rtol, error, counts)| (method, rtol, error.to_owned(), counts)));
}

#[test]
fn errors_and_counts_of_the_paper_are_pinned() {
    pinned(
        "paper",
        [
            (Integrator::Cfmr7, 1e-5, "2.2e-7", [17386, 6, 159_036, 0, 0, 0, 60]),
            (Integrator::Nystrom, 1e-5, "6.2e-8", [17251, 19, 162_631, 0, 0, 0, 60]),
            // Nystrom makes most of these steps.
            (Integrator::Auto, 1e-3, "5.2e-6", [9377, 69, 91_893, 0, 18, 27, 60]),
            (Integrator::Auto, 1e-6, "2.6e-7", [16770, 74, 185_033, 3828, 14, 21, 60]),
            (Integrator::Taylor, 1e-8, "2.0e-12", [12109, 58, 24466, 193_760, 0, 0, 60]),
        ],
    );
}

#[test]
fn errors_and_counts_with_rigid_joints_are_pinned() {
    pinned(
        "rigid",
        [
            // CFMR7osc makes these steps: where events are many, it matters that its attempts to locate one have fewer
            // rates.
            (Integrator::Auto, 1e-5, "5.4e-5", [1347, 253, 21162, 120, 3, 9, 96]),
            (Integrator::Auto, 1e-6, "8.1e-7", [1543, 280, 26449, 84, 4, 12, 96]),
        ],
    );
}

#[test]
fn errors_and_counts_of_a_stiff_motion_are_pinned() {
    pinned(
        "full-offset",
        [
            (Integrator::Auto, 1e-3, "3.4e-4", [25300, 547, 209_507, 0, 3200, 33, 58]),
            (Integrator::Ark5, 1e-4, "8.4e-5", [28136, 259, 229_559, 0, 3545, 0, 58]),
            (Integrator::Radau9, 1e-3, "3.4e-3", [2877, 404, 85412, 0, 2660, 9921, 58]),
        ],
    );
}

#[test]
fn the_error_is_proportional_to_the_tolerance_over_eight_decades() {
    let reference = beginning(&stored("paper"), 101);
    for exponent in [-4, -6, -8, -10, -12] {
        let rtol = 10.0_f64.powi(exponent);
        let entry = measure("paper", Integrator::Dop853, tolerance(rtol), &reference);
        let ratio = entry.errors.unwrap().poses.unwrap().largest / rtol;
        assert!((0.02..2.0).contains(&ratio), "1e{exponent}: {ratio}");
    }
}

#[test]
fn every_integrator_approaches_the_reference() {
    let reference = beginning(&stored("paper"), 21);
    for method in Integrator::ALL {
        let setting = if method.has_fixed_step() { Setting::Step(1e-5) } else { tolerance(1e-7) };
        let entry = measure("paper", method, setting, &reference);
        let poses = entry.errors.expect("the run reached its end").poses.unwrap();
        assert!(poses.largest < 1e-6, "{}: {:e}", method.name(), poses.largest);
    }
}
