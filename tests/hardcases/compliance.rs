//! The 1/k law: what compliant joints lack of rigid ones halves as their stiffness doubles.

use bond_graph_tests::hardcases::andrews::{compliant_andrews, soft_squeezers};
use bond_graph_tests::hardcases::bodies::{compliant_heavy_top, soft_heavy_tops};
use bond_graph_tests::hardcases::case::Case;
use bond_graph_tests::hardcases::compliance::{Extrapolated, Law, law};
use bond_graph_tests::hardcases::integrator;
use bond_graph_tests::hardcases::pendulums::{
    compliant_double_pendulum, compliant_pendulum, soft_double_pendulums, soft_pendulums,
};
use bond_graph_tests::hardcases::slider_crank::{compliant_slider_crank, soft_slider_cranks};

/// `departure`: a bound of the softest joints', not ten times too large; `beyond`: a bound of the extrapolation's
/// error.
fn holds(case: Case, problems: &Extrapolated, departure: f64, beyond: f64) {
    for name in ["auto", "radau5"] {
        let found = law(&case, problems, integrator(name), 1e-7);
        let Law { departures: [soft, firm, stiff], .. } = found;
        println!("{} by {name}: {found:?}, ratios {:.4} {:.4}", case.name, soft / firm, firm / stiff);
        assert!(soft < departure && soft > 0.1 * departure, "{}: {soft:e}", case.name);
        // The next term of the series halves as well: 2 - soft / firm is twice 2 - firm / stiff.
        let (first, second) = (2.0 - soft / firm, 2.0 - firm / stiff);
        assert!(first.abs() < 0.2 && second.abs() < 0.1, "{}: {first:e} {second:e}", case.name);
        assert!((1.7..2.3).contains(&(first / second)), "{}: {first:e} {second:e}", case.name);
        assert!(found.beyond < beyond, "{}: {:e}", case.name, found.beyond);
    }
}

#[test]
fn the_pendulum() {
    holds(compliant_pendulum(), &soft_pendulums(), 1e-2, 3e-6);
}

#[test]
fn the_double_pendulum() {
    holds(compliant_double_pendulum(), &soft_double_pendulums(), 1e-2, 3e-6);
}

#[test]
fn the_slider_crank() {
    holds(compliant_slider_crank(), &soft_slider_cranks(), 1e-3, 3e-7);
}

#[test]
fn the_heavy_top() {
    holds(compliant_heavy_top().until(0.2), &soft_heavy_tops(), 1e-2, 3e-6);
}

#[test]
fn andrews_squeezer() {
    holds(compliant_andrews(), &soft_squeezers(), 1e-1, 1e-4);
}
