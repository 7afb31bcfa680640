//! The bond-graph words: parameters, inputs, junctions, elements, chains of half arrows, tracks.
//!
//! In: the block of a graph. Out: its [`Item`]s; the mechanism words and scenes are read by their own modules.

use proc_macro2::Delimiter;

use super::{
    SyntaxFault,
    cursor::{Block, Cursor, Parsed},
    token::TokenKind,
};
use crate::fault::near_miss;
use crate::source::ast::{
    Bound, Choice, Close, Direction, Element, ElementKind, Every, Expression, ExpressionKind, Held, Input, Item,
    Junction, JunctionKind, LawVariable, Let, Memory, Name, Parameter, Sample, State, Table, Track, TrackKind, Unit,
};
use crate::source::words::{BETWEEN, BEYOND, ELEMENTS, ROLES, TRACKS, value_of};

/// The block of a graph.
pub(super) const GRAPH: Block = Block { name: "a graph", words: &WORDS, list: false };

/// The block of a part: without scenes, with ports.
pub(super) const PART: Block = Block { name: "a part", words: WORDS_OF_PART, list: false };

/// The words of a part: those of a graph without the last one, with the port's in place of the scene's.
const WORDS_OF_PART: &[&str] = {
    const WORDS_OF_PART: [&str; WORDS.len()] = {
        let mut words = WORDS;
        words[4] = "port";
        words
    };
    WORDS_OF_PART.split_last().expect("there are words").1
};

/// The words of a graph.
const WORDS: [&str; 43] = [
    "param",
    "1",
    "R",
    "body",
    "scene",
    "input",
    "let",
    "table",
    "state",
    "memory",
    "every",
    "0",
    "Se",
    "Sf",
    "I",
    "C",
    "TF",
    "GY",
    "MSe",
    "MSf",
    "rSe",
    "MTF",
    "MGY",
    "MR",
    "position",
    "orientation",
    "close",
    "observe",
    "ground",
    "gravity",
    "start",
    "baumgarte",
    "expect",
    "joint",
    "spring",
    "drive",
    "contact",
    "friction",
    "stop",
    "orifice",
    "part",
    "for",
    "scenes",
];

/// The block of a clock.
pub(super) const EVERY: Block = Block { name: "`every`", words: &["sample"], list: false };

/// Inside of `[3]` and `(effort u)`.
const GROUP: Block = Block { name: "the group", words: &[], list: false };

/// What may follow an expression, besides `;`.
pub(super) const OPERATOR: &str = "an operator";

/// The items of a graph's block.
pub(super) fn items(mut block: Cursor) -> Vec<Item> {
    let mut items = Vec::new();
    block.statements(|cursor| {
        let first = items.len();
        let read = item(cursor, &mut items);
        super::part::repeated(&mut items, first, cursor.repetition.take());
        read
    });
    items
}

/// One statement; only a junction statement gives more than one item.
fn item(cursor: &mut Cursor, items: &mut Vec<Item>) -> Parsed<()> {
    let docs = cursor.documentation();
    if let Some(span) = docs.span
        && (cursor.starts_chain() || !matches!(cursor.word(), Some("param" | "input" | "scene")))
    {
        cursor.note(span, &SyntaxFault::MisplacedDocumentation);
    }
    if cursor.ended() {
        return Ok(());
    }
    if cursor.starts_chain() {
        return chain(cursor, items);
    }
    if matches!(cursor.peek().and_then(TokenKind::number).as_deref(), Some("0" | "1")) {
        return junctions(cursor, items);
    }
    match cursor.word() {
        Some("param") => parameter(cursor, docs.text, items),
        Some("input") => input(cursor, docs.text, items),
        Some("scene") if cursor.place().words.contains(&"scene") => cursor.scene(docs.text, items),
        Some("scenes") if cursor.place().words.contains(&"scenes") => {
            items.push(Item::ScenesOnly(cursor.scenes_only()?));
            Ok(())
        }
        Some("sample") if cursor.word_ahead(1).is_some() => {
            Err(cursor.note(cursor.span(), &SyntaxFault::SampleOutside))
        }
        Some(word) if is_broken_chain(cursor, word) => chain(cursor, items),
        Some(word) => {
            let word = word.to_owned();
            let item = bond_graph_item(cursor, &word)?;
            items.push(item);
            Ok(())
        }
        None => Err(cursor.unknown_statement()),
    }
}

/// A statement of one item that begins with `word`.
fn bond_graph_item(cursor: &mut Cursor, word: &str) -> Parsed<Item> {
    if let Some(kind) = value_of(&ELEMENTS, word) {
        return element(cursor, kind).map(Item::Element);
    }
    if let Some(kind) = value_of(&TRACKS, word) {
        return track(cursor, kind).map(Item::Track);
    }
    match word {
        "let" => binding(cursor).map(Item::Let),
        "table" => table(cursor).map(Item::Table),
        "state" => state(cursor).map(Item::State),
        "memory" => memory(cursor).map(Item::Memory),
        "every" => every(cursor).map(Item::Every),
        "close" => close(cursor).map(Item::Close),
        "observe" => cursor.observe().map(Item::Observe),
        "part" => cursor.part_use().map(Item::Use),
        "for" => cursor.repetition().map(Item::For),
        "port" if cursor.place().words.contains(&"port") => cursor.port().map(Item::Port),
        _ => cursor.mechanism_item(word),
    }
}

/// `param NAME: UNIT = DEFAULT, above 0;`
fn parameter(cursor: &mut Cursor, docs: String, items: &mut Vec<Item>) -> Parsed<()> {
    cursor.advance();
    let name = cursor.declared("the parameter")?;
    let span = name.span;
    let unit = Unit { factors: Vec::new(), span };
    let default = Expression { kind: ExpressionKind::Number(0.0), span };
    let mut parameter = Parameter { docs, name, unit, default, lower: None, upper: None };
    let read = quantity(cursor, &mut parameter);
    items.push(Item::Parameter(parameter));
    read?;
    cursor.end_statement("an operator, `,`");
    Ok(())
}

/// A parameter's unit, default and range.
fn quantity(cursor: &mut Cursor, parameter: &mut Parameter) -> Parsed<()> {
    parameter.unit = declared_unit(cursor, "parameter", &parameter.name)?;
    if cursor.eat("=").is_none() {
        let fault = SyntaxFault::MissingDefault { name: parameter.name.text.clone() };
        return Err(cursor.note(parameter.unit.span, &fault));
    }
    parameter.default = cursor.expression()?.in_unit(&parameter.unit);
    while cursor.eat(",").is_some() {
        bound(cursor, parameter)?;
    }
    Ok(())
}

/// `above 0`, `at most 1`
fn bound(cursor: &mut Cursor, parameter: &mut Parameter) -> Parsed<()> {
    const EXPECTED: &str = "`above`, `at least`, `below` or `at most`";
    let span = cursor.span();
    let (is_lower, included) = match (cursor.word(), cursor.word_ahead(1)) {
        (Some("above"), _) => (true, false),
        (Some("below"), _) => (false, false),
        (Some("at"), Some("least")) => (true, true),
        (Some("at"), Some("most")) => (false, true),
        _ => return Err(cursor.unexpected(EXPECTED)),
    };
    for _ in 0..=usize::from(included) {
        cursor.advance();
    }
    let bound = Bound { value: cursor.expression()?.in_unit(&parameter.unit), included };
    let (slot, end) = if is_lower { (&mut parameter.lower, "lower") } else { (&mut parameter.upper, "upper") };
    if slot.is_some() {
        cursor.note(span, &SyntaxFault::Duplicate { clause: format!("{end} bound") });
    }
    *slot = Some(bound);
    Ok(())
}

/// `input NAME: UNIT;`
fn input(cursor: &mut Cursor, docs: String, items: &mut Vec<Item>) -> Parsed<()> {
    cursor.advance();
    let name = cursor.declared("the input")?;
    let span = name.span;
    let unit = declared_unit(cursor, "input", &name);
    let (unit, read) = match unit {
        Ok(unit) => (unit, Ok(())),
        Err(reported) => (Unit { factors: Vec::new(), span }, Err(reported)),
    };
    items.push(Item::Input(Input { docs, name, unit }));
    read?;
    cursor.end_statement("`*`, `/`");
    Ok(())
}

/// `: UNIT`, which must be there.
fn declared_unit(cursor: &mut Cursor, what: &'static str, name: &Name) -> Parsed<Unit> {
    let colon = cursor.eat(":");
    let missing = cursor.is("=") || cursor.is(";") || cursor.ended() || colon.is_none() && cursor.starts_statement();
    if missing {
        return Err(cursor.note(name.span, &SyntaxFault::MissingUnit { what, name: name.text.clone() }));
    }
    if colon.is_none() {
        return Err(cursor.unexpected("`:`"));
    }
    cursor.unit()
}

/// `let NAME: UNIT = EXPRESSION;`
fn binding(cursor: &mut Cursor) -> Parsed<Let> {
    cursor.advance();
    let name = cursor.declared("the value")?;
    let unit = if cursor.eat(":").is_some() { Some(cursor.unit()?) } else { None };
    if unit.is_none() && cursor.word().is_some() && !cursor.starts_statement() {
        return Err(cursor.unexpected("`:` and a unit, or `=`"));
    }
    cursor.expect("=")?;
    let value = cursor.expression()?;
    let value = unit.iter().fold(value, Expression::in_unit);
    cursor.end_statement(OPERATOR);
    Ok(Let { name, unit, value, clause: None })
}

/// `state NAME: UNIT = RATE start E;`
fn state(cursor: &mut Cursor) -> Parsed<State> {
    cursor.advance();
    let name = cursor.declared("the state")?;
    let unit = declared_unit(cursor, "state", &name)?;
    cursor.expect("=")?;
    let rate = cursor.expression()?;
    let start = if cursor.eat_word("start").is_some() { Some(cursor.expression()?.in_unit(&unit)) } else { None };
    cursor.end_statement(if start.is_some() { OPERATOR } else { "`start`" });
    Ok(State { name, unit, rate, start })
}

/// `memory NAME: UNIT = E while E < E start E;`
fn memory(cursor: &mut Cursor) -> Parsed<Memory> {
    cursor.advance();
    let name = cursor.declared("the memory")?;
    let unit = declared_unit(cursor, "memory", &name)?;
    cursor.expect("=")?;
    let then = cursor.expression()?;
    cursor.expect_word("while")?;
    let (left, comparison, right) = cursor.condition()?;
    let start = if cursor.eat_word("start").is_some() { Some(cursor.expression()?.in_unit(&unit)) } else { None };
    cursor.end_statement(if start.is_some() { OPERATOR } else { "`start`" });
    let kept = Memory::kept(&name);
    let otherwise = Expression { span: kept.span, kind: ExpressionKind::Name(kept) };
    Ok(Memory { following: Choice { comparison, left, right, then, otherwise }, name, unit, start })
}

/// `every E offset E { sample NAME: UNIT = E start E; .. }`
fn every(cursor: &mut Cursor) -> Parsed<Every> {
    cursor.advance();
    if cursor.delimiter() == Some(Delimiter::Brace) {
        return Err(cursor.unexpected("the time between two instants, such as `1 ms`"));
    }
    let period = cursor.expression()?;
    let offset = if cursor.eat_word("offset").is_some() { Some(cursor.expression()?) } else { None };
    let mut block = cursor.group(Delimiter::Brace, "`offset` or `{ sample NAME: UNIT = VALUE; }`", &EVERY)?;
    let mut samples = Vec::new();
    block.statements(|entry| {
        if entry.word() != Some("sample") {
            return Err(entry.unknown_statement());
        }
        samples.push(sample(entry)?);
        Ok(())
    });
    Ok(Every { period, offset, samples })
}

/// `sample NAME: UNIT = E start E;`
fn sample(cursor: &mut Cursor) -> Parsed<Sample> {
    cursor.advance();
    let name = cursor.plain_name("the sample")?;
    let unit = declared_unit(cursor, "sample", &name)?;
    cursor.expect("=")?;
    let value = cursor.expression()?.in_unit(&unit);
    let start = if cursor.eat_word("start").is_some() { Some(cursor.expression()?.in_unit(&unit)) } else { None };
    cursor.end_statement(if start.is_some() { OPERATOR } else { "an operator, `start`" });
    Ok(Sample { name, unit, value, start })
}

/// `table NAME: UNIT -> UNIT = [[x, y], ..], spline, held;`
fn table(cursor: &mut Cursor) -> Parsed<Table> {
    cursor.advance();
    let name = cursor.declared("the table")?;
    let argument = declared_unit(cursor, "table", &name)?;
    let second = if cursor.eat(",").is_some() { Some(cursor.unit()?) } else { None };
    cursor.expect("->")?;
    let value = cursor.unit()?;
    cursor.expect("=")?;
    if cursor.peek().is_some_and(TokenKind::is_text) {
        return Err(cursor.note(cursor.span(), &SyntaxFault::UseInCall));
    }
    let points = cursor.expression()?;
    let (mut between, mut beyond) = (None, None);
    while cursor.eat(",").is_some() {
        let span = cursor.span();
        let word = cursor.word().unwrap_or_default();
        if let Some(given) = value_of(&BETWEEN, word) {
            cursor.fill(&mut between, given, "form of the lines between points", span);
        } else if let Some(given) = value_of(&BEYOND, word) {
            cursor.fill(&mut beyond, given, "word for what is beyond the points", span);
        } else {
            return Err(cursor.unexpected("`straight`, `monotone`, `spline`, `held`, `continued` or `periodic`"));
        }
        cursor.advance_word();
    }
    cursor.end_statement("`,`");
    let (between, beyond) = (between.unwrap_or_default(), beyond.unwrap_or_default());
    Ok(Table { name, argument, second, value, points, between, beyond })
}

/// Whether a name is ahead that is no slip of a statement's word, and after it a symbol where `->` could be meant.
fn is_broken_chain(cursor: &Cursor, word: &str) -> bool {
    let is_symbol = matches!(cursor.ahead(1), Some(TokenKind::Symbol(symbol)) if *symbol != ":");
    is_symbol
        && near_miss(word, GRAPH.words.iter().copied().filter(|known| known.len() > 1)).is_none()
        && value_of(&ELEMENTS, word).is_none()
}

/// `a -> b -> c;`
fn chain(cursor: &mut Cursor, items: &mut Vec<Item>) -> Parsed<()> {
    let mut names = vec![cursor.name("a junction or element")?];
    cursor.expect("->")?;
    names.push(cursor.name("a junction or element")?);
    while cursor.eat("->").is_some() {
        names.push(cursor.name("a junction or element")?);
    }
    items.push(Item::Chain(names));
    cursor.end_statement("`->`");
    Ok(())
}

/// `1 NAME, NAME[3]: rotation;`
fn junctions(cursor: &mut Cursor, items: &mut Vec<Item>) -> Parsed<()> {
    let Some(kind) = cursor.junction_kind() else { return Err(cursor.unknown_statement()) };
    loop {
        let name = cursor.declared_junction("the junction")?;
        let cardinality = cursor.cardinality()?;
        let domain = if cursor.eat(":").is_some() { Some(cursor.name("the domain")?) } else { None };
        if domain.is_none()
            && !cursor.starts_statement()
            && let Some(word) = cursor.word()
        {
            return Err(cursor.unexpected(&format!("`: {word}`")));
        }
        items.push(Item::Junction(Junction { kind, name, cardinality, domain }));
        if cursor.eat(",").is_none() {
            break;
        }
    }
    cursor.end_statement("`,`");
    Ok(())
}

/// `R NAME(w) = LAW in R start E;`, `R NAME(w) = LAW holds E;`, `rSe NAME = 0 at GAP of JOINT along x;`
fn element(cursor: &mut Cursor, kind: ElementKind) -> Parsed<Element> {
    if cursor.word_ahead(1).is_none() {
        cursor.advance();
        return Err(cursor.unexpected("a name for the element"));
    }
    cursor.advance();
    let name = cursor.declared("the element")?;
    let variable = cursor.law_variable()?;
    cursor.expect("=")?;
    let law = cursor.expression()?;
    let mut element = Element { variable, ..Element::new(kind, name, law) };
    while clause(cursor, &mut element)? {}
    cursor.end_statement("an operator, `in`, `at`, `start`, `energy`, `holds`");
    Ok(element)
}

/// One clause after a law; false when none is ahead.
fn clause(cursor: &mut Cursor, element: &mut Element) -> Parsed<bool> {
    if let Some(span) = cursor.eat_word("of") {
        let held = held(cursor)?;
        cursor.fill(&mut element.held, held, "of", span);
        return Ok(true);
    }
    let (word, slot) = match cursor.word() {
        Some("in") => ("in", &mut element.frame),
        Some("at") => ("at", &mut element.displacement),
        Some("start") => ("start", &mut element.start),
        Some("energy") => ("energy", &mut element.energy),
        Some("holds") => ("holds", &mut element.sticking),
        Some("restitution") => ("restitution", &mut element.restitution),
        Some("rest") => ("rest below", &mut element.rest),
        _ => return Ok(false),
    };
    let span = cursor.advance();
    if word == "rest below" {
        cursor.expect_word("below")?;
    }
    let value = cursor.expression()?;
    cursor.fill(slot, value, word, span);
    Ok(true)
}

/// `JOINT along x`, after `of`.
fn held(cursor: &mut Cursor) -> Parsed<Held> {
    let joint = cursor.name("the joint")?;
    let direction = if let Some(span) = cursor.eat_word("along") {
        Some(Direction::Along(cursor.axis("along", span)?))
    } else if let Some(span) = cursor.eat_word("about") {
        Some(Direction::About(cursor.axis("about", span)?))
    } else {
        None
    };
    Ok(Held { joint, direction })
}

impl Cursor<'_> {
    /// `0` or `1`, if it is ahead.
    pub fn junction_kind(&mut self) -> Option<JunctionKind> {
        let kind = match self.peek().and_then(TokenKind::number)?.as_str() {
            "0" => JunctionKind::Zero,
            "1" => JunctionKind::One,
            _ => return None,
        };
        self.advance();
        Some(kind)
    }

    /// `[3]`, or nothing for a scalar junction.
    pub fn cardinality(&mut self) -> Parsed<usize> {
        let Some(mut inner) = self.enter(Delimiter::Bracket, &GROUP) else { return Ok(1) };
        let cardinality = match inner.peek().and_then(TokenKind::number).as_deref() {
            Some("1") => 1,
            Some("3") => 3,
            _ => return Err(inner.note(inner.span(), &SyntaxFault::Cardinality { found: inner.found() })),
        };
        inner.advance();
        inner.finish("`]`")?;
        Ok(cardinality)
    }

    /// `(w)` or `(effort e)`, or nothing for a linear law.
    pub fn law_variable(&mut self) -> Parsed<Option<LawVariable>> {
        let Some(mut inner) = self.enter(Delimiter::Parenthesis, &GROUP) else { return Ok(None) };
        let role = match (inner.word(), inner.word_ahead(1)) {
            (Some(word), Some(_)) => value_of(&ROLES, word),
            _ => None,
        };
        if role.is_some() {
            inner.advance();
        }
        let name = inner.plain_name("the law's variable")?;
        inner.finish("`)`")?;
        Ok(Some(LawVariable { role, name }))
    }
}

/// `position NAME of JUNCTION start E;`
fn track(cursor: &mut Cursor, kind: TrackKind) -> Parsed<Track> {
    cursor.advance();
    let name = cursor.declared("the track")?;
    cursor.expect_word("of")?;
    let junction = cursor.name("the junction")?;
    let start = if cursor.eat_word("start").is_some() { Some(cursor.expression()?) } else { None };
    cursor.end_statement(if start.is_some() { OPERATOR } else { "`start`" });
    Ok(Track { kind, name, junction, start })
}

/// `close NAME = E;`
fn close(cursor: &mut Cursor) -> Parsed<Close> {
    cursor.advance();
    let joint = cursor.declared("the joint")?;
    cursor.expect("=")?;
    let gap = cursor.expression()?;
    cursor.end_statement(OPERATOR);
    Ok(Close { joint, gap })
}
