use bg_model::input::Input;
use bond_graph_tests::models::rlc_circuit::{
    RlcCircuit, RlcCircuitInputs as Inputs, RlcCircuitParameters as Parameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{oscillator, within};

#[test]
fn the_capacitor_charges_as_the_closed_solution_says_ringing_or_creeping() {
    // Ringing below 2 sqrt(L / C) = 100 Ohm, creeping above.
    for resistance in [10.0, 300.0] {
        let p = Parameters { resistance, ..Parameters::default() };
        let voltage = 12.0;
        let model = RlcCircuit::new(p.clone(), Inputs { voltage: Input::constant(voltage) }).unwrap();
        let run = record(&model, &instants(0.03, 100), 1e-11);
        let full = p.capacitance * voltage;
        let truth = |t| oscillator(p.inductance, resistance, 1.0 / p.capacitance, (-full, 0.0), t);
        within("charge", run.deviation("charge", |t| full + truth(t).0) / full, 1e-9);
        within("current", run.deviation("current", |t| truth(t).1) / run.largest("current"), 1e-9);
        within("voltage", run.deviation("capacitor_voltage", |t| voltage + truth(t).0 / p.capacitance), 1e-8);
        within("energy", run.imbalance() / run.last("supplied"), 1e-9);
    }
}

#[test]
fn half_of_the_energy_that_charges_a_capacitor_is_lost_whatever_the_resistance() {
    for resistance in [60.0, 200.0] {
        let p = Parameters { resistance, ..Parameters::default() };
        let model = RlcCircuit::new(p, Inputs { voltage: Input::constant(12.0) }).unwrap();
        let run = record(&model, &instants(0.2, 10), 1e-11);
        within("half", (run.last("dissipated") / run.last("supplied") - 0.5).abs(), 1e-9);
    }
}
