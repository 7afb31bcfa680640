//! Scenes and what they watch.
//!
//! In: `observe { ... }` and `scene NAME { ... }`. Out: [`Observation`]s and a [`Scene`].

use proc_macro2::{Delimiter, Span};

use super::{
    SyntaxFault,
    cursor::{Block, Cursor, Parsed},
    token::TokenKind,
};
use crate::source::ast::{Expectation, Item, Name, Observation, Rigid, Scene, Tune, Watch};

/// The block of a scene.
pub(super) const SCENE: Block = Block {
    name: "a scene",
    words: &["observe", "tune", "without", "rigid", "all", "dependent", "angles", "expect"],
    list: false,
};

/// `observe { ... }`
pub(super) const OBSERVE: Block = Block { name: "`observe`", words: &[], list: true };

/// `tune { ... }` and its like.
const NAMES: Block = Block { name: "the list", words: &[], list: true };

/// What a scene can expect.
const EXPECTATIONS: &[&str] = &["planar", "states", "independent", "integral"];

/// A block of names, for messages.
const LIST: &str = "`{ NAME, NAME }`";

impl Cursor<'_> {
    /// `observe { NAME: UNIT = E; E; all of NAME }`, or `observe all of NAME;`
    pub fn observe(&mut self) -> Parsed<Vec<Watch>> {
        self.advance();
        if self.starts_all() {
            let all = self.all()?;
            self.end_statement("");
            return Ok(vec![all]);
        }
        let mut block = self.group(Delimiter::Brace, "`{ ... }`", &OBSERVE)?;
        let mut watched = Vec::new();
        block.statements(|entry| {
            watched.push(if entry.starts_all() { entry.all()? } else { Watch::Value(observation(entry)?) });
            entry.end_statement("an operator, `,`");
            Ok(())
        });
        Ok(watched)
    }

    /// Whether `all of` is ahead.
    fn starts_all(&self) -> bool {
        self.word() == Some("all") && self.word_ahead(1) == Some("of")
    }

    /// `all of NAME`
    fn all(&mut self) -> Parsed<Watch> {
        self.advance();
        self.advance();
        Ok(Watch::All(self.name("what is watched")?))
    }

    /// `scene NAME { ... }`
    pub fn scene(&mut self, docs: String, items: &mut Vec<Item>) -> Parsed<()> {
        self.advance();
        let name = self.plain_name("the scene")?;
        let mut scene = Scene {
            docs,
            name,
            observe: Vec::new(),
            tune: Tune::All,
            without: Vec::new(),
            rigid: Rigid::None,
            angles: false,
            all_reactions: false,
            dependent: Vec::new(),
            expect: Vec::new(),
        };
        let block = self.group(Delimiter::Brace, "`{ ... }`", &SCENE);
        let read = block.map(|mut block| {
            let mut filled = Filled::default();
            block.statements(|entry| entry.scene_entry(&mut scene, &mut filled));
        });
        items.push(Item::Scene(scene));
        read
    }

    /// `scenes only;`
    pub fn scenes_only(&mut self) -> Parsed<Span> {
        let span = self.advance();
        self.expect_word("only")?;
        self.end_statement("");
        Ok(span)
    }

    /// One statement of a scene.
    fn scene_entry(&mut self, scene: &mut Scene, filled: &mut Filled) -> Parsed<()> {
        let span = self.span();
        match self.word() {
            Some("observe") => {
                self.fill(&mut filled.observe, (), "observe", span);
                let observations = self.observe()?;
                scene.observe.extend(observations);
            }
            Some("tune") => {
                self.fill(&mut filled.tune, (), "tune", span);
                scene.tune = self.tune()?;
            }
            Some("without") => {
                self.advance();
                let names = self.name_list("what is left out")?;
                scene.without.extend(names);
            }
            Some("rigid") => {
                self.fill(&mut filled.rigid, (), "rigid", span);
                scene.rigid = self.rigid()?;
            }
            Some("angles") => {
                self.fill(&mut filled.angles, (), "angles", span);
                self.advance();
                self.end_statement("");
                scene.angles = true;
            }
            Some("all") => {
                self.fill(&mut filled.reactions, (), "all reactions", span);
                self.advance();
                self.expect_word("reactions")?;
                self.end_statement("");
                scene.all_reactions = true;
            }
            Some("dependent") => {
                self.advance();
                let names = self.name_list("a body")?;
                scene.dependent.extend(names);
            }
            Some("expect") => {
                let expectation = self.expectation()?;
                scene.expect.push(expectation);
            }
            _ => return Err(self.unknown_statement()),
        }
        Ok(())
    }

    /// `tune { a, b }`, `tune all but { a, b }`
    fn tune(&mut self) -> Parsed<Tune> {
        self.advance();
        if self.word() != Some("all") || self.word_ahead(1) != Some("but") {
            return self.name_list("a parameter").map(Tune::Only);
        }
        self.advance();
        self.advance();
        self.name_list("a parameter").map(Tune::AllBut)
    }

    /// `{ a, b }` or `a, b;`
    fn name_list(&mut self, what: &'static str) -> Parsed<Vec<Name>> {
        if let Some(mut block) = self.enter(Delimiter::Brace, &NAMES) {
            return Ok(block.names(what));
        }
        if self.word().is_none() {
            return Err(self.unexpected(LIST));
        }
        let mut names = vec![self.name(what)?];
        while self.eat(",").is_some() {
            names.push(self.name(what)?);
        }
        self.end_statement("`,`");
        Ok(names)
    }

    /// `rigid joints;` or `rigid { a, b }`
    fn rigid(&mut self) -> Parsed<Rigid> {
        self.advance();
        if let Some(span) = self.eat_word("joints") {
            self.end_statement("");
            return Ok(Rigid::All(span));
        }
        let mut block = self.group(Delimiter::Brace, "`joints` or `{ NAME, NAME }`", &NAMES)?;
        Ok(Rigid::Some(block.names("a joint")))
    }

    /// `expect planar;`, `expect states = 29;`, `expect independent speeds;` or `expect integral causality;`
    fn expectation(&mut self) -> Parsed<Expectation> {
        self.advance();
        let Some(word) = self.word().map(str::to_owned) else {
            return Err(self.unexpected("`planar`, `states`, `independent` or `integral`"));
        };
        let span = self.span();
        if self.eat_word("planar").is_some() {
            self.end_statement("");
            return Ok(Expectation::Planar(span));
        }
        if self.eat_word("independent").is_some() {
            self.expect_word("speeds")?;
            self.end_statement("");
            return Ok(Expectation::IndependentSpeeds(span));
        }
        if self.eat_word("integral").is_some() {
            return self.integral_causality().map(|()| Expectation::IntegralCausality);
        }
        if self.eat_word("states").is_none() {
            let fault = SyntaxFault::UnknownKind { what: "an expectation", word, known: EXPECTATIONS };
            return Err(self.note(span, &fault));
        }
        self.expect("=")?;
        let states = self.peek().and_then(TokenKind::number).and_then(|digits| digits.parse().ok());
        let Some(states) = states else { return Err(self.unexpected("a whole number")) };
        let span = self.advance();
        self.end_statement("");
        Ok(Expectation::States(states, span))
    }
}

/// Which clauses of a scene have occurred that leave no trace when they are empty.
#[derive(Default)]
struct Filled {
    observe: Option<()>,
    tune: Option<()>,
    rigid: Option<()>,
    angles: Option<()>,
    reactions: Option<()>,
}

/// `NAME: UNIT = E`, `NAME = E` or `E`
fn observation(entry: &mut Cursor) -> Parsed<Observation> {
    if !starts_named(entry) {
        return Ok(Observation { name: None, unit: None, value: entry.expression()? });
    }
    let name = Some(entry.name("the output")?);
    let unit = if entry.eat(":").is_some() { Some(entry.unit()?) } else { None };
    entry.expect("=")?;
    Ok(Observation { name, unit, value: entry.expression()? })
}

/// Whether a name with `:` or `=` after it is ahead.
fn starts_named(entry: &Cursor) -> bool {
    let is_after = |after| entry.symbol_ahead(after, ":") || entry.symbol_ahead(after, "=");
    entry.after_name().is_some_and(is_after)
}
