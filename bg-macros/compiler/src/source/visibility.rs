//! Who may name what a graph or a part becomes: `pub`, `pub(crate)`, `pub(in some::path)`, or nothing.
//!
//! Read here and not by syn, whose type for it leads to all of Rust's syntax: a tenth of the compiler as WebAssembly.

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use quote::{ToTokens, TokenStreamExt, quote_spanned};

/// Who may name it.
#[derive(Clone, Debug)]
pub enum Visibility {
    /// The module alone.
    Private,
    /// Everybody.
    Public(Span),
    /// What stands in the brackets: `crate`, `self`, `super`, or `in` and a path.
    Within(Span, Group),
}

impl Visibility {
    /// That of `pub` with brackets; `None` where they say something else.
    #[must_use]
    pub fn within(span: Span, brackets: &Group) -> Option<Self> {
        let words = words(brackets);
        let is_known = match words.split_first().map(|(first, path)| (first.as_str(), path)) {
            Some(("crate" | "self" | "super", [])) => true,
            Some(("in", path)) => {
                let text = path.concat();
                let starts_a_name = |name: &str| name.starts_with(|c: char| c.is_alphabetic() || c == '_');
                let is_word = |name: &str| starts_a_name(name) && path.iter().any(|word| word == name);
                text.strip_prefix("::").unwrap_or(&text).split("::").all(is_word)
            }
            _ => false,
        };
        let is_known = is_known && brackets.delimiter() == Delimiter::Parenthesis;
        is_known.then(|| Self::Within(span, brackets.clone()))
    }

    /// The words in front of `graph` or `part`.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Private => String::new(),
            Self::Public(_) => "pub ".to_owned(),
            Self::Within(_, brackets) => match words(brackets).split_first() {
                Some((first, path)) if !path.is_empty() => format!("pub({first} {}) ", path.concat()),
                first => format!("pub({}) ", first.map_or("", |(first, _)| first.as_str())),
            },
        }
    }
}

/// The words in the brackets; what is in brackets itself, of whatever depth, is `()`.
fn words(brackets: &Group) -> Vec<String> {
    let word = |tree: TokenTree| if matches!(tree, TokenTree::Group(_)) { "()".to_owned() } else { tree.to_string() };
    brackets.stream().into_iter().map(word).collect()
}

impl ToTokens for Visibility {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        match self {
            Self::Private => {}
            Self::Public(span) => tokens.append_all(quote_spanned!(*span=> pub)),
            Self::Within(span, brackets) => tokens.append_all(quote_spanned!(*span=> pub #brackets)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_hold_a_place_or_a_path() {
        let read = |text: &str| {
            let group = text.parse::<TokenStream>().unwrap().into_iter().next().unwrap();
            let TokenTree::Group(group) = group else { panic!("{text}") };
            Visibility::within(Span::call_site(), &group).map(|visibility| visibility.text())
        };
        for text in ["(crate)", "(super)", "(self)", "(in a)", "(in a::b)", "(in ::a::r#in)", "(in crate::a)"] {
            assert_eq!(read(text), Some(format!("pub{text} ")));
        }
        for text in [
            "()",
            "(all)",
            "(crate::a)",
            "(in)",
            "(in a b)",
            "(in a:b)",
            "(in a::)",
            "(in a::(b))",
            "(in a (b))",
            "(in 3)",
            "[crate]",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
