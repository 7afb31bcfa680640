//! Random inputs: no panic, every fault with a code and a place, and nothing that was ever kept goes wrong again.
//!
//! The corpus under `corpus/` has an input for each code that random inputs reached, shortened, what was ever found to
//! go wrong, and edges. `cargo run --release -p bond-graph-tests --example fuzz -- --help` hands in any number of
//! inputs.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use bond_graph_tests::fuzz::{Input, KINDS, Kind, Outcome, Tally, corpus, examine, joined, lexemes, seeds, shrink};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// The folder of this package.
fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_corpus_has_the_outcomes_it_had() {
    let mut outcomes = String::new();
    for (name, input) in corpus(&here().join("fuzz/corpus")).expect("the corpus is there") {
        let outcome = examine(&input).unwrap_or_else(|violation| panic!("{name}: {}", violation.0));
        let codes = match outcome {
            Outcome::NoTokens => "no tokens".to_owned(),
            Outcome::Accepted => "accepted".to_owned(),
            Outcome::Refused(codes) => codes.into_iter().collect::<Vec<_>>().join(", "),
        };
        let _ = writeln!(outcomes, "{name}: {codes}");
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("corpus");
    settings.set_prepend_module_to_snapshot(false);
    settings.bind(|| insta::assert_snapshot!("outcomes", outcomes));
}

/// Fresh inputs of one kind and what became of them.
fn fresh(tally: &mut Tally, kind: Kind, count: u64) {
    let seeds = seeds(&here().join("..")).expect("the models are there");
    // As rustc has it: tokens inside of many groups are printed by calls inside of as many.
    const STACK: usize = 8 << 20;
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK).build().expect("threads");
    let examined = (0..count).into_par_iter().map(|number| examine(&kind.input(&seeds, 2026, number)));
    for (number, result) in (0..count).zip(pool.install(|| examined.collect::<Vec<_>>())) {
        tally.count(kind, &result);
        if let Err(violation) = result {
            panic!("{} {number}: {}\n{}", kind.name(), violation.0, kind.input(&seeds, 2026, number).text());
        }
    }
}

/// The stages whose codes are among these: the digits after `BG`.
fn stages(codes: &BTreeSet<&str>) -> BTreeSet<String> {
    codes.iter().filter_map(|code| code.strip_prefix("BG")).map(|digits| digits[..2].to_owned()).collect()
}

#[test]
fn fresh_inputs_reach_every_stage_and_break_no_promise() {
    let mut tally = Tally::default();
    for (kind, count) in KINDS.into_iter().zip([1500, 400, 200, 4, 1500]) {
        fresh(&mut tally, kind, count);
    }
    println!("{tally}");
    // How often inputs get through all stages, in percent: a generator that makes nothing valid tests the parser only.
    for (kind, least) in [(Kind::Mutant, 5), (Kind::Network, 25), (Kind::Mechanism, 25), (Kind::Settings, 20)] {
        let count = tally.kind(kind);
        assert!(count.accepted * 100 >= least * count.inputs, "{}: {count:?}", kind.name());
    }
    let codes: BTreeSet<&str> = tally.codes().into_keys().collect();
    assert!(codes.len() >= 40, "{} codes", codes.len());
    assert_eq!(stages(&codes).into_iter().collect::<Vec<_>>(), ["01", "02", "03", "04", "05", "06", "07", "08"]);
    for kind in ["range", "unknown", "toml", "not a number", "no value"] {
        assert!(codes.contains(kind), "{kind}");
    }
}

#[test]
fn the_same_numbers_give_the_same_inputs() {
    let seeds = seeds(&here().join("..")).expect("the models are there");
    for kind in KINDS {
        let inputs = |seed| (0..20).map(|number| kind.input(&seeds, seed, number)).collect::<Vec<Input>>();
        assert_eq!(inputs(1), inputs(1));
        assert_ne!(inputs(1), inputs(2));
    }
    let mixed: Vec<usize> =
        KINDS.iter().map(|kind| (0..400).filter(|&number| Kind::of(number) == *kind).count()).collect();
    assert_eq!(mixed, [180, 20, 32, 1, 167]);
}

#[test]
fn depth_and_length_are_faults_and_no_overflow() {
    const MANY: usize = 10_000;
    let repeated = |open: &str, inner: &str, close: &str| format!("{}{inner}{}", open.repeat(MANY), close.repeat(MANY));
    let expressions = [
        repeated("(", "1", ")"),
        repeated("-", "1", ""),
        repeated("[", "1", "]"),
        repeated("abs(", "1", ")"),
        repeated("pow(", "t", ",16)"),
        repeated("if t < 1 { ", "1", " } else { 2 }"),
    ];
    let outcome = |expression: &str| {
        let text =
            format!("graph G {{ 1 j: translation; R r = 1; I i = 1; j -> r; j -> i; observe {{ a = {expression} }} }}");
        examine(&Input::Call(text)).expect("no panic")
    };
    for expression in expressions {
        assert_eq!(outcome(&expression), Outcome::Refused(BTreeSet::from(["BG0118".to_owned()])));
    }
    // The length of a sum or product is no depth.
    for expression in [repeated("1 + ", "1", ""), repeated("sin(t / 1) - ", "1", ""), repeated("1 * t / ", "2", "")] {
        assert_eq!(outcome(&expression), Outcome::Accepted);
    }
    for (text, expected) in [
        (repeated("graph G { ", "", "}"), "BG0101"),
        (repeated("{", "", "}"), "BG0102"),
        (format!("graph G {{ j{}; }}", repeated(" -> j", "", "")), "BG0303"),
        (format!("graph {} {{ }}", "a".repeat(MANY)), "BG0333"),
    ] {
        match examine(&Input::Call(text)).expect("no panic") {
            Outcome::Refused(codes) => assert!(codes.contains(expected), "{codes:?}, expected {expected}"),
            other => panic!("{other:?}"),
        }
    }
    let file = format!("torque = {}", repeated("[", "1", "]")).into_bytes();
    let outcome = examine(&Input::Settings { file, set: Vec::new() }).expect("no panic");
    assert_eq!(outcome, Outcome::Refused(BTreeSet::from(["toml".to_owned()])));
}

#[test]
fn what_matters_is_left_of_a_text() {
    let text = "graph G { let a = 1; let b = f(2, x); }".to_owned();
    let mut holds = |input: &Input| input.text().contains('f') && input.text().contains('2');
    assert_eq!(shrink(&Input::Call(text), &mut holds), Input::Call("f 2 ".to_owned()));
}

#[test]
fn a_text_comes_apart_and_together() {
    let text = "/// Doc.\ngraph G { let a = 1e-3*b.x->2; // no\n 1 j[3]: m^2; ";
    let found = lexemes(text);
    assert_eq!(found[..8], ["/// Doc.", "graph", "G", "{", "let", "a", "=", "1e-3"]);
    assert!(found.contains(&"->".to_owned()) && !found.iter().any(|lexeme| lexeme.contains("no")));
    assert!(joined(&found).ends_with("1 j [ 3 ] : m ^ 2 ; }"));
    assert_eq!(joined(&[")", "(", "]"].map(str::to_owned)), "( )");
}
