//! What a reader is told of words and functions where they stand in a text: by editors that run the compiler themselves.
//!
//! In: the tokens of a call, with faults or without. Out: the sentence of [`super::vocabulary`] of each word in its block,
//! all of [`super::functions`] of each function that is called. What rust-analyzer shows of them is the same.

use std::ops::Range;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

use crate::source::ast::Spoken;
use crate::source::functions::{self, Function};
use crate::source::syntax::parse_leniently;
use crate::source::vocabulary::meaning;

/// What is told of a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// Where it stands, in bytes of the text.
    pub bytes: Range<usize>,
    /// How a function is called, a line for each number of arguments; of a word the word and its block.
    pub head: String,
    /// What it says, in a sentence or two; what stands between backticks is code.
    pub meaning: &'static str,
    /// The units that a function takes and gives; of a word none.
    pub units: Option<&'static str>,
    /// A statement that uses a function; of a word none.
    pub example: Option<&'static str>,
}

/// All that is told of a call, in the order of the text.
#[must_use]
pub fn told(tokens: &TokenStream) -> Vec<Told> {
    let (source, _) = parse_leniently(tokens.clone());
    let word = |spoken: &Spoken| {
        let (name, meaning) = (&spoken.word.text, meaning(spoken.block, &spoken.word.text)?);
        let head = format!("{name}, in {}", spoken.block);
        Some(Told { bytes: spoken.word.span.byte_range(), head, meaning, units: None, example: None })
    };
    let mut all: Vec<Told> = source.heard.words.iter().filter_map(word).collect();
    calls(tokens, &mut all);
    all.sort_by_key(|told| told.bytes.start);
    all.dedup_by_key(|told| told.bytes.start);
    all
}

/// Adds the functions that are called.
fn calls(tokens: &TokenStream, all: &mut Vec<Told>) {
    let mut before = None;
    for token in tokens.clone() {
        match &token {
            TokenTree::Group(group) => {
                let called = before.take().filter(|_| group.delimiter() == Delimiter::Parenthesis);
                if let Some((function, bytes)) = called {
                    let &Function { meaning, units, example, .. } = function;
                    let head = Function::calls(function).join("\n");
                    all.push(Told { bytes, head, meaning, units: Some(units), example: Some(example) });
                }
                calls(&group.stream(), all);
            }
            TokenTree::Ident(name) => {
                before = functions::named(&name.to_string()).map(|function| (function, name.span().byte_range()));
            }
            _ => before = None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told, by what stands there.
    fn of(text: &str) -> Vec<(String, Told)> {
        let tokens = text.parse().expect("tokens");
        told(&tokens).into_iter().map(|told| (text[told.bytes.clone()].to_owned(), told)).collect()
    }

    #[test]
    fn words_are_told_by_their_blocks_and_functions_where_they_are_called() {
        let text = "graph G { /// Ä: a rod.
            param min: m = 1; ground { point O = [0, 0, 0]; }
            body rod { mass 1; inertia [1, 1, 1]; point end = [1, 0, 0]; }
            joint pin: revolute z (ground.O -> rod.end) { stiffness 1e6; }
            observe { least: m = min(min, rod.position.x); } }";
        let told = of(text);
        let [stiffness] = &told.iter().filter(|(word, _)| word == "stiffness").collect::<Vec<_>>()[..] else {
            panic!("{told:?}")
        };
        assert_eq!(stiffness.1.head, "stiffness, in a joint");
        assert_eq!(Some(stiffness.1.meaning), meaning("a joint", "stiffness"));
        // The parameter of this name is none.
        let [min] = &told.iter().filter(|(word, _)| word == "min").collect::<Vec<_>>()[..] else { panic!("{told:?}") };
        assert_eq!((min.1.head.as_str(), min.1.meaning), ("min(a, b)", functions::named("min").unwrap().meaning));
        assert!(min.1.bytes.start > text.find("least").unwrap() && min.1.example.is_some());
        for word in ["graph", "param", "body", "mass", "revolute", "observe"] {
            assert!(told.iter().any(|(found, _)| found == word), "{word}: {told:?}");
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
