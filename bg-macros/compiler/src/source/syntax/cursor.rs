//! Walks over the tokens of one block, notes faults, and finds the next statement after one.
//!
//! In: one level of tokens. Out: names, groups and the ends of statements, for the modules that know the grammar. A
//! reader that fails has noted its fault, once; the statement's driver skips to the end of the statement (panic mode
//! with `;` and closing braces as synchronizing tokens, Aho, Lam, Sethi, Ullman, Compilers, section 4.1.4).

use std::cell::RefCell;

use proc_macro2::{Delimiter, Group, Span, TokenStream};

use super::{
    SyntaxFault,
    token::{Token, TokenKind, joined, tokens},
};
use crate::fault::{Fault, Faults};
use crate::source::ast::{Heard, Name, Spoken, Words};
use crate::source::names::is_reserved;
use crate::source::numbers::symbol_for;

/// The proof that a fault has been noted.
#[derive(Debug)]
pub(super) struct Reported(());

/// What a reader gives; when it fails, its fault has been noted.
pub(super) type Parsed<T> = Result<T, Reported>;

/// A kind of block: what it is called and what stands in it.
#[derive(Debug)]
pub(in crate::source) struct Block {
    /// `a graph`, for messages.
    pub name: &'static str,
    /// The words that begin a statement.
    pub words: &'static [&'static str],
    /// Whether its entries are separated by `,` or `;`, rather than each ended by `;`.
    pub list: bool,
}

/// The words of statements that end with their block.
pub const BLOCKS: [&str; 18] = [
    "graph", "observe", "scene", "ground", "body", "joint", "spring", "drive", "contact", "friction", "stop",
    "orifice", "every", "tune", "without", "rigid", "part", "for",
];

/// What is noted on the way.
#[derive(Debug, Default)]
pub(super) struct Noted {
    pub faults: Faults,
    /// Names that end with a dot.
    pub unfinished: Vec<Name>,
    /// Words of the language.
    pub heard: Heard,
}

/// A walk over one level of tokens.
#[derive(Debug)]
pub(super) struct Cursor<'f> {
    tokens: Vec<Token>,
    at: usize,
    /// The first token of the present statement.
    head: usize,
    /// The closing brace; the last token of the macro call.
    close: Span,
    place: &'static Block,
    /// How deeply the current expression is nested.
    pub depth: usize,
    /// The repetition that the name of the present statement asks for, `pin[i in 1..20]`.
    pub repetition: Option<Repetition>,
    noted: &'f RefCell<Noted>,
}

/// An index with the two ends of its numbers.
pub(super) type Repetition = [Name; 3];

impl<'f> Cursor<'f> {
    /// A walk over the whole macro call.
    pub fn new(stream: TokenStream, place: &'static Block, noted: &'f RefCell<Noted>) -> Self {
        let tokens = tokens(stream);
        let close = tokens.last().map_or_else(Span::call_site, |last| last.span);
        Self { tokens, at: 0, head: 0, close, place, depth: 0, repetition: None, noted }
    }

    /// The token ahead.
    pub fn peek(&self) -> Option<&TokenKind> {
        self.ahead(0)
    }

    /// The token `distance` tokens ahead.
    pub fn ahead(&self, distance: usize) -> Option<&TokenKind> {
        self.tokens.get(self.at + distance).map(|token| &token.kind)
    }

    /// Whether no token is left.
    pub fn ended(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// The kind of the block.
    pub fn place(&self) -> &'static Block {
        self.place
    }

    /// Where the token ahead stands, or the block's end.
    pub fn span(&self) -> Span {
        self.tokens.get(self.at).map_or(self.close, |token| token.span)
    }

    /// Where the last token that was read stands.
    pub fn last_span(&self) -> Span {
        self.at.checked_sub(1).and_then(|last| self.tokens.get(last)).map_or(self.close, |token| token.span)
    }

    /// Steps over the token ahead and gives its place.
    pub fn advance(&mut self) -> Span {
        let span = self.span();
        self.at += 1;
        span
    }

    /// The word ahead.
    pub fn word(&self) -> Option<&str> {
        self.word_ahead(0)
    }

    /// The word `distance` tokens ahead.
    pub fn word_ahead(&self, distance: usize) -> Option<&str> {
        match self.ahead(distance) {
            Some(TokenKind::Word(word)) => Some(word),
            _ => None,
        }
    }

    /// Whether the token `distance` tokens ahead is `symbol`.
    pub fn symbol_ahead(&self, distance: usize, symbol: &str) -> bool {
        matches!(self.ahead(distance), Some(TokenKind::Symbol(found)) if *found == symbol)
    }

    /// Whether the token ahead is `symbol`.
    pub fn is(&self, symbol: &str) -> bool {
        self.symbol_ahead(0, symbol)
    }

    /// Steps over `symbol` when it is ahead.
    pub fn eat(&mut self, symbol: &str) -> Option<Span> {
        self.is(symbol).then(|| self.advance())
    }

    /// Steps over `word` when it is ahead.
    pub fn eat_word(&mut self, word: &str) -> Option<Span> {
        (self.word() == Some(word)).then(|| self.advance_word())
    }

    /// Steps over the token ahead, a word of the language, and gives its place.
    pub fn advance_word(&mut self) -> Span {
        self.note_word(self.at);
        self.advance()
    }

    fn spoken(&self, at: usize) -> Option<Spoken> {
        match self.tokens.get(at) {
            Some(Token { kind: TokenKind::Word(word), span }) => {
                let Block { name: block, words: beginnings, .. } = self.place;
                Some(Spoken { block, beginnings, word: Name::new(word.clone(), *span) })
            }
            _ => None,
        }
    }

    /// Notes that the token at this place is a word of the language, where it is a word.
    fn note_word(&self, at: usize) {
        let spoken = self.spoken(at);
        self.noted.borrow_mut().heard.words.extend(spoken);
    }

    /// Steps over `symbol`, which must be ahead.
    pub fn expect(&mut self, symbol: &str) -> Parsed<Span> {
        self.eat(symbol).ok_or_else(|| self.unexpected(&format!("`{symbol}`")))
    }

    /// Steps over `word`, which must be ahead.
    pub fn expect_word(&mut self, word: &str) -> Parsed<Span> {
        self.eat_word(word).ok_or_else(|| self.unexpected(&format!("`{word}`")))
    }

    /// The delimiter of the group ahead.
    pub fn delimiter(&self) -> Option<Delimiter> {
        match self.peek() {
            Some(TokenKind::Group(group)) => Some(group.delimiter()),
            _ => None,
        }
    }

    /// The group in brackets `distance` tokens ahead.
    pub fn brackets(&self, distance: usize) -> Option<&Group> {
        match self.ahead(distance) {
            Some(TokenKind::Group(group)) if group.delimiter() == Delimiter::Bracket => Some(group),
            _ => None,
        }
    }

    /// Enters the group ahead when it has this delimiter.
    pub fn enter(&mut self, delimiter: Delimiter, place: &'static Block) -> Option<Self> {
        let inner = match self.peek() {
            Some(TokenKind::Group(group)) if group.delimiter() == delimiter => Self {
                tokens: tokens(group.stream()),
                at: 0,
                head: 0,
                close: group.span_close(),
                place,
                depth: self.depth,
                repetition: None,
                noted: self.noted,
            },
            _ => return None,
        };
        self.advance();
        Some(inner)
    }

    /// Enters the group that must be ahead; `form` shows it to the user.
    pub fn group(&mut self, delimiter: Delimiter, form: &str, place: &'static Block) -> Parsed<Self> {
        self.enter(delimiter, place).ok_or_else(|| self.unexpected(form))
    }

    /// Sees to it that a group has been read to its end.
    pub fn finish(&self, expected: &str) -> Parsed<()> {
        if self.ended() { Ok(()) } else { Err(self.unexpected(expected)) }
    }

    /// Notes a fault at `span`.
    pub fn note(&self, span: Span, kind: &SyntaxFault) -> Reported {
        self.noted.borrow_mut().faults.push(Fault::new(span, kind));
        Reported(())
    }

    /// The token ahead as a message names it.
    pub fn found(&self) -> String {
        self.peek().map_or_else(|| format!("the end of {}", self.place.name), TokenKind::described)
    }

    /// Notes that the token ahead is not what it should be.
    pub fn unexpected(&self, expected: &str) -> Reported {
        self.note(self.span(), &SyntaxFault::Unexpected { found: self.found(), expected: expected.into() })
    }

    /// Notes that the token ahead begins no statement of this block.
    pub fn unknown_statement(&self) -> Reported {
        let word = match self.peek() {
            Some(TokenKind::Word(word)) => {
                let spoken = self.spoken(self.at);
                self.noted.borrow_mut().heard.unknown.extend(spoken);
                self.whole_clause(word)
            }
            Some(TokenKind::Literal(literal)) => literal.to_string(),
            _ => return self.unexpected(&format!("a statement of {}", self.place.name)),
        };
        let fault = SyntaxFault::UnknownStatement { place: self.place.name, word, known: self.place.words };
        self.note(self.span(), &fault)
    }

    /// The word ahead, with the next one where the language knows it only in front of another: `tilt stifness`.
    fn whole_clause(&self, word: &str) -> String {
        let is_first =
            self.place.words.iter().any(|known| known.split_once(' ').is_some_and(|(first, _)| first == word));
        match self.word_ahead(1) {
            Some(next) if is_first => format!("{word} {next}"),
            _ => word.to_owned(),
        }
    }

    /// Fills an empty slot; notes a clause that stands twice.
    pub fn fill<T>(&self, slot: &mut Option<T>, value: T, clause: &str, span: Span) {
        if slot.is_some() {
            self.note(span, &SyntaxFault::Duplicate { clause: format!("`{clause}`") });
        } else {
            *slot = Some(value);
        }
    }
}

/// Names.
impl Cursor<'_> {
    /// A name, possibly dotted, possibly with numbers in brackets; `what` says whose.
    pub fn name(&mut self, what: &str) -> Parsed<Name> {
        let mut name = self.first_word(what)?;
        self.dotted(&mut name, &|cursor| cursor.brackets(0).is_some())?;
        Ok(name)
    }

    /// The first word of a name; `what` says whose.
    pub fn first_word(&mut self, what: &str) -> Parsed<Name> {
        let Some(first) = self.word().map(str::to_owned) else {
            return Err(self.unexpected(&format!("a name for {what}")));
        };
        if is_reserved(&first) {
            return Err(self.note(self.span(), &SyntaxFault::ReservedName { name: first }));
        }
        Ok(Name::new(first, self.advance()))
    }

    /// The rest of a name after its first word; `is_index` says whether the group ahead has a number of the name.
    pub fn dotted(&mut self, name: &mut Name, is_index: &dyn Fn(&Self) -> bool) -> Parsed<()> {
        let mut end = name.span;
        let mut words = vec![name.span];
        let first = self.at;
        loop {
            if is_index(self) {
                end = self.span();
                name.text += &self.index()?;
            } else if self.eat(".").is_some() {
                let Some(segment) = self.word() else {
                    self.noted.borrow_mut().unfinished.push(Name { words: Words(words), ..name.clone() });
                    return Err(self.unexpected("a component such as `x`"));
                };
                name.text.push('.');
                name.text.push_str(segment);
                end = self.advance();
                words.push(end);
            } else {
                if self.at > first {
                    name.words = Words(words);
                }
                name.span = joined(name.span, end);
                return Ok(());
            }
        }
    }

    /// A name without dots; `what` says whose.
    pub fn plain_name(&mut self, what: &'static str) -> Parsed<Name> {
        let name = self.name(what)?;
        if !name.text.contains(['.', '[']) {
            return Ok(name);
        }
        let instead = crate::source::names::field(&name.text);
        Err(self.note(name.span, &SyntaxFault::DottedName { what, name: name.text, instead }))
    }

    /// The names of `{ a, b }`; what is no name is a fault and left out.
    pub fn names(&mut self, what: &'static str) -> Vec<Name> {
        let mut names = Vec::new();
        self.statements(|entry| {
            names.push(entry.name(what)?);
            entry.end_statement("`,`");
            Ok(())
        });
        names
    }

    /// Whether a name and a half arrow are ahead.
    pub fn starts_chain(&self) -> bool {
        self.after_name().is_some_and(|after| self.symbol_ahead(after, "->"))
    }

    /// How far it is to what follows the name ahead.
    pub fn after_name(&self) -> Option<usize> {
        let mut distance = 0;
        while self.word_ahead(distance).is_some() {
            distance += 1;
            while self.brackets(distance).is_some() {
                distance += 1;
            }
            if !self.symbol_ahead(distance, ".") {
                return Some(distance);
            }
            distance += 1;
        }
        None
    }

    /// Whether `0 NAME` or `1 NAME` is ahead.
    pub fn starts_junction(&self) -> bool {
        let number = self.peek().and_then(TokenKind::number);
        number.is_some_and(|text| text == "0" || text == "1") && self.word_ahead(1).is_some()
    }
}

/// Statements.
impl Cursor<'_> {
    /// Reads entry for entry to the block's end; after a faulty one it goes on with the next.
    pub fn statements(&mut self, mut statement: impl FnMut(&mut Self) -> Parsed<()>) {
        while !self.ended() {
            if self.eat_separator() {
                continue;
            }
            self.head = self.at;
            self.note_beginning();
            if statement(self).is_err() {
                self.skip_statement();
            }
            if self.at == self.head {
                self.advance();
            }
        }
    }

    /// Notes the word of the language ahead, where a statement begins with it.
    pub fn note_beginning(&self) {
        if !self.starts_chain() && self.starts_statement() {
            self.note_word(self.at);
        }
    }

    /// Steps over the statement's end, or notes what stands there; `expected` says what else could.
    pub fn end_statement(&mut self, expected: &str) {
        if self.eat_separator() || (self.place.list && self.ended()) {
            return;
        }
        if self.ended() || self.starts_statement() {
            let last = self.at.checked_sub(1).and_then(|last| self.tokens.get(last));
            let text = last.map_or_else(String::new, |token| token.kind.described());
            self.note(self.last_span(), &SyntaxFault::MissingSemicolon { last: text });
            return;
        }
        if let Some(fault) = self.bare_vector().or_else(|| self.unit_of_number()) {
            self.note(self.span(), &fault);
            self.skip_statement();
            return;
        }
        self.unexpected(&if expected.is_empty() { "`;`".to_owned() } else { format!("{expected} or `;`") });
        self.skip_statement();
    }

    /// The fault of a `,` where a value has ended and no list goes on.
    pub fn bare_vector(&self) -> Option<SyntaxFault> {
        let is_value = self.at.checked_sub(1).and_then(|last| self.tokens.get(last)).is_some_and(|token| {
            matches!(token.kind, TokenKind::Literal(_))
                || matches!(&token.kind, TokenKind::Group(group) if group.delimiter() == Delimiter::Parenthesis)
        });
        (is_value && self.is(",")).then_some(SyntaxFault::BareVector)
    }

    /// The fault of a word after a number that is nearly a unit.
    pub fn unit_of_number(&self) -> Option<SyntaxFault> {
        let last = self.at.checked_sub(1).and_then(|last| self.tokens.get(last))?;
        let (number, word) = (last.kind.number()?, self.word()?.to_owned());
        let unit = symbol_for(&word)?;
        Some(SyntaxFault::UnitOfNumber { number, word, unit })
    }

    /// Whether a statement of this block begins here.
    pub fn starts_statement(&self) -> bool {
        let begins = |word: &str| self.place.words.iter().any(|known| known.split(' ').next() == Some(word));
        !self.place.list && (self.word().is_some_and(begins) || self.starts_chain() || self.starts_junction())
    }

    /// Steps over `;`, in a list also over `,`.
    fn eat_separator(&mut self) -> bool {
        self.eat(";").is_some() || (self.place.list && self.eat(",").is_some())
    }

    /// Skips to the statement's end: after its `;`, or after its block.
    fn skip_statement(&mut self) {
        let head = match self.tokens.get(self.head).map(|token| &token.kind) {
            Some(TokenKind::Word(word)) => word.as_str(),
            _ => "",
        };
        let ends_with_block = BLOCKS.contains(&head) || !self.place.words.contains(&head);
        while !self.ended() && !self.eat_separator() {
            let block = self.delimiter() == Some(Delimiter::Brace);
            self.advance();
            let goes_on = self.word() == Some("else") || ["+", "-", "*", "/"].iter().any(|symbol| self.is(symbol));
            if block && ends_with_block && !goes_on {
                return;
            }
        }
    }
}
