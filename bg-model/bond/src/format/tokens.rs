//! A text as words, marks and comments, each with what stood before it.
//!
//! In: a text. Out: its tokens in their order, as they are written; nothing but blanks and line ends is lost. Comments
//! are what the tokens of the language leave between them.

use std::ops::Range;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A token or a comment.
#[derive(Clone, Debug)]
pub struct Token<'t> {
    pub text: &'t str,
    pub kind: TokenClass,
    /// Line ends before it.
    pub lines: usize,
    /// Whether anything is before it: blanks or line ends.
    pub is_apart: bool,
}

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenClass {
    Word,
    Literal,
    /// `;`, `->`
    Mark,
    /// `{`
    Open(Delimiter),
    /// `}`
    Close(Delimiter),
    /// `/// text`
    Documentation,
    /// `// text`, which ends its line.
    Line,
    /// `/* text */`
    Comment,
}

impl Token<'_> {
    pub fn is(&self, text: &str) -> bool {
        self.text == text
    }

    pub fn is_comment(&self) -> bool {
        matches!(self.kind, TokenClass::Line | TokenClass::Comment)
    }

    /// Whether nothing can come after it on its line.
    pub fn ends_line(&self) -> bool {
        self.kind == TokenClass::Line || (self.kind == TokenClass::Documentation && self.text.starts_with("//"))
    }
}

/// Marks of two characters.
const PAIRS: [&str; 11] = ["->", "=>", "<=", ">=", "==", "!=", "&&", "||", "**", "::", ".."];

/// The tokens and comments of a text, of which `stream` are the tokens.
pub fn tokens(text: &str, stream: TokenStream) -> Vec<Token<'_>> {
    let mut reading = Reading { text, at: 0, tokens: Vec::new() };
    reading.stream(stream);
    reading.gap(text.len());
    reading.tokens
}

struct Reading<'t> {
    text: &'t str,
    /// The end of what has been read.
    at: usize,
    tokens: Vec<Token<'t>>,
}

impl<'t> Reading<'t> {
    fn stream(&mut self, stream: TokenStream) {
        for tree in stream {
            match tree {
                TokenTree::Group(group) => {
                    let delimiter = group.delimiter();
                    self.token(group.span_open().byte_range(), TokenClass::Open(delimiter));
                    self.stream(group.stream());
                    self.token(group.span_close().byte_range(), TokenClass::Close(delimiter));
                }
                TokenTree::Ident(word) => self.token(word.span().byte_range(), TokenClass::Word),
                TokenTree::Literal(literal) => self.token(literal.span().byte_range(), TokenClass::Literal),
                TokenTree::Punct(mark) => self.token(mark.span().byte_range(), TokenClass::Mark),
            }
        }
    }

    /// A token after its gap. All tokens that a documentation comment stands for have its place.
    fn token(&mut self, place: Range<usize>, kind: TokenClass) {
        if place.start < self.at {
            return;
        }
        self.gap(place.start);
        let text = &self.text[place.clone()];
        let kind = if text.starts_with("//") || text.starts_with("/*") { TokenClass::Documentation } else { kind };
        let is_joint = kind == TokenClass::Mark && self.at == place.start;
        self.at = place.end;
        if is_joint
            && let Some(last) = self.tokens.last_mut()
            && let Some(pair) = self.text.get(place.start - last.text.len()..place.end)
            && last.kind == TokenClass::Mark
            && PAIRS.contains(&pair)
        {
            last.text = pair;
            return;
        }
        self.push(text, kind, place.start);
    }

    /// The comments before the place `end`.
    fn gap(&mut self, end: usize) {
        let mut from = self.at;
        while let Some(found) = self.text[from..end].find('/') {
            let start = from + found;
            let rest = &self.text[start..end];
            let (length, kind) = match rest.strip_prefix("//") {
                Some(_) => (rest.find('\n').unwrap_or(rest.len()), TokenClass::Line),
                None => (block(rest), TokenClass::Comment),
            };
            from = start + length;
            self.push(rest[..length].trim_end(), kind, start);
            self.at = from;
        }
    }

    fn push(&mut self, text: &'t str, kind: TokenClass, start: usize) {
        let end = self
            .tokens
            .last()
            .map_or(0, |last| last.text.as_ptr() as usize - self.text.as_ptr() as usize + last.text.len());
        let before = &self.text[end..start];
        self.tokens.push(Token { text, kind, lines: before.matches('\n').count(), is_apart: !before.is_empty() });
    }
}

/// The length of a comment `/* .. */`, with those inside.
fn block(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        match text.as_bytes()[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}
