//! Hard cases: published problems on which integrators break, each with the reference it is held against.
//!
//! In: nothing. Out: [`cases`], to be run with any integrator at any tolerance; tables of the results
//! ([`report`]); the orders observed on a stiff joint ([`orders`]). The suite `hardcases` and the bench `stability` use
//! them. Reference values are copied here with their source; nothing is read at run time.

pub mod andrews;
pub mod bodies;
pub mod case;
pub mod compliance;
pub mod kinetics;
pub mod orbits;
pub mod orders;
pub mod pendulums;
pub mod pollution;
pub mod problem;
pub mod report;
pub mod ring_modulator;
pub mod sheet;
pub mod singular;
pub mod slider_crank;

use bg_model::integrator::Integrator;
use bg_model::nalgebra::SVector;

use case::Case;

/// References from numbers.
const QUAD: &str = "Radau IIA of orders 13 and 17 in quad precision, two runs";
/// References from formulas.
const CLOSED: &str = "the solution in closed form";

/// Integrators for stiff cases.
const STIFF: &[&str] = &["auto", "rodas5p", "radau5"];
/// Integrators for cases that are not stiff.
const EXPLICIT: &[&str] = &["auto", "dop853"];

/// All cases, from the easiest dimension on.
#[must_use]
pub fn cases() -> Vec<Case> {
    vec![
        singular::van_der_pol(),
        kinetics::robertson(),
        kinetics::hires(),
        kinetics::e5(),
        kinetics::oregonator(),
        pollution::pollution(),
        ring_modulator::ring_modulator(),
        singular::prothero_robinson(),
        singular::kaps(),
        singular::kpr(),
        pendulums::spring_pendulum_1e4(),
        pendulums::spring_pendulum_1e6(),
        pendulums::excited_spring_pendulum(),
        bodies::heavy_top(),
        bodies::compliant_heavy_top(),
        bodies::free_body(),
        bodies::dzhanibekov(),
        bodies::long_dzhanibekov(),
        orbits::kepler(),
        orbits::arenstorf(),
        slider_crank::slider_crank(),
        slider_crank::compliant_slider_crank(),
        andrews::andrews(),
        andrews::ringing_andrews(),
        andrews::damped_andrews(),
        andrews::compliant_andrews(),
        pendulums::pendulum(),
        pendulums::compliant_pendulum(),
        pendulums::double_pendulum(),
        pendulums::compliant_double_pendulum(),
        singular::stiff_joint(),
    ]
}

/// The cases in a form that suits a suite of tests: one of them is shortened.
#[must_use]
pub fn short_cases() -> Vec<Case> {
    let shorten = |case: Case| if case.name == "ring-modulator" { case.until(2.5e-4) } else { case };
    cases().into_iter().map(shorten).collect()
}

/// All integrators by the names that the command line knows.
#[must_use]
pub fn integrators() -> &'static [Integrator] {
    &Integrator::ALL
}

/// Those of them that need nothing of a system but its rate.
pub fn integrators_of_rates() -> impl ExactSizeIterator<Item = Integrator> + Clone {
    let found: Vec<Integrator> =
        integrators().iter().copied().filter(|integrator| !integrator.needs_series()).collect();
    found.into_iter()
}

/// The integrator `name`.
///
/// # Panics
/// There is none.
#[must_use]
pub fn integrator(name: &str) -> Integrator {
    name.parse().unwrap_or_else(|unknown| panic!("{unknown}"))
}

/// Writes the Jacobian with these rows of a system that does not depend on time.
fn dense<const N: usize>(rows: [[f64; N]; N], entries: &mut [f64], slope: &mut SVector<f64, N>) {
    for (i, row) in rows.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            entries[j * N + i] = *entry;
        }
    }
    slope.fill(0.0);
}
