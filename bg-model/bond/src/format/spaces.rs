//! Whether a blank stands between two tokens of one line.

use proc_macro2::Delimiter::{Brace, Bracket, Parenthesis};

use super::structure::Structure;
use super::tokens::{Token, TokenClass};

/// Marks with a blank on both sides.
const SPACED: [&str; 17] =
    ["->", "=", "=>", "<", "<=", ">", ">=", "==", "!=", "+", "-", "*", "/", "**", "&&", "||", "&"];
/// Marks without any.
const TIGHT: [&str; 4] = [".", "..", "::", "^"];

/// Whether a blank stands before the token `b`, which is not the first.
pub fn spaced(tokens: &[Token], structure: &Structure, b: usize) -> bool {
    let (before, after) = (&tokens[b - 1], &tokens[b]);
    let is_tight = |place: usize| {
        let token = &tokens[place];
        let is_of_unit = structure.is_unit[place] && (token.is("*") || token.is("/"));
        token.kind == TokenClass::Mark && (TIGHT.contains(&token.text) || is_of_unit)
    };
    match (before.kind, after.kind) {
        (TokenClass::Open(Brace), kind) => kind != TokenClass::Close(Brace),
        (TokenClass::Open(_), _) => false,
        (_, TokenClass::Close(kind)) => kind == Brace,
        _ if after.is(";") || after.is(",") => false,
        _ if before.is(";") || before.is(",") || before.is_comment() || after.is_comment() => true,
        _ if is_tight(b - 1) || is_tight(b) || after.is(":") => false,
        _ if before.is(":") => true,
        _ if is_sign(tokens, b - 1) => false,
        (TokenClass::Mark, _) if SPACED.contains(&before.text) => true,
        (_, TokenClass::Mark) if SPACED.contains(&after.text) => true,
        (TokenClass::Mark, _) | (_, TokenClass::Mark) => after.is_apart,
        // The ends of a joint or spring; else a call, or a value after its clause.
        (_, TokenClass::Open(Parenthesis)) => has(tokens, structure, b, "->") || (after.is_apart && !before.is("pub")),
        // A vector, or an index.
        (TokenClass::Word | TokenClass::Close(Bracket), TokenClass::Open(Bracket)) => has(tokens, structure, b, ","),
        _ => true,
    }
}

/// Whether a token is the sign of a number: it stands where a value begins. After a word, which may be that of a clause
/// or a value itself, blanks tell.
fn is_sign(tokens: &[Token], place: usize) -> bool {
    if !tokens[place].is("-") {
        return false;
    }
    let mut before = tokens[..place].iter().rev().filter(|token| !token.is_comment());
    match before.next().map(|token| token.kind) {
        None | Some(TokenClass::Mark | TokenClass::Open(_)) => true,
        Some(TokenClass::Word) => {
            let is_path = before.next().is_some_and(|token| token.is("."));
            let next = &tokens[place + 1];
            !is_path && tokens[place].is_apart && !next.is_apart
        }
        _ => false,
    }
}

/// Whether a bracket has this mark in it, not in brackets further inside.
fn has(tokens: &[Token], structure: &Structure, open: usize, mark: &str) -> bool {
    (open + 1..structure.partner[open]).any(|place| tokens[place].is(mark) && structure.around[place] == Some(open))
}
