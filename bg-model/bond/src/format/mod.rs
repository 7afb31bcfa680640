//! Texts of the language in one form.
//!
//! In: a text without faults of syntax. Out: the same words, marks and comments with other blanks and line ends.
//! Statements of a graph or part stand in lines of their own, indented by its braces; in any other block, and within a
//! statement, lines are as they were written. A block that was written in one line stays so where it fits. Between
//! lines is at most one that is empty.
//!
//! What has been formatted is not changed by formatting it again.

mod layout;
mod spaces;
mod structure;
mod tokens;

use bg_loaded::Fault;
use proc_macro2::TokenStream;

/// The text in its form.
///
/// # Errors
/// The faults of syntax of the text, of which no form is known.
pub fn formatted(text: &str) -> Result<String, Vec<Fault>> {
    let faults = bg_loaded::syntax_faults(text);
    if !faults.is_empty() {
        return Err(faults);
    }
    let is_of_windows = text.contains("\r\n");
    let unix = text.replace("\r\n", "\n");
    let formatted = of_lines(&unix);
    Ok(if is_of_windows { formatted.replace('\n', "\r\n") } else { formatted })
}

/// A text whose lines end with `\n`.
fn of_lines(text: &str) -> String {
    let stream: TokenStream = text.parse().expect("the text has no faults of syntax");
    let tokens = tokens::tokens(text, stream);
    layout::Layout::of(&tokens).text()
}

#[cfg(test)]
mod tests;
