//! Long-term behaviour of conservative scenes, in short: what is kept, with which order it falls, how it grows.
//!
//! The scenes are in `cases`. `cargo bench -p bond-graph-tests --bench stability -- --only drift` runs 1e6 periods.

use bond_graph_tests::hardcases::integrator;
use bond_graph_tests::long_term::drift::{Drift, Exactness, drift};
use bond_graph_tests::long_term::scenes::{self, Scene};
use bond_graph_tests::long_term::sheets::order;

fn run(scene: &Scene, name: &str, exactness: Exactness, periods: f64) -> Drift {
    let found = drift(scene, integrator(name), exactness, periods);
    println!("{} by {name}, {exactness:?}: {} steps, {:?}", scene.name, found.statistics.steps, found.deviations);
    assert_eq!(found.failure, None, "{} by {name}", scene.name);
    found
}

/// The energy of an oscillator is a quadratic invariant, which Gauss keeps to rounding: 8e4 steps of 1e-16 each.
#[test]
fn gauss_keeps_quadratic_invariants_to_rounding() {
    let found = run(&scenes::oscillator(), "gauss6", Exactness::StepsPerPeriod(8.0), 1e4);
    assert!(found.energy().whole < 4e-12, "{:?}", found.energy());
}

/// The energy of the spring pendulum is no such invariant: its error falls with the sixth power of the step, and stays
/// the same from the first hundredth of the run on.
#[test]
fn gauss_keeps_other_energies_within_bounds() {
    let scene = scenes::spring_pendulum();
    let [coarse, fine] = [8.0, 16.0].map(|count| run(&scene, "gauss6", Exactness::StepsPerPeriod(count), 2e3));
    let (order, growth) = (order(&coarse, &fine), coarse.energy().growth());
    println!("order {order}, growth {growth}");
    assert!((5.8..6.2).contains(&order) && coarse.energy().whole < 2e-7);
    assert!(growth < 0.05, "{:?}", coarse.energy());
    let long = run(&scene, "gauss6", Exactness::StepsPerPeriod(8.0), 1e4);
    assert!(long.energy().whole < 1.2 * coarse.energy().whole, "{:?}", long.energy());
}

/// A method with error control, and one of fixed steps that is not symmetric, lose or gain energy linearly in time.
#[test]
fn other_methods_drift_linearly_and_with_their_order() {
    let scene = scenes::oscillator();
    let steps = [40.0, 80.0].map(Exactness::StepsPerPeriod);
    let tolerances = [1e-5, 1e-7].map(Exactness::Tolerance);
    for (name, exactnesses, periods, orders) in [
        ("rk4", steps, 100.0, 4.8..5.2),
        ("dop853", tolerances, 1e3, 7.5..9.5),
        ("radau9", tolerances, 200.0, 8.0..10.0),
    ] {
        let [coarse, fine] = exactnesses.map(|exactness| run(&scene, name, exactness, periods));
        let (order, growth) = (order(&coarse, &fine), coarse.energy().growth());
        println!("{name}: order {order}, growth {growth}");
        assert!(orders.contains(&order), "{name}: {order}");
        assert!((0.9..1.1).contains(&growth), "{name}: {:?}", coarse.energy());
    }
}

/// In space: the energy, the angular momentum, and orientations that stay rotations.
#[test]
fn scenes_in_space_keep_momentum_and_orthogonality() {
    for scene in [scenes::tumbling_body(), scenes::top(), scenes::rods()] {
        let by_gauss = run(&scene, "gauss6", Exactness::StepsPerPeriod(16.0), 100.0);
        assert!(by_gauss.energy().whole < 1e-12, "{}: {:?}", scene.name, by_gauss.energy());
        let by_default = run(&scene, "auto", Exactness::Tolerance(1e-9), 200.0);
        assert!(by_default.energy().whole < 1e-7, "{}: {:?}", scene.name, by_default.energy());
        for found in [by_gauss, by_default] {
            assert!(found.momentum().expect("it is kept").whole < 1e-12, "{}: {:?}", scene.name, found.deviations);
            assert!(found.orthogonality() < 2e-15, "{}: {:e}", scene.name, found.orthogonality());
        }
    }
}

#[test]
fn the_hacksaw_without_drive_work_and_dampers_keeps_its_energy() {
    let scene = scenes::hacksaw();
    for (name, exactness, periods, allowed) in [
        ("gauss6", Exactness::StepsPerPeriod(8.0), 100.0, 1e-11),
        ("rk4", Exactness::StepsPerPeriod(40.0), 1e3, 1e-9),
        ("dop853", Exactness::Tolerance(1e-9), 1e4, 1e-9),
    ] {
        let found = run(&scene, name, exactness, periods);
        assert!(found.energy().whole < allowed, "{name}: {:?}", found.energy());
        assert!(found.orthogonality() < 2e-15, "{name}: {:e}", found.orthogonality());
    }
}
