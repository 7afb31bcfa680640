//! The grammar for editors knows the language's words: those that the parser reads, no more and no fewer.
//!
//! The parser's words are read from its source, the grammar's from its patterns: alternatives of words in parentheses.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use bg_compiler::graph::units::DOMAINS;
use bg_compiler::source::functions::FUNCTIONS;

/// Words of Rust in paths, and a number of components.
const OTHERS: [&str; 4] = ["crate", "self", "super", "3"];

type Words = BTreeSet<String>;

/// A place below the workspace.
fn place(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn text(path: &str) -> String {
    let path = place(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The words between quotation marks, where all between them are words.
fn quoted(text: &str, words: &mut Words) {
    let is_word = |word: &str| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !word.is_empty();
    for literal in text.split('"').skip(1).step_by(2).filter(|literal| literal.split(' ').all(is_word)) {
        words.extend(literal.split(' ').map(str::to_owned));
    }
}

/// What stands between `start` and the next `end`, each time.
fn between<'t>(text: &'t str, start: &'t str, end: &'t str) -> impl Iterator<Item = &'t str> {
    text.split(start).skip(1).map(move |rest| rest.split(end).next().unwrap_or_default())
}

/// The words that the parser compares with, in its lists, and the names of functions and domains.
fn of_the_parser() -> Words {
    let folder = place("bg-macros/compiler/src/source/syntax");
    let mut words = Words::new();
    for entry in fs::read_dir(folder).expect("the parser").map(|entry| entry.expect("an entry").path()) {
        if entry.extension().is_none() || entry.ends_with("fault.rs") {
            continue;
        }
        let code = fs::read_to_string(entry).expect("text");
        let code = code.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        for (start, end) in
            [("eat_word(", ")"), ("expect_word(", ")"), ("Some(\"", ")"), ("] = \"", ";"), ("words: &[", "]")]
        {
            let missing = if start.ends_with('"') { "\"" } else { "" };
            between(code, start, end).for_each(|inside| quoted(&format!("{missing}{inside}"), &mut words));
        }
        between(code, "] = [", "];").for_each(|list| quoted(list, &mut words));
        between(code, "] = &[", "];").for_each(|list| quoted(list, &mut words));
    }
    between(&text("bg-macros/compiler/src/source/words.rs"), "] =", "];").for_each(|table| quoted(table, &mut words));
    words.extend(FUNCTIONS.iter().map(|function| function.name.to_owned()));
    words.extend(DOMAINS.iter().map(|domain| domain.name.to_owned()));
    words.extend(["ground", "pub"].map(str::to_owned));
    words.retain(|word| !OTHERS.contains(&word.as_str()));
    words
}

/// The alternatives of the grammar's patterns.
fn of_the_grammar() -> Words {
    let grammar = text("docs/editor/bond.tmLanguage.json");
    let mut words = Words::new();
    for pattern in between(&grammar, "\"match\": \"", "\",\n").chain(between(&grammar, "\"match\": \"", "\" }")) {
        for group in between(pattern, "(", ")") {
            let alternatives: Vec<&str> = group.split('|').collect();
            let is_word = |word: &&str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            if alternatives.iter().all(is_word) {
                words.extend(alternatives.into_iter().map(str::to_owned));
            }
        }
    }
    words
}

#[test]
fn the_grammar_has_the_words_of_the_language() {
    let (parser, grammar) = (of_the_parser(), of_the_grammar());
    assert!(parser.len() > 120, "only {} words of the parser were found", parser.len());
    let missing: Vec<_> = parser.difference(&grammar).collect();
    assert!(missing.is_empty(), "docs/editor/bond.tmLanguage.json does not know {missing:?}");
    let superfluous: Vec<_> = grammar.difference(&parser).collect();
    assert!(superfluous.is_empty(), "docs/editor/bond.tmLanguage.json knows {superfluous:?}, the parser does not");
}
