//! Andrews' squeezer on bushings: the crank's angle at every stiffness and damping that there is a reference for.

use bond_graph_tests::hardcases::andrews::{ON_BUSHINGS, bushings};
use bond_graph_tests::hardcases::integrator;

#[test]
fn the_crank_turns_as_far_as_it_should_on_all_bushings() {
    for line in ON_BUSHINGS {
        let (stiffness, damping, _) = line;
        let name = if damping == 0.0 { "dop853" } else { "radau9" };
        let outcome = bushings("andrews", line).run(integrator(name), 1e-6, 40_000);
        println!("{stiffness:e} {damping} by {name}: {:e}, {}", outcome.error, outcome.statistics);
        assert!(outcome.error < 3e-9, "{stiffness:e} {damping} by {name}: {:e}", outcome.error);
    }
}
