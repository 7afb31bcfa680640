//! Parts: what they are, where they are used, ports, starts from outside, repetitions.
//!
//! In: `part NAME { ... }` of a call; `part NAME: PART { ... }`, `port`, `start`, `for` of a block. Out: their trees.

use proc_macro2::{Delimiter, Ident, Punct, Spacing, Span, TokenStream, TokenTree};

use super::{
    SyntaxFault,
    cursor::{Block, Cursor, Parsed, Repetition},
    documentation::Documentation,
    statement::{self, OPERATOR},
    token::{TokenKind, joined, tokens},
};
use crate::source::ast::{
    Argument, For, Foreign, Item, Junction, JunctionKind, Name, Part, PartPath, Port, Source, Start, StartKind, Use,
    Written,
};
use crate::source::names::is_reserved;
use crate::source::visibility::Visibility;
use crate::source::words::{STARTS, value_of};

/// The block of a use.
pub(super) const USE: Block = Block { name: "the use of a part", words: &["start"], list: true };

/// Inside of `[i + 1]`.
const INDEX: Block = Block { name: "the brackets", words: &[], list: false };

/// The path of a part of another call.
const PATH: Block = Block { name: "the path", words: &[], list: false };

/// The domains in which things meet at an effort, so that a port is a 0-junction where nothing else is said.
const OF_ONE_EFFORT: [&str; 3] = ["electrical", "hydraulic", "thermal"];

/// Rust's words of a path.
const RELATIVE: [&str; 3] = ["crate", "self", "super"];

/// What can be named in brackets.
const NUMBER: &str = "a whole number";

/// Of a macro call.
impl Cursor<'_> {
    /// `part NAME { ... }`, after its documentation and visibility.
    pub fn part(&mut self, docs: String, visibility: Visibility, source: &mut Source) -> Parsed<()> {
        let word = Ident::new("part", self.advance());
        let name = self.plain_name("the part")?;
        let body = if let Some(TokenKind::Group(group)) = self.peek() { Some(group.clone()) } else { None };
        let block = self.group(Delimiter::Brace, "`{ ... }`", &statement::PART)?;
        let head = [TokenTree::from(word), Ident::new(&name.text, name.span).into()];
        let written = Written(head.into_iter().chain(body.map(TokenTree::from)).collect());
        source.parts.push(Part { docs, visibility, name, items: statement::items(block), written });
        Ok(())
    }

    /// `use "parts/shaft.bond";`, after its documentation: a fault of one kind or another, as [`files`](super::files)
    /// has taken it out of a file.
    pub fn used_file(&mut self, documentation: &Documentation) -> Parsed<()> {
        if let Some(span) = documentation.span {
            return Err(self.note(span, &SyntaxFault::MisplacedDocumentation));
        }
        let start = self.advance();
        let is_path = matches!(self.peek(), Some(TokenKind::Literal(path)) if path.to_string().starts_with('"'));
        if !is_path {
            return Err(self.unexpected("a file in quotes, such as `\"parts/shaft.bond\"`"));
        }
        self.advance();
        self.expect(";")?;
        self.note(start, &SyntaxFault::UseInCall);
        Ok(())
    }

    /// `@from { PATH } { part ... }`: what another macro call has answered.
    pub fn foreign(&mut self, source: &mut Source) -> Parsed<()> {
        self.advance();
        self.expect_word("from")?;
        let mut path = self.group(Delimiter::Brace, "`{ PATH }`", &PATH)?;
        let PartPath { name: path, written } = path.part_path()?;
        let mut block = self.group(Delimiter::Brace, "`{ ... }`", &super::CALL)?;
        let mut answer = Source::default();
        block.statements(|entry| super::declaration(entry, &mut answer));
        source.foreign.push(Foreign { path, written, source: answer });
        Ok(())
    }
}

/// Of a block.
impl Cursor<'_> {
    /// `part NAME: PART { ... }`, `part PART;`
    pub fn part_use(&mut self) -> Parsed<Use> {
        self.advance();
        let is_named = self.after_name().is_some_and(|after| self.symbol_ahead(after, ":"));
        let name = if is_named { Some(self.used_as()?) } else { None };
        let (name, count) = name.map_or((None, None), |(name, count)| (Some(name), count));
        let part = self.part_path()?;
        let mut used = Use { name, count, part, arguments: Vec::new(), starts: Vec::new() };
        match self.enter(Delimiter::Brace, &USE) {
            Some(mut block) => block.statements(|entry| entry.use_entry(&mut used)),
            None => self.end_statement("`{ ... }`"),
        }
        Ok(used)
    }

    /// `NAME:` or `NAME[20]:`, whose number is how many there are.
    fn used_as(&mut self) -> Parsed<(Name, Option<(usize, Span)>)> {
        let is_count = |cursor: &Self| cursor.has_number() && cursor.symbol_ahead(1, ":");
        let name = self.declared_until("the part", &is_count)?;
        let count = match self.enter(Delimiter::Bracket, &INDEX) {
            Some(mut inside) => {
                let digits = inside.peek().and_then(TokenKind::number).and_then(|digits| digits.parse().ok());
                Some((digits.ok_or_else(|| inside.unexpected(NUMBER))?, inside.advance()))
            }
            None => None,
        };
        self.expect(":")?;
        Ok((name, count))
    }

    /// `Leg`, `other_crate::Leg`
    fn part_path(&mut self) -> Parsed<PartPath> {
        let start = self.span();
        let (mut text, mut tokens) = (String::new(), TokenStream::new());
        loop {
            if let Some(span) = self.eat("::") {
                text.push_str("::");
                tokens.extend([Spacing::Joint, Spacing::Alone].map(|spacing| colon(spacing, span)));
            }
            let Some(word) = self.word().map(str::to_owned) else { return Err(self.unexpected("the name of a part")) };
            if is_reserved(&word) && !RELATIVE.contains(&word.as_str()) {
                return Err(self.note(self.span(), &SyntaxFault::ReservedName { name: word }));
            }
            tokens.extend([TokenTree::from(Ident::new(&word, self.span()))]);
            text.push_str(&word);
            let end = self.advance();
            if !self.is("::") {
                let name = Name::new(text, joined(start, end));
                return Ok(PartPath { name, written: Written(tokens) });
            }
        }
    }

    /// `NAME = E` or `start BODY at E`
    fn use_entry(&mut self, used: &mut Use) -> Parsed<()> {
        if self.word() == Some("start") && !self.symbol_ahead(1, "=") {
            let start = self.start_outside()?;
            used.starts.push(start);
            return Ok(());
        }
        let name = self.name("the parameter")?;
        self.expect("=")?;
        let value = self.expression()?;
        if used.arguments.iter().any(|known| known.name.text == name.text) {
            self.note(name.span, &SyntaxFault::Duplicate { clause: format!("`{}`", name.text) });
        }
        used.arguments.push(Argument { name, value });
        self.end_statement("an operator, `,`");
        Ok(())
    }

    /// `start BODY at E;` and its like.
    pub fn start_outside(&mut self) -> Parsed<Start> {
        const EXPECTED: &str = "`at`, `turned`, `velocity` or `spin`";
        self.advance();
        let of = self.name("the body")?;
        if of.text.ends_with(".displacement") {
            return Err(self.note(of.span, &SyntaxFault::StartOfDisplacement { name: of.text }));
        }
        let kind = self.word().and_then(|word| value_of(&STARTS, word));
        let Some(kind) = kind else { return Err(self.unexpected(EXPECTED)) };
        self.advance();
        let is_motion = matches!(kind, StartKind::Velocity | StartKind::Spin);
        let value = if is_motion { self.motion()? } else { self.expression()? };
        self.end_statement(OPERATOR);
        Ok(Start { of, kind, value })
    }

    /// `port NAME: DOMAIN;`, `port 0 NAME[3]: DOMAIN;`, `port NAME = PATH;`
    pub fn port(&mut self) -> Parsed<Port> {
        self.advance();
        let kind = self.junction_kind();
        let name = self.declared_junction("the port")?;
        if kind.is_none() && self.eat("=").is_some() {
            let of = self.name("what the port is")?;
            self.end_statement("");
            return Ok(Port::Alias(name, of));
        }
        let cardinality = self.cardinality()?;
        self.expect(":")?;
        let domain = self.name("the domain")?;
        self.end_statement("");
        let is_of_effort = OF_ONE_EFFORT.contains(&domain.text.as_str());
        let kind = kind.unwrap_or(if is_of_effort { JunctionKind::Zero } else { JunctionKind::One });
        Ok(Port::Junction(Junction { kind, name, cardinality, domain: Some(domain) }))
    }

    /// `for i in 1..20 { ... }`
    pub fn repetition(&mut self) -> Parsed<For> {
        self.advance();
        let [index, from, to] = self.range(&|inside| inside.delimiter() == Some(Delimiter::Brace))?;
        let block = self.group(Delimiter::Brace, "`{ ... }`", self.place())?;
        Ok(For { index, from, to, items: statement::items(block) })
    }
}

/// Indices.
impl Cursor<'_> {
    /// The name that a statement declares, with the index or the indices of an array.
    pub fn declared(&mut self, what: &'static str) -> Parsed<Name> {
        self.declared_until(what, &|_| false)
    }

    /// The name of a junction: numbers in brackets at its end are its cardinality.
    pub fn declared_junction(&mut self, what: &'static str) -> Parsed<Name> {
        let goes_on = |cursor: &Self| cursor.symbol_ahead(1, ".") || cursor.brackets(1).is_some();
        self.declared_until(what, &|cursor| cursor.has_number() && !goes_on(cursor))
    }

    /// A declared name up to the brackets of which `ends` says that they are something else.
    fn declared_until(&mut self, what: &'static str, ends: &dyn Fn(&Self) -> bool) -> Parsed<Name> {
        let mut name = self.first_word(what)?;
        let is_index = |cursor: &Self| cursor.brackets(0).is_some() && !cursor.has_range() && !ends(cursor);
        self.dotted(&mut name, &is_index)?;
        if self.has_range()
            && let Some(mut inside) = self.enter(Delimiter::Bracket, &INDEX)
        {
            let range = inside.range(&Cursor::ended)?;
            name.text += &format!("[{}]", range[0].text);
            self.repetition = Some(range);
        }
        Ok(name)
    }

    /// `i in 1..20`, up to where `ends` says.
    fn range(&mut self, ends: &dyn Fn(&Self) -> bool) -> Parsed<Repetition> {
        let index = self.first_word("the index")?;
        self.expect_word("in")?;
        let from = self.sum(&|inside| inside.is(".."))?;
        self.expect("..")?;
        let to = self.sum(ends)?;
        Ok([index, from, to])
    }

    /// `[i + 1]` as text.
    pub fn index(&mut self) -> Parsed<String> {
        let mut inside = self.group(Delimiter::Bracket, "`[ ... ]`", &INDEX)?;
        Ok(format!("[{}]", inside.sum(&Cursor::ended)?.text))
    }

    /// A sum of products of whole numbers and indices, up to where `ends` says; one blank between its words.
    fn sum(&mut self, ends: &dyn Fn(&Self) -> bool) -> Parsed<Name> {
        let start = self.span();
        let mut words = vec![self.factor()?];
        while !ends(self) {
            let operator = ["+", "-", "*"].into_iter().find(|operator| self.is(operator));
            let Some(operator) = operator else { return Err(self.unexpected("`+`, `-` or `*`")) };
            self.advance();
            words.extend([operator.to_owned(), self.factor()?]);
        }
        Ok(Name::new(words.join(" "), joined(start, self.last_span())))
    }

    /// `20` or `i`
    fn factor(&mut self) -> Parsed<String> {
        let digits = self.peek().and_then(TokenKind::number).filter(|text| text.bytes().all(|b| b.is_ascii_digit()));
        let Some(text) = digits.or_else(|| self.word().map(str::to_owned)) else {
            return Err(self.unexpected(NUMBER));
        };
        self.advance();
        Ok(text)
    }

    /// Whether `[20]` is ahead.
    fn has_number(&self) -> bool {
        let inside = self.brackets(0).map(|group| tokens(group.stream()));
        matches!(inside.as_deref(), Some([only]) if only.kind.number().is_some())
    }

    /// Whether `[i in 0..20]` is ahead.
    fn has_range(&self) -> bool {
        let inside = self.brackets(0).map(|group| tokens(group.stream()));
        matches!(inside.as_deref(), Some([_, second, ..]) if matches!(&second.kind,
            TokenKind::Word(word) if word == "in"))
    }
}

/// The statements that `items` has from `first` on, repeated as the name of the statement asks for.
pub(super) fn repeated(items: &mut Vec<Item>, first: usize, repetition: Option<Repetition>) {
    let Some([index, from, to]) = repetition else { return };
    let statements = items.split_off(first);
    items.push(Item::For(For { index, from, to, items: statements }));
}

fn colon(spacing: Spacing, span: Span) -> TokenTree {
    let mut colon = Punct::new(':', spacing);
    colon.set_span(span);
    colon.into()
}
