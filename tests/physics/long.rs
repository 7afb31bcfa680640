use bond_graph_tests::models::long::{Rope, RopeParameters, Whip, WhipParameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::within;

#[test]
fn rods_on_hinges_keep_power_and_joints() {
    let run = record(&Whip::new(WhipParameters::default()).unwrap(), &instants(0.5, 25), 1e-11);
    within("balance", run.imbalance(), 1e-8);
    let gap = run.vectors("gap").into_iter().flatten().fold(0.0_f64, |most, gap| most.max(gap.abs()));
    within("gap", gap, 1e-12);
    assert!(!run.events.is_empty(), "the motor reverses");
    let tips = run.vectors("tip");
    assert!(run.last("dissipated") > 0.05 && tips[25].iter().all(|of| of.abs() > 0.1), "{:?}", tips[25]);
}

#[test]
fn a_rope_keeps_power() {
    let run = record(&Rope::new(RopeParameters::default()).unwrap(), &instants(0.05, 5), 1e-11);
    within("balance", run.imbalance(), 1e-9);
    let tips = run.vectors("tip");
    assert!(run.last("dissipated") > 1e-3 && tips[5][1..].iter().all(|of| of.abs() > 1e-3), "{:?}", tips[5]);
}
