//! A text as lexemes, and back.
//!
//! In: any text. Out: words, numbers, marks, brackets, documentation comments; joined again, all brackets closed, so
//! that a mutant is nearly always a token stream.

/// Marks of two characters that stay together.
const PAIRS: [&str; 8] = ["->", "<=", ">=", "==", "!=", "&&", "||", "**"];

/// The lexemes of a text; comments are left out, documentation comments are one lexeme each.
pub fn lexemes(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = length(rest, first);
        let (lexeme, behind) = rest.split_at(length);
        if !lexeme.starts_with("//") || lexeme.starts_with("///") {
            found.push(lexeme.to_owned());
        }
        rest = behind.trim_start();
    }
    found
}

/// The bytes of the lexeme that the text starts with.
fn length(text: &str, first: char) -> usize {
    if text.starts_with("//") {
        return text.find('\n').unwrap_or(text.len());
    }
    if first.is_ascii_digit() {
        return number_length(text);
    }
    if first.is_alphabetic() || first == '_' {
        return text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    }
    if PAIRS.iter().any(|pair| text.starts_with(pair)) { 2 } else { first.len_utf8() }
}

/// The bytes of a number, with a signed exponent.
fn number_length(text: &str) -> usize {
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        let signed = matches!(c, '+' | '-') && matches!(before, 'e' | 'E');
        if !(c.is_ascii_alphanumeric() || matches!(c, '.' | '_') || signed) {
            return at;
        }
        before = c;
    }
    text.len()
}

/// The lexemes as a text in which every bracket is closed: a stray closing one is left out.
pub fn joined(lexemes: &[String]) -> String {
    let mut text = String::new();
    let mut open = Vec::new();
    for lexeme in lexemes {
        match lexeme.as_str() {
            "(" => open.push(")"),
            "[" => open.push("]"),
            "{" => open.push("}"),
            ")" | "]" | "}" if open.last() != Some(&lexeme.as_str()) => continue,
            ")" | "]" | "}" => {
                open.pop();
            }
            _ => {}
        }
        text.push_str(lexeme);
        text.push(if lexeme.starts_with("///") { '\n' } else { ' ' });
    }
    while let Some(close) = open.pop() {
        text.push_str(close);
    }
    text
}
