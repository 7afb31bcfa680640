//! Verdicts: who reaches the reference, that nobody is wrong without saying so, and what it costs in counts, which are
//! equal on every machine and in every build.

use std::fmt::Write;

use bond_graph_tests::hard_hacksaw::cases::{REVERSAL, cases};
use bond_graph_tests::hardcases::case::{Case, Verdict};
use bond_graph_tests::hardcases::integrator;

/// The attempted steps that an integrator may take.
const ENOUGH: u64 = 5000;

/// Integrators that do not come to the end within these steps: eigenvalues of -2.5e6 1/s limit those of explicit ones.
const TOO_COSTLY: &[(&str, &str)] = &[("hacksaw-offset", "dop853")];

/// The case up to the first instant of its reference, or to the first after the reversal of the torque.
fn short(case: Case) -> Case {
    let least = if case.name.starts_with("hacksaw-reversed") { REVERSAL } else { 0.0 };
    let end = case.instants.iter().copied().find(|t| *t > least).expect("an instant behind the reversal");
    case.until(end)
}

#[test]
fn fitting_integrators_reach_the_reference_and_nobody_is_wrong() {
    let mut text = format!(
        "{:<26} {:<8} {:<10} {:>7} {:>8} {:>8} {:>9} {:>7}\n",
        "case", "by", "verdict", "steps", "rejected", "rates", "Jacobians", "LU"
    );
    for case in cases().into_iter().map(short) {
        for name in
            case.fitting.iter().copied().chain(["dop853"].into_iter().filter(|name| !case.fitting.contains(name)))
        {
            let outcome = case.run(integrator(name), case.moderate, ENOUGH);
            let of = outcome.statistics;
            println!("{} by {name}: {:?}, {:e}", case.name, outcome.verdict, outcome.error);
            let expected = if TOO_COSTLY.contains(&(case.name, name)) { Verdict::TooCostly } else { Verdict::Reached };
            assert_eq!(outcome.verdict, expected, "{} by {name}: {:e}", case.name, outcome.error);
            assert!(!outcome.is_wrong_between, "{} by {name}: {:e}", case.name, outcome.between);
            writeln!(
                text,
                "{:<26} {name:<8} {:<10} {:>7} {:>8} {:>8} {:>9} {:>7}",
                case.name,
                outcome.verdict.word(),
                of.steps,
                of.rejected,
                of.rate_evaluations,
                of.jacobian_evaluations,
                of.factorisations
            )
            .expect("a string");
        }
    }
    super::snapshot("work", &text);
}
