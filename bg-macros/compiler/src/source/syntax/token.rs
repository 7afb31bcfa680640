//! One level of a token stream as words, literals, symbols and closed groups.
//!
//! In: a [`TokenStream`]. Out: [`Token`]s, in which a symbol of two characters such as `->` is one token. A group stays
//! closed until the parser enters it, so that its depth costs nothing here.

use proc_macro2::{Delimiter, Group, Literal, Spacing, Span, TokenStream, TokenTree};

/// A token with its place.
#[derive(Clone, Debug)]
pub(super) struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Where it stands.
    pub span: Span,
}

/// What a token is.
#[derive(Clone, Debug)]
pub(super) enum TokenKind {
    /// `frame`, `param`, `in`.
    Word(String),
    /// `0.8`, `"text"`.
    Literal(Literal),
    /// `;`, `->`.
    Symbol(&'static str),
    /// `( ... )`, `[ ... ]`, `{ ... }`.
    Group(Group),
}

/// Rust's punctuation characters.
const SINGLE: &str = "=<>!~+-*/%^&|@.,;:#$?'";

/// The symbols of two characters that the language has, or that its users may expect of it.
const PAIRS: [&str; 11] = ["->", "=>", "<=", ">=", "==", "!=", "&&", "||", "**", "::", ".."];

/// The tokens of one level of `stream`.
pub(super) fn tokens(stream: TokenStream) -> Vec<Token> {
    let mut tokens: Vec<Token> = Vec::new();
    let mut joint = false;
    for tree in stream {
        let tree = without_invisible_delimiters(tree);
        let span = tree.span();
        let (kind, joins) = match tree {
            TokenTree::Ident(word) => (TokenKind::Word(word.to_string()), false),
            TokenTree::Literal(literal) => (TokenKind::Literal(literal), false),
            TokenTree::Group(group) => (TokenKind::Group(group), false),
            TokenTree::Punct(mark) => {
                if joint && let Some(symbol) = paired(tokens.last(), mark.as_char()) {
                    if let Some(first) = tokens.last_mut() {
                        *first = Token { kind: TokenKind::Symbol(symbol), span: joined(first.span, span) };
                    }
                    joint = false;
                    continue;
                }
                (TokenKind::Symbol(single(mark.as_char())), mark.spacing() == Spacing::Joint)
            }
        };
        joint = joins;
        tokens.push(Token { kind, span });
    }
    tokens
}

/// From the first span to the last, or the first where the compiler cannot join them.
pub(super) fn joined(first: Span, last: Span) -> Span {
    first.join(last).unwrap_or(first)
}

/// The one token that a fragment of `macro_rules!` stands for; a longer fragment stays a group.
fn without_invisible_delimiters(mut tree: TokenTree) -> TokenTree {
    while let TokenTree::Group(group) = &tree {
        if group.delimiter() != Delimiter::None {
            break;
        }
        let mut inner = group.stream().into_iter();
        match (inner.next(), inner.next()) {
            (Some(only), None) => tree = only,
            _ => break,
        }
    }
    tree
}

/// The symbol that `first` and a `second` character right after it make.
fn paired(first: Option<&Token>, second: char) -> Option<&'static str> {
    let Some(TokenKind::Symbol(first)) = first.map(|token| &token.kind) else { return None };
    PAIRS.into_iter().find(|pair| pair.starts_with(first) && first.len() == 1 && pair.ends_with(second))
}

/// A punctuation character as text.
fn single(mark: char) -> &'static str {
    SINGLE.find(mark).map_or("?", |at| &SINGLE[at..=at])
}

impl TokenKind {
    /// The token as a message names it.
    pub fn described(&self) -> String {
        match self {
            Self::Word(word) => format!("`{word}`"),
            Self::Literal(literal) => format!("`{literal}`"),
            Self::Symbol(symbol) => format!("`{symbol}`"),
            Self::Group(group) => match group.delimiter() {
                Delimiter::Parenthesis | Delimiter::None => "`( ... )`".into(),
                Delimiter::Bracket => "`[ ... ]`".into(),
                Delimiter::Brace => "`{ ... }`".into(),
            },
        }
    }

    /// Whether it is a text in quotes.
    pub fn is_text(&self) -> bool {
        matches!(self, Self::Literal(literal) if literal.to_string().starts_with('"'))
    }

    /// The literal's text when it is a number.
    pub fn number(&self) -> Option<String> {
        let Self::Literal(literal) = self else { return None };
        let text = literal.to_string();
        text.trim_start_matches('-').starts_with(|first: char| first.is_ascii_digit()).then_some(text)
    }
}
