//! Strokes and their faults on small graphs; on random ones they are compared with all assignments in the suites.

use super::{CausalGraph, End, assign};
use crate::fault::Staged;
use crate::graph;
use crate::source::{mechanism, syntax};

fn assigned(statements: &str) -> Staged<CausalGraph> {
    let text = format!("graph G {{\n{statements}\n}}");
    let source = syntax::parse(text.parse().unwrap_or_else(|error| panic!("{error}\n{text}")))?;
    assign(graph::resolve(&mechanism::expand(&source.graphs[0])?)?)
}

/// The strokes as arrows with a bar at the end that receives the effort: `a |-> b` or `a ->| b`.
fn strokes(statements: &str) -> Vec<String> {
    let causal = assigned(statements).unwrap_or_else(|faults| panic!("{}\n{statements}", faults[0]));
    let name = |node| causal.graph.node(node).name.text.clone();
    let arrow = |end| if end == End::From { "|->" } else { "->|" };
    let bonds = causal.graph.bonds.iter().zip(&causal.strokes);
    bonds.map(|(bond, &end)| format!("{} {} {}", name(bond.from), arrow(end), name(bond.to))).collect()
}

/// Code and message of every fault.
fn faults(statements: &str) -> Vec<String> {
    let faults = assigned(statements).expect_err(statements);
    faults.iter().map(|fault| format!("{} {}", fault.code, fault.message)).collect()
}

#[test]
fn one_bond_at_a_junction_determines_it() {
    assert_eq!(strokes("1 a: translation; R r = 1; a -> r;"), ["a ->| r"]);
    assert_eq!(strokes("0 a: translation; R r = 1; a -> r;"), ["a |-> r"]);
}

#[test]
fn a_choice_that_leads_nowhere_is_made_anew() {
    let text =
        "param p: N*s/m = 2; 1 j0: translation; 0 j1; GY q = p; R y = p; I b = 0.5; j0 -> q -> j1; j1 -> y; b -> j1;";
    // The first choice, a stroke at `j0`, would leave it without a flow.
    assert_eq!(strokes(text), ["j0 ->| q", "q |-> j1", "j1 |-> y", "b |-> j1"]);
}

#[test]
fn where_the_first_choice_will_do_it_stays() {
    // Two parts: in the second the first choice fails, in the first the R keeps what it would have without it.
    let part = "1 a: translation; R r = 1; R s = 2; Se e = 1; e -> a -> r; a -> s;";
    let alone = strokes(part);
    assert_eq!(alone, ["e ->| a", "a |-> r", "a ->| s"]);
    assert_eq!(strokes(&format!("{part} 1 b: translation; R u = 1; b -> u;"))[..3], alone);
}

#[test]
fn a_ring_of_gyrators_needs_an_odd_cycle_undone() {
    // Three 1-junctions, each pair with a GY between: one of them has to have its R.
    let text = "1 a: translation; 1 b: translation; 1 c: translation; GY f = 1; GY g = 2; GY h = 3; R r = 1;
        a -> f -> b -> g -> c -> h -> a; c -> r;";
    assert_eq!(strokes(text), ["a ->| f", "f |-> b", "b |-> g", "g ->| c", "c |-> h", "h ->| a", "c ->| r"]);
}

#[test]
fn what_lacks_a_cause_is_named_and_an_r_there_puts_it_right() {
    let text = "1 a: translation; 1 b: translation; 1 c: translation; GY f = 1; GY g = 2; GY h = 3;
        a -> f -> b -> g -> c -> h -> a;";
    assert_eq!(faults(text), ["BG0402 causal conflict: no bond is left to determine the flow of `b`"]);
    assert_eq!(strokes(&format!("{text} R r = 1; b -> r;")).len(), 7);
}

#[test]
fn two_causes_that_no_choice_avoids_are_named() {
    let text = "1 a: translation; 1 b: translation; a -> b; b -> a; a -> b;";
    assert_eq!(
        faults(text),
        ["BG0401 causal conflict: two bonds determine the flow of `a`: `b -> a` (forced by 1 `b`) and `a -> b` \
             (forced by 1 `b`)"]
    );
}

#[test]
fn each_fault_comes_once_and_none_hides_another() {
    // Two storages too many on one junction, a source against a source, a law against a source, a junction without a
    // cause.
    let text = "1 a: translation; I i = 1; I k = 2; I l = 3; a -> i; a -> k; a -> l;
        0 b: translation; Se s = 1; Se u = 2; s -> b; u -> b;
        1 c: translation; Sf f = 1; R r(effort e) = e / 2; f -> c -> r;
        1 d: translation; 0 z: translation; Se e = 1; e -> d; Sf w = 1; w -> z; expect integral causality;";
    assert_eq!(
        faults(text),
        [
            "BG0401 causal conflict: two bonds determine the effort of `b`: `s -> b` (forced by Se `s`) and `u -> b` \
             (forced by Se `u`)",
            "BG0402 causal conflict: no bond is left to determine the flow of `d`",
            "BG0402 causal conflict: no bond is left to determine the effort of `z`",
            "BG0404 the law of R `r` needs its effort, but that is what it would have to give: Sf `f` determines the \
             other variable",
            "BG0403 I `k` would be in derivative causality: its state is already determined by I `i`",
            "BG0403 I `l` would be in derivative causality: its state is already determined by I `i`",
        ]
    );
}

#[test]
fn choices_that_fail_in_two_places_are_two_faults() {
    let ring = |a: &str| {
        format!(
            "1 {a}1: translation; 1 {a}2: translation; 1 {a}3: translation; GY {a}f = 1; GY {a}g = 2; GY {a}h = 3;
             {a}1 -> {a}f -> {a}2 -> {a}g -> {a}3 -> {a}h -> {a}1;"
        )
    };
    let found = faults(&(ring("a") + &ring("b")));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].contains("`a2`") && found[1].contains("`b2`"), "{found:?}");
}

#[test]
fn residual_sinks_come_before_storages() {
    // The sink's effort is there first, so the C is what is one too many.
    let text = "1 j: translation; I m = 1; 0 z; C c(q) = 2 * q; rSe tie = 0; j -> z -> c; j -> m; tie -> z;
        expect integral causality;";
    assert_eq!(
        faults(text),
        ["BG0403 C `c` would be in derivative causality: its state is already determined by rSe `tie`"]
    );
}

/// The storages in derivative causality.
fn derivative(statements: &str) -> Vec<String> {
    let causal = assigned(statements).unwrap_or_else(|faults| panic!("{}\n{statements}", faults[0]));
    causal.derivative.iter().map(|&node| causal.graph.node(node).name.text.clone()).collect()
}

#[test]
fn of_storages_that_determine_each_other_the_first_integrates() {
    assert_eq!(derivative("1 a: translation; I i = 1; I k = 2; I l = 3; a -> i; a -> k; a -> l;"), ["k", "l"]);
    assert_eq!(derivative("1 a: translation; I i = 1; I k = 2; a -> k; a -> i;"), ["k"]);
    assert_eq!(
        derivative("0 a: translation; C i(q) = 2 * q; C k(q) = 3 * q; Se s = 1; s -> a; a -> k; a -> i;"),
        ["i", "k"]
    );
    // Through a gear and a gyrator; the C sees a flow then.
    assert_eq!(
        derivative("1 a: rotation; TF n = 2; 1 b: rotation; I i = 1; I k = 2; a -> i; a -> n -> b -> k;"),
        ["k"]
    );
    let motor = "1 a: electrical; param r: N*m/A = 2; GY n = r; 1 b: rotation; 0 c: rotation; I l = 1; \
        param s: N*m/rad = 2; C k = s;";
    assert_eq!(derivative(&format!("{motor} a -> l; a -> n -> c -> k; c -> b; I j = 3; b -> j;")), ["k"]);
}

#[test]
fn a_law_without_an_inverse_and_a_start_keep_their_states() {
    assert_eq!(
        derivative(
            "1 a: translation; I i = 1; param v: m/s = 1; param h: kg*m/s = 1; I k(p) = v * tanh(p / h); a -> i; \
            a -> k;"
        ),
        ["i"]
    );
    assert_eq!(derivative("1 a: translation; I i = 1; I k = 2 start 3; a -> i; a -> k;"), ["i"]);
    assert_eq!(
        derivative("1 a: translation; I i = 1; I k = 2 start 3; I l(p) = p / 2; a -> i; a -> k; a -> l;"),
        ["i", "k"]
    );
}

#[test]
fn a_storage_yields_where_the_rest_could_have_no_strokes() {
    // With its integral stroke the I would leave `b` without a flow.
    let text = "1 a: translation; GY g = 2; 1 b: translation; I i = 1; Se s = 1; a -> g -> b; a -> i; s -> b;";
    assert_eq!(derivative(text), ["i"]);
}

#[test]
fn a_displacement_of_the_poses_stays_one() {
    let text =
        "1 j[3]: translation; position x of j; I m = 1; j -> m; MTF along(v) = dot([1, 0, 0], v); 0 s: translation;
        C c(q) = 3 * q at x.x; j -> along -> s -> c; Se f = 1; f -> s;";
    assert_eq!(
        faults(text),
        ["BG0403 C `c` would be in derivative causality: its state is already determined by Se `f`"]
    );
}

/// A board of junctions, alternately 0 and 1, each bonded to its neighbours, without two opposite corners if so.
fn board(size: usize, is_cut: bool) -> String {
    use std::fmt::Write;
    let is_there = |i: usize, j: usize| i < size && j < size && !(is_cut && [0, 2 * size - 2].contains(&(i + j)));
    let mut text = String::new();
    for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))).filter(|&(i, j)| is_there(i, j)) {
        let _ = writeln!(text, "{} j{i}_{j}: translation;", (i + j) % 2);
        for (k, l) in [(i + 1, j), (i, j + 1)].into_iter().filter(|&(k, l)| is_there(k, l)) {
            let _ = writeln!(text, "j{i}_{j} -> j{k}_{l};");
        }
    }
    text
}

#[test]
fn choices_without_end_end() {
    // Trying out strokes takes a time that doubles with each row: the chessboard without two corners.
    assert_eq!(faults(&board(14, true)).len(), 2);
    assert_eq!(strokes(&board(14, false)).len(), 2 * 14 * 13);
}
