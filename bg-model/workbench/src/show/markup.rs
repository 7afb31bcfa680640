//! Texts as HTML.

use std::fmt::Write;

/// `text` as it stands between tags and in attributes.
#[must_use]
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A text, escaped, with what stands between backticks as code.
#[must_use]
pub fn with_code(text: &str) -> String {
    let parts = text.split('`').map(escaped).enumerate();
    parts.map(|(k, part)| if k % 2 == 1 { format!("<code>{part}</code>") } else { part }).collect()
}

pub(crate) fn write_into(page: &mut String, text: std::fmt::Arguments) {
    page.write_fmt(text).expect("writing to a string cannot fail");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_stands_between_backticks() {
        assert_eq!(
            with_code("the tip is `a<b` below & `c"),
            "the tip is <code>a&lt;b</code> below &amp; <code>c</code>"
        );
    }
}
