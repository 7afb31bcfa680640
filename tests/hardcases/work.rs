//! The work that cases cost, in counts: equal on every machine and in every build.

use std::fmt::Write;

use bond_graph_tests::hardcases::short_cases;

use crate::verdicts::entries;

#[test]
fn counts_are_what_they_were() {
    let mut text = format!(
        "{:<26} {:<8} {:>7} {:>8} {:>8} {:>9} {:>7}\n",
        "case", "by", "steps", "rejected", "rates", "Jacobians", "LU"
    );
    for case in short_cases() {
        for name in [case.fitting[0], case.fitting[1]] {
            let entry = entries().iter().find(|entry| entry.case == case.name && entry.integrator == name);
            let of = &entry.expect("every integrator runs every case").outcome.statistics;
            writeln!(
                text,
                "{:<26} {name:<8} {:>7} {:>8} {:>8} {:>9} {:>7}",
                case.name, of.steps, of.rejected, of.rate_evaluations, of.jacobian_evaluations, of.factorisations
            )
            .expect("a string");
        }
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("work", text));
}
