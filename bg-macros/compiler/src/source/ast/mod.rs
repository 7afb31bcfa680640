//! The source as a tree: what a user wrote, with the span of every name, before any name means anything.
//!
//! One tree serves both vocabularies; after `part::flatten` parts and repetitions no longer occur, after
//! `mechanism::expand` the items of the second vocabulary.

mod bodies;
mod elements;
mod expression;
mod joints;
mod part;
mod signals;
mod studies;

use std::fmt::{Debug, Formatter, Result};

use proc_macro2::Span;

use crate::source::drawing::Drawing;
use crate::source::visibility::Visibility;

pub use bodies::{Axis, Baumgarte, Body, Gravity, Ground, Point, Shape, Solid};
pub use elements::{Direction, Element, ElementKind, Held, Junction, JunctionKind, LawVariable, Role};
pub use expression::{BinaryOperator, Choice, Comparison, Expression, ExpressionKind, Operation};
pub use joints::{
    AxisLaw, Contact, Drive, DriveKind, Ends, Friction, Joint, JointKind, Orifice, PressLaw, ShapeContact, Spring,
    Stop, Touching,
};
pub use part::{Argument, For, Foreign, Part, PartPath, Port, Start, StartKind, Use, Written, used_parts};
pub use signals::{Between, Beyond, Bound, Every, Input, Let, Memory, Parameter, Sample, State, Table, Unit};
pub use studies::{Close, Expectation, Observation, Rigid, Scene, Track, TrackKind, Tune, Watch};

/// All parts and graphs of one macro call.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// What parts of other macro calls are, as far as these have been asked.
    pub foreign: Vec<Foreign>,
    /// The parts in the order of declaration.
    pub parts: Vec<Part>,
    /// The graphs in the order of declaration.
    pub graphs: Vec<Graph>,
    /// Names that end with a dot: faults of syntax, whose statements are not there.
    pub unfinished: Vec<Name>,
    /// The words of the language, for an editor.
    pub heard: Heard,
    /// The most statements of a graph with its repetitions and parts written out; none: [`MOST_STATEMENTS`].
    pub most: Option<usize>,
}

/// Words where statements have them. They print as nothing: two sources are alike however they are written.
#[derive(Clone, Default)]
pub struct Heard {
    /// Words of the language.
    pub words: Vec<Spoken>,
    /// Words that begin no statement of their block: faults of syntax.
    pub unknown: Vec<Spoken>,
}

impl Debug for Heard {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str("Heard")
    }
}

/// A word where a statement of a block has it.
#[derive(Clone, Debug)]
pub struct Spoken {
    /// The block, as messages call it.
    pub block: &'static str,
    /// The words with which its statements begin.
    pub beginnings: &'static [&'static str],
    /// The word, with its place.
    pub word: Name,
}

/// What a graph has at most, unless its source says otherwise: an electrical ladder of this size is checked in half a
/// minute.
pub const MOST_STATEMENTS: usize = 20_000;

/// One `graph NAME { ... }`.
#[derive(Clone, Debug)]
pub struct Graph {
    /// Documentation comment, lines joined by `\n`, each without its leading blank.
    pub docs: String,
    /// Visibility of the generated items.
    pub visibility: Visibility,
    /// The generated type's name.
    pub name: Name,
    /// The statements in their order.
    pub items: Vec<Item>,
    /// What the mechanism looks like; empty while its words are there.
    pub drawing: Drawing<Expression>,
}

/// A name, possibly dotted and with whole numbers in brackets: `shaft`, `pin_b.force`, `link[3].bar`.
#[derive(Clone, Debug)]
pub struct Name {
    /// The whole name with its dots. In brackets stand digits; before `part::flatten` also expressions of indices.
    pub text: String,
    /// Where it stands.
    pub span: Span,
    /// Where each of its words stands, if it has several and somebody has written them.
    pub words: Words,
}

impl Name {
    /// A name without places of its words.
    #[must_use]
    pub fn new(text: impl Into<String>, span: Span) -> Self {
        Self { text: text.into(), span, words: Words::default() }
    }

    /// Where each of its words stands; of a name of one word where it stands itself.
    #[must_use]
    pub fn places(&self) -> &[Span] {
        if self.words.0.is_empty() { std::slice::from_ref(&self.span) } else { &self.words.0 }
    }
}

/// Places of words. They print as nothing: two names are alike wherever they stand.
#[derive(Clone, Default)]
pub struct Words(pub Vec<Span>);

impl Debug for Words {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str("Words")
    }
}

/// A statement of a graph.
#[derive(Clone, Debug)]
pub enum Item {
    /// `param NAME: UNIT = DEFAULT, at least 0;`
    Parameter(Parameter),
    /// `input NAME: UNIT;`
    Input(Input),
    /// `let NAME: UNIT = EXPRESSION;` a name for an expression (UNIT may be left out).
    Let(Let),
    /// `state NAME: UNIT = RATE start E;`
    State(State),
    /// `memory NAME: UNIT = E while E < E start E;`
    Memory(Memory),
    /// `every E offset E { sample NAME: UNIT = E start E; .. }`
    Every(Every),
    /// `table NAME: UNIT -> UNIT = [[x, y], ..], spline, held;`, with two arguments `table NAME: UNIT, UNIT -> ..`
    Table(Table),
    /// `1 NAME;`, `0 NAME[3]: translation;`
    Junction(Junction),
    /// `R NAME(w) = LAW;` and its like.
    Element(Element),
    /// `a -> b -> c;`
    Chain(Vec<Name>),
    /// `position NAME of JUNCTION start E;`, `orientation NAME of JUNCTION start E;`
    Track(Track),
    /// `close NAME = E;` a gap of joint NAME that the assembly of the start closes.
    Close(Close),
    /// `observe { NAME: UNIT = E; E; all of NAME; ... }`
    Observe(Vec<Watch>),
    /// `scene NAME { ... }`
    Scene(Scene),
    /// `scenes only;` with the words' span: the literal graph is checked, and no code is made of it.
    ScenesOnly(Span),
    /// `ground { point P = E; ... }`
    Ground(Ground),
    /// `gravity E;`
    Gravity(Gravity),
    /// `start impulse;` with the word's span: impulses of the rigid joints make start velocities fit.
    Impulse(Span),
    /// `baumgarte RATE;`
    Baumgarte(Baumgarte),
    /// `expect integral causality;`: a storage in derivative causality is a fault.
    IntegralCausality,
    /// `body NAME { ... }`
    Body(Body),
    /// `joint NAME: KIND AXES (a.P -> b.Q) { ... }`
    Joint(Joint),
    /// `spring NAME (a.P -> b.Q) { ... }`
    Spring(Spring),
    /// `drive NAME on TARGET torque = E;`
    Drive(Drive),
    /// `contact NAME (a.P -> b.Q along x) { ... }`
    Contact(Contact),
    /// `contact NAME (a.P circle E -> b.Q line x) { ... }`
    ShapeContact(ShapeContact),
    /// `friction NAME on TARGET { ... }`
    Friction(Friction),
    /// `stop NAME on TARGET { ... }`
    Stop(Stop),
    /// `orifice NAME on JUNCTION { ... }`
    Orifice(Orifice),
    /// `part NAME: PART { ... }`
    Use(Use),
    /// `port NAME: DOMAIN;`
    Port(Port),
    /// `start BODY at E;`
    Start(Start),
    /// `for i in 0..20 { ... }`
    For(For),
}

impl Item {
    /// The parameter or input that it declares, with its word.
    #[must_use]
    pub fn adjustable(&self) -> Option<(&'static str, &Name)> {
        match self {
            Self::Parameter(parameter) => Some(("parameter", &parameter.name)),
            Self::Input(input) => Some(("input", &input.name)),
            _ => None,
        }
    }
}
