//! How wide a label is, and how text stands in XML.
//!
//! In: text. Out: widths in tenths of a pixel; escaped text. The widths are those of DejaVu Sans, the widest of the
//! common sans-serif fonts, so that a label in any other of them is narrower than its place.

/// The width of `text` in tenths of a pixel at `size` pixels.
#[must_use]
pub(crate) fn width(text: &str, size: i32, is_bold: bool) -> i32 {
    let units: i32 = text.chars().map(|letter| if is_bold { advance(letter) + 8 } else { advance(letter) }).sum();
    units * size / 10
}

/// The advance of a letter in hundredths of the font's size.
fn advance(letter: char) -> i32 {
    match letter {
        'i' | 'j' | 'l' | '\'' => 28,
        ' ' | '.' | ',' | ':' | ';' | '|' | 'I' | '/' => 34,
        'f' | 't' | 'r' | '(' | ')' | '-' => 42,
        's' | '_' | 'c' | 'z' | 'J' => 55,
        'm' | 'M' | 'W' | '@' | '%' => 99,
        'w' | '+' | '=' | '<' | '>' | '~' | '^' | '#' | 'O' | 'Q' | 'G' | 'D' | 'N' | 'H' => 85,
        'A'..='Z' => 73,
        'a'..='z' | '0'..='9' | '*' => 64,
        _ => 100,
    }
}

/// `text` as the content of an XML element or of an attribute in double quotes.
#[must_use]
pub(crate) fn xml(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // No other control character may stand in XML.
            control if control.is_control() && control != '\n' => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}
