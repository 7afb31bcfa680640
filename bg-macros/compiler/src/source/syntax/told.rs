//! Where the words and functions of the language stand in a text: for editors that run the compiler themselves.
//!
//! In: the tokens of a call, with faults or without. Out: each word with its block, each function that is called, with
//! its place. What a reader is told of them is in [`crate::source::vocabulary`] and [`functions`], as rust-analyzer
//! shows it: who asks has these beside it, so that a small compiler needs no texts.

use std::ops::Range;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

use super::parse_leniently;
use crate::source::ast::Spoken;
use crate::source::functions;

/// A word or function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// Where it stands, in bytes of the text.
    pub bytes: Range<usize>,
    /// The block of a word, as messages call it; none of a function.
    pub block: Option<&'static str>,
    /// Its name.
    pub word: String,
}

/// All of a call: the words in the order of the text, then the functions in theirs.
#[must_use]
pub fn told(tokens: &TokenStream) -> Vec<Told> {
    let (source, _) = parse_leniently(tokens.clone());
    let word = |Spoken { block, word, .. }: Spoken| Told {
        bytes: word.span.byte_range(),
        block: Some(block),
        word: word.text,
    };
    let mut all: Vec<Told> = source.heard.words.into_iter().map(word).collect();
    calls(tokens, &mut all);
    all
}

/// Adds the functions that are called.
fn calls(tokens: &TokenStream, all: &mut Vec<Told>) {
    let mut before = None;
    for token in tokens.clone() {
        match &token {
            TokenTree::Group(group) => {
                let called = before.take().filter(|_| group.delimiter() == Delimiter::Parenthesis);
                all.extend(called);
                calls(&group.stream(), all);
            }
            TokenTree::Ident(name) => {
                let word = name.to_string();
                let is_function = functions::named(&word).is_some();
                before = is_function.then(|| Told { bytes: name.span().byte_range(), block: None, word });
            }
            _ => before = None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::vocabulary::meaning;

    /// What is told, by what stands there.
    fn of(text: &str) -> Vec<(String, Told)> {
        let tokens = text.parse().expect("tokens");
        told(&tokens).into_iter().map(|told| (text[told.bytes.clone()].to_owned(), told)).collect()
    }

    #[test]
    fn words_have_their_blocks_and_functions_stand_where_they_are_called() {
        let text = "graph G { /// Ä: a rod.
            param min: m = 1; ground { point O = [0, 0, 0]; }
            body rod { mass 1; inertia [1, 1, 1]; point end = [1, 0, 0]; }
            joint pin: revolute z (ground.O -> rod.end) { stiffness 1e6; }
            observe { least: m = min(min, rod.position.x); } }";
        let told = of(text);
        let [stiffness] = &told.iter().filter(|(word, _)| word == "stiffness").collect::<Vec<_>>()[..] else {
            panic!("{told:?}")
        };
        assert_eq!((stiffness.1.block, stiffness.1.word.as_str()), (Some("a joint"), "stiffness"));
        // The parameter of this name is none.
        let [min] = &told.iter().filter(|(word, _)| word == "min").collect::<Vec<_>>()[..] else { panic!("{told:?}") };
        assert!(min.1.block.is_none() && min.1.bytes.start > text.find("least").unwrap(), "{min:?}");
        for word in ["graph", "param", "body", "mass", "revolute", "observe"] {
            let (_, one) = told.iter().find(|(found, _)| found == word).expect(word);
            assert!(one.block.is_some_and(|block| meaning(block, word).is_some()), "{one:?}");
        }
    }

    #[test]
    fn what_has_faults_is_told_as_far_as_it_can_be_read() {
        let told =
            of("graph G { joint pin: revolute z (a -> b) { stiffnes 1; damping 2; } observe { x: 1 = sin(1 2); } }");
        let words: Vec<&str> = told.iter().map(|(word, _)| word.as_str()).collect();
        assert!(words.contains(&"damping") && words.contains(&"sin") && !words.contains(&"stiffnes"), "{words:?}");
    }
}
