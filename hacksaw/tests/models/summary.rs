//! What the summary says of a run of the hacksaw.

use bg_model::simulation::Column;
use bg_model::simulation::Recording;
use hacksaw::summary::{JOINTS, of_paper};
use serde_json::json;

#[test]
fn numbers_come_from_the_columns() {
    let names = ["stored_energy", "supplied_energy", "dissipated_energy", "crank_speed"];
    let columns = names.into_iter().chain(JOINTS.map(|(column, _)| column));
    let mut run = Recording::new(columns.map(|name| Column::new(name, "")).collect());
    run.push(0.0, [5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    run.push(2.0, [8.0, 4.0, 1.5, 40.0, 1e-4, 0.0, 3e-4, 0.0, 0.0]);
    run.push(3.0, [9.0, 10.0, 6.0, 60.0, 0.0, 0.0, 0.0, 2e-4, 0.0]);
    let (_, entries) = of_paper(&run).unwrap();
    let value = |key: &str| entries.iter().find(|entry| entry.key == key).unwrap().value.clone();
    assert_eq!(value("energy_residual_j"), 0.5);
    assert_eq!(value("energy_residual"), 0.05);
    assert_eq!(value("largest_gap"), json!(["pin B", 3e-4]));
    assert_eq!(value("crank_speed_rad_per_s"), json!([50.0, 40.0, 60.0]));
}

#[test]
fn a_scene_without_the_columns_has_no_lines_of_them() {
    let mut run = Recording::new(vec![Column::new("crank_angle", "rad")]);
    run.push(0.0, [0.0]);
    let (lines, entries) = of_paper(&run).unwrap();
    assert!(lines.is_empty());
    assert!(entries.iter().all(|entry| entry.value.is_null()));
}
