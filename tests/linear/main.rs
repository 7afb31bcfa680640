//! Random linear bond graphs: strokes against all assignments, signals against a dense solution of all equations.
//!
//! A graph that disagrees is made as small as it can be and printed as text to paste. Seeds are fixed.

use bond_graph_tests::fuzz::fewest;
use bond_graph_tests::linear::compare::{Verdict, signals, strokes};
use bond_graph_tests::linear::draw::{FULL, LOOSE, network};
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

#[test]
fn strokes_are_given_where_any_are_valid_and_they_are_the_first() {
    let (mut accepted, mut refused) = (0, 0);
    for seed in 0.. {
        let graph = network(seed, LOOSE);
        if graph.bonds.len() > MOST {
            continue;
        }
        match strokes(&graph) {
            Verdict::Agrees(_) => accepted += 1,
            Verdict::Refused(_) => refused += 1,
            Verdict::Wrong(_) => fail(seed, &graph, &strokes),
        }
        if accepted + refused == 4000 {
            break;
        }
    }
    println!("{accepted} accepted, {refused} refused");
    assert!(accepted > 1000 && refused > 1000, "{accepted} {refused}");
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

#[test]
fn efforts_flows_rates_and_powers_are_those_of_the_dense_system() {
    let (mut agreed, mut refused, mut worst) = (0, 0, 0.0_f64);
    let mut counts = [0; FORMS.len()];
    for seed in 0.. {
        let graph = network(seed, FULL);
        match signals(&graph, seed) {
            Verdict::Agrees(apart) => {
                agreed += 1;
                worst = worst.max(apart);
                let text = graph.text();
                FORMS.iter().zip(&mut counts).for_each(|(form, count)| *count += usize::from(text.contains(form)));
            }
            Verdict::Refused(_) => refused += 1,
            Verdict::Wrong(_) => fail(seed, &graph, &|graph| signals(graph, seed)),
        }
        if agreed == 2000 {
            break;
        }
    }
    println!(
        "{agreed} agree, {refused} refused; at worst {worst:e} apart; {:?}",
        FORMS.iter().zip(counts).collect::<Vec<_>>()
    );
    assert!(refused < 5 * agreed, "{refused}");
    assert!(counts.iter().all(|&count| count >= 30), "{counts:?}");
}
