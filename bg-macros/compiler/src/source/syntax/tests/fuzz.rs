//! Tokens in disorder: the parser always ends, never panics, and what it accepts prints and parses to the same text.

use proc_macro2::{Delimiter, Group, Literal, Punct, Spacing, TokenStream, TokenTree};

use super::{EXAMPLE, bare, shown, tokens};
use crate::random::Random;
use crate::source::syntax::{DEEPEST, MOST_NESTED, parse, parse_leniently};

/// The trees of `stream` with a few of them dropped, doubled, exchanged or replaced, at every level.
fn disordered(stream: TokenStream, random: &mut Random, words: &[TokenTree], rarity: usize) -> TokenStream {
    let mut trees: Vec<TokenTree> = Vec::new();
    for tree in stream {
        let tree = match tree {
            TokenTree::Group(group) => {
                let inner = disordered(group.stream(), random, words, rarity);
                Group::new(delimiter(group.delimiter(), random, rarity), inner).into()
            }
            other => other,
        };
        match random.below(rarity) {
            0 => {}
            1 => trees.extend([tree.clone(), tree]),
            2 => trees.push(words[random.below(words.len())].clone()),
            3 => trees.insert(random.below(trees.len() + 1), tree),
            _ => trees.push(tree),
        }
    }
    trees.into_iter().collect()
}

/// Rarely another delimiter.
fn delimiter(usual: Delimiter, random: &mut Random, rarity: usize) -> Delimiter {
    let all = [Delimiter::Brace, Delimiter::Bracket, Delimiter::None, Delimiter::Parenthesis];
    if random.below(rarity) == 0 { all[random.below(4)] } else { usual }
}

/// All tokens of a stream that are no groups.
fn leaves(stream: TokenStream, into: &mut Vec<TokenTree>) {
    for tree in stream {
        match tree {
            TokenTree::Group(group) => leaves(group.stream(), into),
            leaf => into.push(leaf),
        }
    }
}

#[test]
fn tokens_in_disorder_never_panic() {
    let mut words = Vec::new();
    leaves(tokens(EXAMPLE), &mut words);
    words.push(Literal::string("text").into());
    words.push(Literal::f64_suffixed(1.5).into());
    words.push(Literal::f64_unsuffixed(-1.5).into());
    words.extend("#!^&|@$?%'".chars().map(|mark| TokenTree::from(Punct::new(mark, Spacing::Joint))));
    let graphs = statements_alone();
    let mut random = Random::new(2);
    let mut accepted = 0;
    for round in 0..20_000 {
        // A whole example now and then; a single statement, which may well stay valid, otherwise.
        let whole = round % 400 == 0;
        let stream = if whole { tokens(EXAMPLE) } else { graphs[random.below(graphs.len())].clone() };
        let rarity = [10, 30, 100][random.below(3)];
        if let Ok(source) = parse(disordered(stream, &mut random, &words, rarity)) {
            accepted += 1;
            let text = source.to_string();
            let again = parse(tokens(&text)).unwrap_or_else(|faults| panic!("{}\n{text}", shown(&faults)));
            assert_eq!(again.to_string(), text);
            assert_eq!(bare(&again), bare(&source));
        }
    }
    assert!(accepted > 1000, "only {accepted} of the inputs were valid");
}

/// A graph for every statement of the example.
fn statements_alone() -> Vec<TokenStream> {
    let source = parse(tokens(EXAMPLE)).expect("the example is valid");
    let items = source.graphs.iter().flat_map(|graph| &graph.items);
    items.map(|item| tokens(&format!("graph G {{ {item} }}"))).collect()
}

#[test]
fn nesting_of_any_depth_is_a_fault_and_no_overflow() {
    const MANY: usize = 20_000;
    let forms = [
        format!("{}1{}", "(".repeat(MANY), ")".repeat(MANY)),
        format!("{}1{}", "[".repeat(MANY), "]".repeat(MANY)),
        format!("{}1{}", "f(".repeat(MANY), ")".repeat(MANY)),
        format!("{}a", "-".repeat(MANY)),
        format!("{}a{}", "f(a + a * ".repeat(67), ")".repeat(67)),
        format!("{} 2", "if a < b { 1 } else ".repeat(MANY)),
        format!("{}1{}", "if a < b { ".repeat(MANY), "} else { 1 }".repeat(MANY)),
    ];
    for form in forms {
        let (_, faults) = parse_leniently(tokens(&format!("graph G {{ let a = {form}; }}")));
        assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), ["BG0118"]);
    }
    for form in [
        format!("{}{}", "{".repeat(MANY), "}".repeat(MANY)),
        format!("pub{}{} graph", "(".repeat(MANY), ")".repeat(MANY)),
    ] {
        assert!(!parse_leniently(tokens(&form)).1.is_empty());
    }
}

#[test]
fn the_deepest_expression_is_read_and_printed() {
    let nested = format!("{}a{}", "f(".repeat(MOST_NESTED - 1), ")".repeat(MOST_NESTED - 1));
    // Four levels to begin with, three more for each call.
    let tall = format!("{}a{}", "f(a + a * ".repeat(66), ")".repeat(66));
    assert_eq!(1 + 3 * 66, DEEPEST - 1);
    for text in [nested, tall] {
        assert_eq!(super::expression(&text).to_string(), text);
        assert!(!super::faults(&format!("graph G {{ let a = f(f({text})); }}")).is_empty());
    }
}

#[test]
fn sums_and_products_of_any_length_are_no_nesting() {
    const MANY: usize = 20_000;
    for form in [" + a", " - a", " * a / b", " * a + b"] {
        let text = format!("a{}", form.repeat(MANY));
        assert_eq!(super::expression(&text).to_string(), text);
    }
}
