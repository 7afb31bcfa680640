use bond_graph_tests::models::sources::{
    ChargedCapacitor, ChargedCapacitorParameters, StiffnessAndCompliance, StiffnessAndComplianceParameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{oscillator, within};

#[test]
fn a_current_charges_a_leaky_capacitor_exponentially() {
    let p = ChargedCapacitorParameters::default();
    let run = record(&ChargedCapacitor::new(p.clone()).unwrap(), &instants(0.3, 50), 1e-11);
    let truth = |t: f64| p.current * p.resistance * (1.0 - (-t / (p.resistance * p.capacitance)).exp());
    within("voltage", run.deviation("voltage", truth), 1e-9);
    within("leak", run.deviation("leak_current", |t| truth(t) / p.resistance), 1e-10);
}

#[test]
fn a_compliance_is_the_reciprocal_of_its_stiffness() {
    let p = StiffnessAndComplianceParameters::default();
    let run = record(&StiffnessAndCompliance::new(p.clone()).unwrap(), &instants(2.0, 50), 1e-11);
    for name in ["first", "second"] {
        within(name, run.deviation(name, |t| oscillator(p.mass, 0.0, p.stiffness, (0.1, 0.0), t).0), 1e-10);
    }
}
