//! What elements give on their bonds, by numbers: causality either way, half arrows either way.

use super::StateEquations;
use crate::expr::{Environment, Id, evaluate};
use crate::pipeline;
use crate::source::syntax;

fn equations(statements: &str) -> StateEquations {
    let text = format!("graph G {{\n{statements}\n}}");
    let source = syntax::parse(text.parse().expect("tokens")).expect("no fault of syntax");
    pipeline::derive(&source.graphs[0]).expect("equations").equations
}

/// Effort and flow of every bond, in their order, where every state is 6; then the dissipated power.
fn values(statements: &str) -> (Vec<(f64, f64)>, f64) {
    let of = equations(statements);
    let mut roots: Vec<Id> =
        of.shown.bonds.iter().flatten().map(|variable| variable.as_ref().expect("known")[0]).collect();
    roots.push(of.balance.dissipated);
    let states = vec![6.0; of.states.len()];
    let values = evaluate(&of.pool, &roots, &Environment { states: &states, ..Environment::default() });
    let (bonds, dissipated) = values.split_at(values.len() - 1);
    (bonds.chunks(2).map(|pair| (pair[0], pair[1])).collect(), dissipated[0])
}

#[test]
fn a_gyrator_gives_efforts_from_flows_and_flows_from_efforts() {
    // Efforts come in on both sides: each flow is the other side's effort over the ratio.
    let (bonds, _) = values("Se e = 6; 0 a: translation; GY g = 2; 0 b: translation; R r = 5; e -> a -> g -> b -> r;");
    assert_eq!(bonds, [(6.0, 7.5), (6.0, 7.5), (15.0, 3.0), (15.0, 3.0)]);
    // Flows come in on both sides: each effort is the other side's flow times the ratio.
    let (bonds, _) = values("Sf f = 6; 1 a: translation; GY g = 2; 1 b: translation; R r = 4; f -> a -> g -> b -> r;");
    assert_eq!(bonds, [(6.0, 6.0), (6.0, 6.0), (12.0, 3.0), (12.0, 3.0)]);
}

#[test]
fn a_resistor_dissipates_whichever_way_its_half_arrow_points() {
    // The flow 6 / 2 goes through both; along the arrow out of the element the effort is negative.
    for (law, arrow, effort) in [("= 4", "j -> r", 12.0), ("= 4", "r -> j", -12.0), ("(f) = 4 * f", "r -> j", -12.0)] {
        let (bonds, dissipated) = values(&format!("1 j: translation; I m = 2; R r {law}; j -> m; {arrow};"));
        assert_eq!((bonds[1], dissipated), ((effort, 3.0), 36.0), "{law} {arrow}");
    }
    // The effort 6 * 2 is on both; along the arrow out of the element the flow is negative.
    for (law, arrow, flow) in [("= 4", "j -> r", 3.0), ("= 4", "r -> j", -3.0), ("(effort e) = e / 4", "r -> j", -3.0)]
    {
        let law = if law.starts_with('=') { format!("r {law}") } else { format!("r{law}") };
        let (bonds, dissipated) = values(&format!("0 j: translation; C c(q) = 2 * q; R {law}; j -> c; {arrow};"));
        assert_eq!((bonds[1], dissipated), ((12.0, flow), 36.0), "{law} {arrow}");
    }
}

#[test]
fn a_storage_takes_up_power_whichever_way_its_half_arrow_points() {
    for (arrow, sign) in [("j -> m", 1.0), ("m -> j", -1.0)] {
        let of = equations(&format!("1 j: translation; I m = 2; Se e = 5; e -> j; {arrow};"));
        let flow = of.shown.bonds[1][1].as_ref().expect("known");
        let roots = [flow[0], of.states[0].rate, of.balance.supplied];
        let states = [6.0];
        let found = evaluate(&of.pool, &roots, &Environment { states: &states, ..Environment::default() });
        // The momentum is that of the half arrow's effort; against the arrow the flow is negative and so is the
        // source's power.
        assert_eq!(found, [3.0 * sign, 5.0 * sign, 15.0 * sign], "{arrow}");
    }
}

mod loops;
