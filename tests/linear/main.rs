//! Random linear bond graphs: strokes against all assignments, signals against a dense solution of all equations.
//!
//! A graph that disagrees is made as small as it can be and printed as text to paste. Seeds are fixed; 12 000
//! graphs have equations to compare. `GRAPHS=10000` compares as many of each style.

use std::collections::BTreeMap;

use bond_graph_tests::fuzz::fewest;
use bond_graph_tests::linear::compare::{ROUNDING, Verdict, preferred_strokes, signals, strokes};
use bond_graph_tests::linear::draw::{CROWDED, FULL, LOOSE, Style, VECTORS, network};
use bond_graph_tests::linear::network::{Law, Network};
use bond_graph_tests::linear::strokes::MOST;

/// Fails with the smallest graph that has a wrong verdict.
fn fail(seed: u64, graph: &Network, verdict: &dyn Fn(&Network) -> Verdict) -> ! {
    // What is left has every bond that each element needs.
    let is_whole = |graph: &Network| {
        let any = !graph.bonds.is_empty();
        any && (0..graph.nodes.len()).all(|node| {
            let bonds = graph.bonds_of(node).count();
            match graph.nodes[node].law {
                Law::Zero | Law::One => bonds > 0,
                _ => bonds == if graph.nodes[node].is_two_port() { 2 } else { 1 },
            }
        })
    };
    let is_wrong = |graph: &Network| is_whole(graph) && matches!(verdict(graph), Verdict::Wrong(_));
    let kept = fewest((0..graph.nodes.len()).collect(), &mut |kept| is_wrong(&graph.only(kept)));
    let least = graph.only(&kept);
    panic!("seed {seed}: {:?}\n{}", verdict(&least), least.text());
}

/// Compares the strokes of 4000 graphs.
fn compare_strokes(style: Style, verdict: &dyn Fn(&Network) -> Verdict) -> (usize, usize) {
    let (mut accepted, mut refused) = (0, 0);
    for seed in 0.. {
        let graph = network(seed, style);
        if graph.bonds.len() > MOST {
            continue;
        }
        match verdict(&graph) {
            Verdict::Agrees(_) => accepted += 1,
            Verdict::Refused(_) => refused += 1,
            Verdict::Wrong(_) => fail(seed, &graph, verdict),
        }
        if accepted + refused == 4000 {
            break;
        }
    }
    println!("{accepted} accepted, {refused} refused");
    (accepted, refused)
}

#[test]
fn strokes_are_given_where_any_are_valid_and_they_are_the_first() {
    let (accepted, refused) = compare_strokes(LOOSE, &strokes);
    assert!(accepted > 1000 && refused > 1000, "{accepted} {refused}");
}

#[test]
fn storages_yield_only_where_they_must_and_in_their_order() {
    let (accepted, refused) = compare_strokes(LOOSE, &preferred_strokes);
    assert!(accepted > 1000 && refused > 100, "{accepted} {refused}");
    let (accepted, refused) = compare_strokes(CROWDED, &preferred_strokes);
    assert!(accepted > 1000 && refused > 100, "{accepted} {refused}");
}

/// What each form of a law, of a two-port and of a junction has in its text.
const FORMS: [&str; 17] = [
    "TF t",
    "(effort v)",
    "(flow v)",
    "GY",
    "dot(",
    "]] * v",
    "I e",
    "(p) =",
    "* k",
    "* n",
    "(q) =",
    "R e",
    "Se",
    "Sf",
    "[3]",
    "energy",
    "]];",
];

/// Compares the signals of graphs: every form occurs, few are refused, and at most `amplified` are further apart than
/// [`ROUNDING`]. The environment's `GRAPHS` says how many others are to agree; of these one in a thousand may be
/// amplified.
fn compare_signals(style: Style, usual: usize, amplified: usize) {
    let other = std::env::var("GRAPHS").ok().map(|text| text.parse().expect("GRAPHS is a number"));
    let (wanted, amplified) = other.map_or((usual, amplified), |wanted: usize| (wanted, wanted / 1000));
    let (mut agreed, mut refused, mut worst, mut apart_more) = (0, BTreeMap::new(), 0.0_f64, 0);
    let mut counts = [0; FORMS.len()];
    for seed in 0.. {
        let graph = network(seed, style);
        match signals(&graph, seed) {
            Verdict::Agrees(apart) => {
                agreed += 1;
                worst = worst.max(apart);
                apart_more += usize::from(apart > ROUNDING);
                let text = graph.text();
                FORMS.iter().zip(&mut counts).for_each(|(form, count)| *count += usize::from(text.contains(form)));
            }
            Verdict::Refused(code) => *refused.entry(code).or_insert(0_usize) += 1,
            Verdict::Wrong(_) => fail(seed, &graph, &|graph| signals(graph, seed)),
        }
        if agreed == wanted {
            break;
        }
    }
    let forms: Vec<_> = FORMS.iter().zip(counts).collect();
    println!("{agreed} agree, {refused:?} refused; at worst {worst:e} apart, {apart_more} amplified; {forms:?}");
    assert!(apart_more <= amplified, "{apart_more} graphs are more than {ROUNDING:e} apart");
    assert!(refused.values().sum::<usize>() < 5 * wanted, "{refused:?}");
    assert!(counts.iter().all(|&count| count >= wanted / 70), "{counts:?}");
}

#[test]
fn efforts_flows_rates_and_powers_are_those_of_the_dense_system() {
    compare_signals(FULL, 5000, 0);
}

#[test]
fn so_they_are_in_crowded_graphs() {
    compare_signals(CROWDED, 5000, 0);
}

/// None is refused whose equations are regular: that is what [`signals`] calls wrong.
#[test]
fn so_they_are_where_transformers_lead_to_vectors() {
    compare_signals(VECTORS, 2000, 1);
}
