use bg_model::description::StateKind;
use bg_model::input::Input;
use bg_model::system::Model;
use bond_graph_tests::models::hydraulic_cylinder::{
    HydraulicCylinder, HydraulicCylinderInputs as Inputs, HydraulicCylinderParameters as Parameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{oscillator, root, within};

#[test]
fn it_comes_to_the_speed_at_which_pump_leakage_and_piston_balance() {
    let p = Parameters::default();
    let flow = 2e-4;
    let model = HydraulicCylinder::new(p.clone(), Inputs { pump_flow: Input::constant(flow) }).unwrap();
    let run = record(&model, &instants(4.0, 100), 1e-10);
    let leakage = |pressure: f64| p.discharge * p.orifice * (2.0 * pressure / p.density).sqrt();
    let speed = |pressure: f64| (pressure * p.area - p.load) / p.friction;
    let pressure = root(|pressure| leakage(pressure) + p.area * speed(pressure) - flow, 1e4, 1e8);
    within("pressure", (run.last("pressure") / pressure - 1.0).abs(), 1e-8);
    within("speed", (run.last("speed") / speed(pressure) - 1.0).abs(), 1e-8);
    within("leakage", (run.last("leakage") / leakage(pressure) - 1.0).abs(), 1e-8);
    within("energy", run.imbalance() / run.last("dissipated"), 1e-9);
    assert!(speed(pressure) > 0.0);
}

#[test]
fn without_leakage_the_oil_is_a_spring_under_the_load() {
    // m v' = p a - load - r v and (V / K) p' = q - a v: an oscillator in the piston's speed about q / a.
    let p = Parameters { orifice: 0.0, ..Parameters::default() };
    let flow = 2e-4;
    let model = HydraulicCylinder::new(p.clone(), Inputs { pump_flow: Input::constant(flow) }).unwrap();
    let run = record(&model, &instants(0.3, 100), 1e-11);
    let stiffness = p.area * p.area * p.bulk_modulus / p.volume;
    let steady = flow / p.area;
    // At the start v = 0 and m v' = 0: the oil carries the load.
    let truth = |t| steady + oscillator(p.mass, p.friction, stiffness, (-steady, 0.0), t).0;
    within("speed", run.deviation("speed", truth) / steady, 1e-9);
}

#[test]
fn the_throttle_switches_where_its_flow_becomes_laminar_or_turbulent() {
    let p = Parameters { load: 0.0, ..Parameters::default() };
    let transition = p.transition;
    let pump_flow = Input::function(|t| 1e-4 * (10.0 * t).cos());
    let model = HydraulicCylinder::new(p, Inputs { pump_flow }).unwrap();
    let run = record(&model, &instants(1.0, 2000), 1e-10);
    let level = |pressure: &f64| (*pressure >= -transition, *pressure >= transition);
    let levels: Vec<_> = run.series("pressure").iter().map(level).collect();
    let count = |a: bool, b: bool| usize::from(a != b);
    let changes: usize = levels.windows(2).map(|w| count(w[0].0, w[1].0) + count(w[0].1, w[1].1)).sum();
    assert!(changes >= 6, "{changes}");
    assert_eq!(run.events.len(), changes, "{:?}", run.events);
    within("energy", run.imbalance() / run.last("dissipated"), 1e-8);
    assert!(run.series("dissipated").windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn its_quantities_have_hydraulic_units() {
    let model = HydraulicCylinder::new(Parameters::default(), Inputs::default()).unwrap();
    let description = model.description();
    let bond = description.bonds.iter().find(|bond| bond.from == "pump").unwrap();
    assert_eq!((bond.effort, bond.flow), ("Pa", "m^3/s"));
    let bond = description.bonds.iter().find(|bond| bond.from == "piston").unwrap();
    assert_eq!((bond.effort, bond.flow), ("N", "m/s"));
    let oil = description.states.iter().find(|state| state.name == "oil.q").unwrap();
    assert_eq!((oil.unit, oil.kind), ("m^3", StateKind::Displacement(0)));
}
