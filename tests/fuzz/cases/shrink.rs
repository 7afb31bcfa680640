//! A shorter input of the same kind.
//!
//! In: an input and what must stay true of it. Out: a shorter one of which it is still true.
//! Method: delta debugging (Zeller, Hildebrandt 2002, Simplifying and isolating failure-inducing input), which leaves
//! out ever smaller pieces.

use super::Input;
use super::lexemes::{joined, lexemes};

/// The input with as many of its lexemes, lines and texts left out as `holds` allows.
pub fn shrink(input: &Input, holds: &mut dyn FnMut(&Input) -> bool) -> Input {
    match input {
        Input::Call(text) => {
            let statements = statements(lexemes(text));
            let statements = fewest(statements, &mut |parts| holds(&Input::Call(joined(&parts.concat()))));
            let parts = fewest(statements.concat(), &mut |parts| holds(&Input::Call(joined(parts))));
            Input::Call(joined(&parts))
        }
        Input::Settings { file, set } => {
            let set = fewest(set.clone(), &mut |set| holds(&Input::Settings { file: file.clone(), set: set.to_vec() }));
            let lines = file.split_inclusive(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
            let with = |lines: &[Vec<u8>]| Input::Settings { file: lines.concat(), set: set.clone() };
            let lines = fewest(lines, &mut |lines| holds(&with(lines)));
            with(&lines)
        }
    }
}

/// The lexemes in groups that end with `;` or a brace.
fn statements(lexemes: Vec<String>) -> Vec<Vec<String>> {
    let mut groups = vec![Vec::new()];
    for lexeme in lexemes {
        let ends = matches!(lexeme.as_str(), ";" | "{" | "}");
        if let Some(last) = groups.last_mut() {
            last.push(lexeme);
        }
        if ends {
            groups.push(Vec::new());
        }
    }
    groups
}

/// The parts without all pieces whose absence keeps `holds` true; the parts as they are where it is not true of any
/// less.
pub fn fewest<T: Clone>(mut parts: Vec<T>, holds: &mut dyn FnMut(&[T]) -> bool) -> Vec<T> {
    let mut piece = parts.len().div_ceil(2);
    while piece > 0 {
        let mut at = 0;
        let before = parts.len();
        while at < parts.len() {
            let mut fewer = parts.clone();
            fewer.drain(at..parts.len().min(at + piece));
            if holds(&fewer) {
                parts = fewer;
            } else {
                at += piece;
            }
        }
        piece = if piece == 1 && parts.len() < before { 1 } else { piece / 2 };
    }
    parts
}
