//! What stands in front of a statement: documentation comments and visibility.

use proc_macro2::{Delimiter, Group, Span, TokenTree};

use super::{
    SyntaxFault,
    cursor::{Cursor, Parsed},
    token::{TokenKind, joined},
};
use crate::source::visibility::Visibility;

/// The documentation comment in front of a statement.
#[derive(Debug)]
pub(super) struct Documentation {
    /// Its lines joined by `\n`, each without its leading blank.
    pub text: String,
    /// Where it stands, when there is one.
    pub span: Option<Span>,
}

impl Cursor<'_> {
    /// The documentation comment ahead; notes attributes of other kinds.
    pub fn documentation(&mut self) -> Documentation {
        let (mut lines, mut span) = (Vec::new(), None);
        while self.is("#") {
            let inner = usize::from(self.symbol_ahead(1, "!"));
            let Some(TokenKind::Group(group)) = self.ahead(1 + inner) else { break };
            if group.delimiter() != Delimiter::Bracket {
                break;
            }
            let comment = comment(group);
            let start = self.advance();
            for _ in 0..=inner {
                self.advance();
            }
            match comment {
                Some(comment) if inner == 0 => {
                    span = Some(span.map_or(start, |first| joined(first, start)));
                    lines.extend(comment.split('\n').map(line));
                }
                Some(_) => drop(self.note(start, &SyntaxFault::MisplacedDocumentation)),
                None => drop(self.note(start, &SyntaxFault::Attribute)),
            }
        }
        if span.is_some() {
            self.note_beginning();
        }
        Documentation { text: lines.join("\n"), span }
    }

    /// `pub`, `pub(crate)` or nothing.
    pub fn visibility(&mut self) -> Parsed<Visibility> {
        let Some(span) = self.eat_word("pub") else { return Ok(Visibility::Private) };
        let visibility = match self.peek() {
            Some(TokenKind::Group(group)) if group.delimiter() == Delimiter::Parenthesis => {
                let within = Visibility::within(span, group);
                let visibility = within.ok_or_else(|| self.unexpected("`(crate)`, `(super)` or `(in PATH)`"))?;
                self.advance();
                visibility
            }
            _ => Visibility::Public(span),
        };
        self.note_beginning();
        Ok(visibility)
    }
}

/// The text of `[doc = "text"]`.
fn comment(group: &Group) -> Option<String> {
    let mut tokens = group.stream().into_iter();
    match (tokens.next(), tokens.next(), tokens.next(), tokens.next()) {
        (Some(TokenTree::Ident(doc)), Some(TokenTree::Punct(equals)), Some(TokenTree::Literal(text)), None)
            if doc == "doc" && equals.as_char() == '=' =>
        {
            match syn::Lit::new(text) {
                syn::Lit::Str(text) => Some(text.value()),
                _ => None,
            }
        }
        _ => None,
    }
}

/// A line of a comment without its leading blank, and without carriage returns, which no comment may contain.
fn line(text: &str) -> String {
    text.strip_prefix(' ').unwrap_or(text).replace('\r', "")
}
