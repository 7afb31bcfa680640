//! A graph in a file of its own, which the program `bond` takes as well.

use bg_model::bond_graph;
use bg_model::run::Simulation;

bond_graph!(file "tests/accepted/coil.bond");
bond_graph!(file "tests/accepted/flywheel.bond");

#[test]
fn a_file_has_a_graph_as_a_call_has() {
    let model = Coil::new(CoilParameters { inductance: 0.5 }).expect("a coil");
    let run = Simulation::new(&model).every(1.0).until(1.0).run().expect("a run");
    // L di/dt = 2 V.
    assert!((run["current"][1] - 4.0).abs() < 1e-12);
}

#[test]
fn a_file_has_parts_of_another() {
    let model = Flywheel::new(FlywheelParameters {}).expect("a flywheel");
    let run = Simulation::new(&model).every(1.0).until(1.0).run().expect("a run");
    // J dw/dt = 2 N*m.
    assert!((run["shaft.speed"][1] - 0.5).abs() < 1e-12);
}
