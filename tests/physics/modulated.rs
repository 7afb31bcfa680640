use bond_graph_tests::models::modulated::{
    ModulatedGyrator, ModulatedGyratorParameters, ModulatedLever, ModulatedLeverParameters, ModulatedResistance,
    ModulatedResistanceParameters, ModulatedSources, ModulatedSourcesParameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{oscillator, within};

#[test]
fn a_modulated_gyrator_turns_two_momenta_by_the_integral_of_its_modulus() {
    let p = ModulatedGyratorParameters::default();
    let run = record(&ModulatedGyrator::new(p.clone()).unwrap(), &instants(6.0, 100), 1e-11);
    let scale = (p.first * p.second).sqrt();
    let angle = |t: f64| p.modulus * (p.frequency * t).sin() / p.frequency / scale;
    within("a", run.deviation("a", |t| angle(t).cos()), 1e-9);
    within("b", run.deviation("b", |t| angle(t).sin() * (p.second / p.first).sqrt()), 1e-9);
    within("energy", run.drift("stored"), 1e-10);
}

#[test]
fn a_modulated_lever_turns_momentum_into_stretch_by_the_integral_of_its_ratio() {
    let p = ModulatedLeverParameters::default();
    let run = record(&ModulatedLever::new(p.clone()).unwrap(), &instants(6.0, 100), 1e-11);
    let angle = |t: f64| p.ratio * (p.frequency * t).sin() / p.frequency * (p.stiffness / p.mass).sqrt();
    within("p", run.deviation("p", |t| angle(t).cos()), 1e-9);
    within("q", run.deviation("q", |t| angle(t).sin() / (p.mass * p.stiffness).sqrt()), 1e-9);
    within("energy", run.drift("stored"), 1e-10);
}

#[test]
fn a_modulated_resistance_empties_a_coil_by_its_integral() {
    let p = ModulatedResistanceParameters::default();
    let run = record(&ModulatedResistance::new(p.clone()).unwrap(), &instants(2.0, 100), 1e-11);
    let integral = |t: f64| p.resistance * (t + 0.5 * (1.0 - (p.frequency * t).cos()) / p.frequency);
    let flux = |t: f64| (-integral(t) / p.inductance).exp();
    within("flux", run.deviation("flux", flux), 1e-10);
    within("lost", run.deviation("lost", |t| 0.5 * (1.0 - flux(t).powi(2)) / p.inductance), 1e-9);
}

#[test]
fn modulated_sources_feed_states_back() {
    let p = ModulatedSourcesParameters::default();
    let run = record(&ModulatedSources::new(p.clone()).unwrap(), &instants(3.0, 100), 1e-11);
    let truth = |t| oscillator(p.mass, 0.0, p.stiffness + p.gain, (0.2, 0.0), t).0;
    within("x", run.deviation("x", truth), 1e-9);
    within("charge", run.deviation("charge", |t| 0.5 * (-p.conductance / p.capacitance * t).exp()), 1e-10);
    within("energy", run.imbalance(), 1e-9);
}
