//! What a user can do wrong, as data.
//!
//! Every stage has an enum of its faults that implements [`Explain`]; a [`Fault`] is one of them at a place in the
//! source. A stage collects its faults and raises them together at its end.

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;

/// What a fault says to the user.
pub trait Explain {
    /// The stable code, such as `BG0301`: the first two digits are the stage's, the last two the fault's.
    fn code(&self) -> &'static str;
    /// What is wrong, naming the things involved.
    fn message(&self) -> String;
    /// One action that fixes it.
    fn help(&self) -> String;
}

/// A fault at a place in the source.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The token to change.
    pub span: Span,
    /// The stable code.
    pub code: &'static str,
    /// What is wrong.
    pub message: String,
    /// One action that fixes it.
    pub help: String,
}

impl Fault {
    /// The fault `kind` at `span`.
    pub fn new(span: Span, kind: &impl Explain) -> Self {
        Self { span, code: kind.code(), message: kind.message(), help: kind.help() }
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "[{}] {}\nhelp: {}", self.code, self.message, self.help)
    }
}

/// Two things of one name, as the stages that declare names find it, at the second one.
#[derive(Clone, Debug)]
pub struct DeclaredTwice {
    /// The name.
    pub name: String,
    /// Where the first one is, in words: empty where the two stand on one line, or the compiler knows no places.
    first: String,
}

impl DeclaredTwice {
    /// The name declared at `second` is declared at `first`, too.
    #[must_use]
    pub fn new(name: &str, second: Span, first: Span) -> Self {
        let line = first.start().line;
        let first = match (second.file(), first.file()) {
            (here, there) if here != there && line > 0 => format!(", first in line {line} of {there}"),
            _ if line > 0 && line != second.start().line => format!(", first in line {line}"),
            _ => String::new(),
        };
        Self { name: name.to_owned(), first }
    }
}

impl Explain for DeclaredTwice {
    fn code(&self) -> &'static str {
        "BG0302"
    }

    fn message(&self) -> String {
        format!("`{}` is declared twice{}", self.name, self.first)
    }

    fn help(&self) -> String {
        "give one of them another name".to_owned()
    }
}

/// The faults of one stage, in the order of their discovery; not empty.
pub type Faults = Vec<Fault>;

/// A stage's result.
pub type Staged<T> = Result<T, Faults>;

/// The faults as compile errors, each at its token.
#[must_use]
pub fn compile_errors(faults: &[Fault]) -> TokenStream {
    faults
        .iter()
        .map(|fault| {
            let text = fault.to_string();
            quote_spanned! { fault.span => ::core::compile_error!(#text); }
        })
        .collect()
}

/// The candidate nearest to `name` in edit distance, when it is near enough to be a slip of the pen.
#[must_use]
pub fn near_miss<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = 1 + name.chars().count() / 4;
    candidates
        .into_iter()
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein's distance: insertions, deletions and replacements of one character.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_pen_has_a_near_miss_and_a_stranger_has_none() {
        assert_eq!(near_miss("windng", ["coil", "winding"]), Some("winding"));
        assert_eq!(near_miss("flywheel", ["coil", "winding"]), None);
    }

    #[test]
    fn distance_counts_single_edits() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
    }
}
