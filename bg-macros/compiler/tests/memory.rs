//! A junction takes memory in proportion to its bonds, in the stages that follow bonds.

use bg_compiler::graph::{self, causality};
use bg_compiler::source::{mechanism, syntax};
use bg_compiler::system::equations;

/// The most bytes at one time for the strokes and the equations of a junction with so many bonds.
fn peak(kind: &str, storage: &str, bonds: usize) -> u64 {
    let resistors: String = (0..bonds).map(|k| format!("R r{k} = 1; j -> r{k};")).collect();
    let text = format!("graph G {{ {kind} j: translation; {storage} j -> s; {resistors} }}");
    let source = syntax::parse(text.parse().expect("tokens")).expect("no fault of syntax");
    let expanded = mechanism::expand(&source.graphs[0]).expect("no fault of mechanisms");
    let resolved = graph::resolve(&expanded).expect("no fault of names");
    let counted = allocation_counter::measure(|| {
        let causal = causality::assign(resolved).expect("strokes");
        let equations = equations::derive(&causal).expect("equations");
        assert_eq!(equations.shown.bonds.len(), bonds + 1);
    });
    counted.bytes_max
}

#[test]
fn a_junction_takes_memory_in_proportion_to_its_bonds() {
    for (kind, storage) in [("1", "I s = 1;"), ("0", "C s(q) = q * 2;")] {
        let (few, many) = (peak(kind, storage, 250), peak(kind, storage, 1000));
        println!("{kind}-junction: {few} bytes with 250 bonds, {many} with 1000");
        // Four times the bonds; tables that double leave up to twice that. With the square it would be sixteen.
        assert!(many < 8 * few, "{few} {many}");
    }
}
