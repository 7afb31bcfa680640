use bond_graph_tests::models::contact::{SlidingBlock, SlidingBlockParameters};
use bond_graph_tests::support::record::record;

use super::truth::{turning_point, within};

#[test]
fn the_contact_resists_each_direction_with_its_own_law() {
    let p = SlidingBlockParameters::default();
    let turning = |count| turning_point(p.mass, p.stiffness, p.cut, p.back, 1.0, count);
    let times: Vec<f64> = (0..=5).map(|count| turning(count).0).collect();
    let run = record(&SlidingBlock::new(p.clone()).unwrap(), &times, 1e-12);
    for (count, x) in (0..).zip(run.series("x")) {
        within("turning point", (x - turning(count).1).abs(), 1e-9);
    }
    assert!(run.events.len() >= 4, "{:?}", run.events);
    for (event, time) in run.events.iter().zip(&times[1..]) {
        within("event", (event - time).abs(), 1e-9);
    }
    within("across", run.largest("across_y").max(run.largest("across_z")), 0.0);
    within("energy", run.imbalance(), 1e-9);
}
