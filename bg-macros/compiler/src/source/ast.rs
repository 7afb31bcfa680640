//! The source as a tree: what a user wrote, with the span of every name, before any name means anything.
//!
//! One tree serves both vocabularies; after `part::flatten` parts and repetitions no longer occur, after
//! `mechanism::expand` the items of the second vocabulary.

use std::fmt::{Debug, Formatter, Result};

use proc_macro2::Span;

use crate::source::clause::Clause;
use crate::source::drawing::Drawing;
use crate::source::visibility::Visibility;

pub use crate::source::ast_part::{
    Argument, For, Foreign, Part, PartPath, Port, Start, StartKind, Use, Written, used_parts,
};

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

/// A parameter: a number that stays the same during a run.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Documentation comment.
    pub docs: String,
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// Its default: an expression of numbers only.
    pub default: Expression,
    /// `, above E` or `, at least E`.
    pub lower: Option<Bound>,
    /// `, below E` or `, at most E`.
    pub upper: Option<Bound>,
}

/// One end of a parameter's range.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The end: an expression of numbers only.
    pub value: Expression,
    /// Whether the end itself is allowed (`at least`, `at most`).
    pub included: bool,
}

/// An input: a function of time given at run time.
#[derive(Clone, Debug)]
pub struct Input {
    /// Documentation comment.
    pub docs: String,
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
}

/// A name for an expression.
#[derive(Clone, Debug)]
pub struct Let {
    /// Its name.
    pub name: Name,
    /// Its unit, checked against the value's when given.
    pub unit: Option<Unit>,
    /// Its value.
    pub value: Expression,
    /// The clause of a mechanism word that it stands for, if any.
    pub clause: Option<Clause>,
}

/// A state of the graph's own, which no element stores: a controller's.
#[derive(Clone, Debug)]
pub struct State {
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// How fast it changes.
    pub rate: Expression,
    /// Its value at t = 0; 0 when left out.
    pub start: Option<Expression>,
}

/// A value that is kept: it follows another one while a condition holds.
#[derive(Clone, Debug)]
pub struct Memory {
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// What it follows, by the condition, and otherwise what is kept: a state named `NAME.kept`.
    pub following: Choice,
    /// What is kept at t = 0; 0 when left out.
    pub start: Option<Expression>,
}

impl Memory {
    /// The name of the state that keeps the value.
    #[must_use]
    pub fn kept(name: &Name) -> Name {
        Name::new(format!("{}.kept", name.text), name.span)
    }
}

/// Values that are computed at the instants of a clock and held in between: a digital controller's.
#[derive(Clone, Debug)]
pub struct Every {
    /// The time from one instant to the next.
    pub period: Expression,
    /// The first instant; 0 when left out.
    pub offset: Option<Expression>,
    /// What is computed.
    pub samples: Vec<Sample>,
}

/// A value of a clock.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// What it becomes at an instant.
    pub value: Expression,
    /// What is held before the first instant; 0 when left out.
    pub start: Option<Expression>,
}

impl Every {
    /// What says when, as written.
    #[must_use]
    pub fn times(&self) -> String {
        let offset = self.offset.as_ref().map_or_else(String::new, |offset| format!(" offset {offset}"));
        format!("every {}{offset}", self.period)
    }
}

impl Sample {
    /// The name of the value that is held before an instant.
    #[must_use]
    pub fn last(name: &Name) -> Name {
        Name::new(format!("{}.{}", name.text, Self::LAST), name.span)
    }

    /// What follows the name of a sample for the value before an instant.
    pub const LAST: &'static str = "last";
}

/// A function of one variable or two that is given by points.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name, by which expressions call it.
    pub name: Name,
    /// The unit of its argument.
    pub argument: Unit,
    /// The unit of its second argument, if it has one.
    pub second: Option<Unit>,
    /// The unit of its value.
    pub value: Unit,
    /// The points: pairs of numbers, the arguments ascending. With two arguments a row of the second ones, then rows of
    /// a first one with the values.
    pub points: Expression,
    /// What it is between its points.
    pub between: Between,
    /// What it is beyond them.
    pub beyond: Beyond,
}

/// What a table is between its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Between {
    /// Straight lines.
    #[default]
    Straight,
    /// Cubics with a continuous slope that rise and fall only where the points do.
    Monotone,
    /// A cubic spline: its second derivative is continuous.
    Spline,
}

/// What a table is beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Beyond {
    /// Nothing: a run that gets there ends with an error.
    #[default]
    Refused,
    /// The value at its end.
    Held,
    /// A straight line with the slope at its end.
    Continued,
    /// The same again and again: its last point is its first one, a period later.
    Periodic,
}

/// A unit as written, `kg*m^2/s`: factors with their exponents (negative after a `/`). `1` has none.
#[derive(Clone, Debug)]
pub struct Unit {
    /// Unit symbol and exponent, in the order written.
    pub factors: Vec<(Name, i32)>,
    /// Where it stands.
    pub span: Span,
}

impl Unit {
    /// The second, at this place.
    #[must_use]
    pub fn second(span: Span) -> Self {
        Self { factors: vec![(Name::new("s", span), 1)], span }
    }

    /// The unit that this stands for; none where a symbol is not known.
    #[must_use]
    pub fn meaning(&self) -> Option<bg_units::Unit> {
        self.factors.iter().try_fold(bg_units::Unit::ONE, |product, (symbol, exponent)| {
            bg_units::Unit::of_symbol(&symbol.text).map(|unit| product.times(unit.power(*exponent)))
        })
    }

    /// Whether a number in it is one in SI; also where nothing is known of it.
    #[must_use]
    pub fn is_coherent(&self) -> bool {
        self.meaning().is_none_or(bg_units::Unit::is_coherent)
    }
}

/// Which law a junction obeys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JunctionKind {
    /// Common effort, the flows balance.
    Zero,
    /// Common flow, the efforts balance.
    One,
}

/// A junction.
#[derive(Clone, Debug)]
pub struct Junction {
    /// 0 or 1.
    pub kind: JunctionKind,
    /// Its name.
    pub name: Name,
    /// 1, or 3 for a multibond junction.
    pub cardinality: usize,
    /// `electrical`, `translation`, `rotation`, `hydraulic`, `thermal`: fixes the units of effort and flow.
    pub domain: Option<Name>,
}

/// What an element is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the field's own symbols")]
pub enum ElementKind {
    Se,
    Sf,
    I,
    C,
    R,
    Tf,
    Gy,
    MSe,
    MSf,
    RSe,
    Mtf,
    Mgy,
    Mr,
}

impl ElementKind {
    /// Whether it has two ports.
    #[must_use]
    pub fn is_two_port(self) -> bool {
        matches!(self, Self::Tf | Self::Gy | Self::Mtf | Self::Mgy)
    }
}

/// An element with its constitutive law.
#[derive(Clone, Debug)]
pub struct Element {
    /// What it is.
    pub kind: ElementKind,
    /// Its name.
    pub name: Name,
    /// `(w)` or `(effort e)`: the law is an expression of this variable. Without it the law is linear in a parameter.
    pub variable: Option<LawVariable>,
    /// The law after `=`; for a transformer or gyrator its modulus.
    pub law: Expression,
    /// `in R`: the law's tensor turns with this orientation.
    pub frame: Option<Expression>,
    /// `at E`: the displacement of a C is E, which the poses determine, and no state of its own.
    pub displacement: Option<Expression>,
    /// `start E`: displacement of a C, momentum of an I at t = 0.
    pub start: Option<Expression>,
    /// `energy E`: the stored energy of a nonlinear law.
    pub energy: Option<Expression>,
    /// `of JOINT along x`: what a residual sink holds.
    pub held: Option<Held>,
    /// `holds E`: the effort up to which an R keeps its flow at zero; its law is that of dry friction.
    pub sticking: Option<Expression>,
    /// `restitution E`: a residual sink is a stop, and this is its coefficient.
    pub restitution: Option<Expression>,
    /// `rest below E`: the speed of a rebound below which what hits the stop rests on it.
    pub rest: Option<Expression>,
}

impl Element {
    /// An element with a linear law and no clause.
    #[must_use]
    pub fn new(kind: ElementKind, name: Name, law: Expression) -> Self {
        Self {
            kind,
            name,
            variable: None,
            law,
            frame: None,
            displacement: None,
            start: None,
            energy: None,
            held: None,
            sticking: None,
            restitution: None,
            rest: None,
        }
    }
}

/// The joint that a residual sink is part of, and the motion that it holds there.
#[derive(Clone, Debug)]
pub struct Held {
    /// The joint.
    pub joint: Name,
    /// The direction of a scalar sink.
    pub direction: Option<Direction>,
}

/// A direction of relative motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Translation along an axis.
    Along(Axis),
    /// Rotation about an axis.
    About(Axis),
}

/// The variable of a nonlinear law.
#[derive(Clone, Debug)]
pub struct LawVariable {
    /// `effort` or `flow` in front of the name; without it an R's law is of its flow, a C's of its displacement, an I's
    /// of its momentum.
    pub role: Option<Role>,
    /// The variable's name.
    pub name: Name,
}

/// Effort or flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the field's own words")]
pub enum Role {
    Effort,
    Flow,
}

impl Role {
    /// The other variable of a bond.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Effort => Self::Flow,
            Self::Flow => Self::Effort,
        }
    }
}

/// What a track follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrackKind {
    /// The integral of a translational junction's flow, m.
    Position,
    /// The rotation matrix that a rotational junction's flow turns, body to inertial.
    Orientation,
}

/// A kinematic state: where a junction has moved to.
#[derive(Clone, Debug)]
pub struct Track {
    /// Position or orientation.
    pub kind: TrackKind,
    /// Its name.
    pub name: Name,
    /// The 1-junction that it follows.
    pub junction: Name,
    /// Its value at t = 0; zero or the identity when left out.
    pub start: Option<Expression>,
}

/// A gap to be closed by the assembly of the start pose.
#[derive(Clone, Debug)]
pub struct Close {
    /// The joint's name, for the message.
    pub joint: Name,
    /// The gap: scalar or vector, m or rad.
    pub gap: Expression,
}

/// An observed output.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Its name; the expression's own text when left out.
    pub name: Option<Name>,
    /// Its unit, checked against the value's when given.
    pub unit: Option<Unit>,
    /// Its value: scalar, vector or matrix.
    pub value: Expression,
}

/// One entry of `observe`.
#[derive(Clone, Debug)]
pub enum Watch {
    /// `NAME: UNIT = E`
    Value(Observation),
    /// `all of NAME`: what there is to see of a part, body, joint or element. No longer occurs after `part::flatten`.
    All(Name),
}

impl Watch {
    /// The output, if it is one.
    #[must_use]
    pub fn value(&self) -> Option<&Observation> {
        if let Self::Value(observation) = self { Some(observation) } else { None }
    }
}

/// Which parameters of a scene stay adjustable at run time.
#[derive(Clone, Debug)]
pub enum Tune {
    /// All of them.
    All,
    /// `tune { a, b }`
    Only(Vec<Name>),
    /// `tune all but { a, b }`
    AllBut(Vec<Name>),
}

impl Tune {
    /// Whether the parameter stays adjustable.
    #[must_use]
    pub fn keeps(&self, parameter: &str) -> bool {
        let among = |names: &[Name]| names.iter().any(|name| name.text == parameter);
        match self {
            Self::All => true,
            Self::Only(names) => among(names),
            Self::AllBut(names) => !among(names),
        }
    }

    /// The parameters that it names.
    #[must_use]
    pub fn names(&self) -> &[Name] {
        match self {
            Self::All => &[],
            Self::Only(names) | Self::AllBut(names) => names,
        }
    }
}

/// A scene: one use of the mechanism, a type of its own.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Documentation comment.
    pub docs: String,
    /// The generated type's name.
    pub name: Name,
    /// What is watched.
    pub observe: Vec<Watch>,
    /// Which parameters stay adjustable.
    pub tune: Tune,
    /// `without { cut }`: joints, contacts, springs, drives, elements that are left out.
    pub without: Vec<Name>,
    /// `rigid joints;` or `rigid { pin_b }`.
    pub rigid: Rigid,
    /// `angles;`: orientations that turn about one axis only are integrated as angles.
    pub angles: bool,
    /// `all reactions;`: what rigid joints determine of bodies stays in the states, with a reaction for each row of
    /// each joint.
    pub all_reactions: bool,
    /// `dependent { rod }`: bodies of which loops give the orientations.
    pub dependent: Vec<Name>,
    /// `expect planar;`, `expect states = 29;`, `expect independent speeds;`, `expect integral causality;`
    pub expect: Vec<Expectation>,
}

/// Which joints of a scene are rigid.
#[derive(Clone, Debug)]
pub enum Rigid {
    /// None.
    None,
    /// `rigid joints;` with the word's span.
    All(Span),
    /// `rigid { a, b }`
    Some(Vec<Name>),
}

/// What a scene asserts of its reduction or of its graph.
#[derive(Clone, Debug)]
pub enum Expectation {
    /// `expect integral causality;`
    IntegralCausality,
    /// `expect planar;` with the word's span.
    Planar(Span),
    /// `expect states = N;` with the number's span.
    States(usize, Span),
    /// `expect independent speeds;` with the first word's span.
    IndependentSpeeds(Span),
}

/// The inertial frame's named points.
#[derive(Clone, Debug)]
pub struct Ground {
    /// The word's span.
    pub span: Span,
    /// Points in inertial axes, m.
    pub points: Vec<Point>,
}

/// A named point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name (no dots).
    pub name: Name,
    /// Its place in the body's axes from the body's origin, m.
    pub place: Expression,
    /// `turned E`: the rotation matrix from the point's axes to the body's, whose axes joints at the point have then.
    pub turned: Option<Expression>,
}

/// The gravity field.
#[derive(Clone, Debug)]
pub struct Gravity {
    /// The word's span.
    pub span: Span,
    /// The acceleration, inertial axes, m/s^2.
    pub acceleration: Expression,
}

/// How rigid joints are kept: by Baumgarte's terms in place of projection.
#[derive(Clone, Debug)]
pub struct Baumgarte {
    /// The word's span.
    pub span: Span,
    /// The rate at which gaps decay, 1/s.
    pub rate: Expression,
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: Name,
    /// What it is made of; empty when the mass properties are given.
    pub solids: Vec<Solid>,
    /// `density E;` of all solids without one of their own, kg/m^3.
    pub density: Option<Expression>,
    /// `mass E;`, kg.
    pub mass: Option<Expression>,
    /// `center E;` the centre of mass in the body's axes, m.
    pub center: Option<Expression>,
    /// `inertia E;` about the centre of mass in the body's axes, kg*m^2: three principal moments or a matrix.
    pub inertia: Option<Expression>,
    /// Named points.
    pub points: Vec<Point>,
    /// `start at E;` or `start POINT at E;`: the place of the body's origin, or of a point, at t = 0, m.
    pub start_position: Option<(Option<Name>, Expression)>,
    /// `start turned E;` the rotation matrix body to inertial at t = 0.
    pub start_orientation: Option<Expression>,
    /// `start velocity E;` of the centre of mass, inertial axes, m/s.
    pub start_velocity: Option<Expression>,
    /// `start spin E;` the angular velocity, inertial axes, rad/s.
    pub start_spin: Option<Expression>,
}

/// A solid of a body.
#[derive(Clone, Debug)]
pub struct Solid {
    /// What it is.
    pub shape: Shape,
    /// `at E`: its centre in the body's axes, m; the origin when left out.
    pub at: Option<Expression>,
    /// `turned E`: its orientation in the body's axes; the identity when left out.
    pub turned: Option<Expression>,
    /// `density E`, kg/m^3.
    pub density: Option<Expression>,
    /// The word's span.
    pub span: Span,
}

/// A solid's form.
#[derive(Clone, Debug)]
pub enum Shape {
    /// `cuboid [x, y, z]`: edges along the solid's own axes, m.
    Cuboid(Expression),
    /// `cylinder radius E length E along z`, m.
    Cylinder {
        /// Radius, m.
        radius: Expression,
        /// Length along the axis, m.
        length: Expression,
        /// The axis.
        axis: Axis,
    },
    /// `sphere radius E`, m.
    Sphere(Expression),
}

/// An axis of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the field's own letters")]
pub enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The next axis in cyclic order.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::Z,
            Self::Z => Self::X,
        }
    }
}

/// A joint's freedoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about one axis.
    Revolute(Axis),
    /// Slides along one axis.
    Prismatic(Axis),
    /// Turns about a point.
    Spherical,
    /// Turns about and slides along one axis.
    Cylindrical(Axis),
    /// Turns about an axis of the first body and a perpendicular one of the second.
    Universal(Axis, Axis),
    /// No freedom.
    Fixed,
}

/// The two ends of a joint, spring or contact: `(a.P -> b.Q)`; names with one dot, or a body's name for its origin.
#[derive(Clone, Debug)]
pub struct Ends {
    /// The first end.
    pub from: Name,
    /// The second end: forces and relative motions are those of this end.
    pub to: Name,
}

/// A compliant joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: Name,
    /// Its freedoms.
    pub kind: JointKind,
    /// What it joins.
    pub ends: Ends,
    /// `stiffness E;` of the held translations, N/m: one number, or one per axis.
    pub stiffness: Option<Expression>,
    /// `damping E;`, N*s/m.
    pub damping: Option<Expression>,
    /// `tilt stiffness E;` of the held rotations, N*m/rad.
    pub tilt_stiffness: Option<Expression>,
    /// `tilt damping E;`, N*m*s/rad.
    pub tilt_damping: Option<Expression>,
    /// `clearance E;` how far a pin can move from the middle of its hole, or a slider across its guide, m.
    pub clearance: Option<Expression>,
    /// `length E;` of a slider with a clearance: how far apart the places are at which it touches, m.
    pub length: Option<Expression>,
    /// `exponent E;` and its like: how a joint with a clearance pushes, but for its stiffness and its damping.
    pub play: PressLaw,
    /// `frame inertial;`: held rotations are the integrals of the relative angular velocity in inertial axes.
    pub inertial: bool,
    /// `rigid;`: an ideal joint, without stiffness and damping; its reactions keep the held motions zero.
    pub rigid: bool,
}

impl Joint {
    /// How it pushes where its clearance is used up.
    #[must_use]
    pub fn press_law(&self) -> PressLaw {
        PressLaw { stiffness: self.stiffness.clone(), damping: self.damping.clone(), ..self.play.clone() }
    }
}

/// A spring and damper along the line between two points.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Its name.
    pub name: Name,
    /// What it joins.
    pub ends: Ends,
    /// `stiffness E;`, N/m.
    pub stiffness: Option<Expression>,
    /// `damping E;`, N*s/m.
    pub damping: Option<Expression>,
    /// `length E;` unloaded, m.
    pub length: Option<Expression>,
}

/// What a drive prescribes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// `torque = E`, N*m.
    Torque,
    /// `force = E`, N.
    Force,
    /// `speed = E { stiffness E; damping E; }`, rad/s or m/s.
    Speed,
}

/// A source on a joint's free axis, on a body or on a body's point.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Its name.
    pub name: Name,
    /// A joint, a body, or a point of a body.
    pub target: Name,
    /// What it prescribes.
    pub kind: DriveKind,
    /// Its value.
    pub value: Expression,
    /// `stiffness E;` of a speed drive's coupling.
    pub stiffness: Option<Expression>,
    /// `damping E;` of a speed drive's coupling.
    pub damping: Option<Expression>,
}

/// A sliding contact: a point of the first body slides along a line of the second.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// What touches.
    pub ends: Ends,
    /// The direction of the line in the second body's axes.
    pub along: Axis,
    /// The laws per axis of the second body.
    pub laws: Vec<AxisLaw>,
}

/// A contact of two shapes, which push each other and never pull.
#[derive(Clone, Debug)]
pub struct ShapeContact {
    /// Its name.
    pub name: Name,
    /// Where the shapes are.
    pub ends: Ends,
    /// What they are.
    pub shapes: [Touching; 2],
    /// How they push.
    pub law: PressLaw,
    /// `rigid;`: they do not give way, and part at once with the `restitution`.
    pub rigid: bool,
}

/// How what touches pushes.
#[derive(Clone, Debug, Default)]
pub struct PressLaw {
    /// `stiffness E;` N/m, with an exponent n N/m^n.
    pub stiffness: Option<Expression>,
    /// `exponent E;` of the depth; 1 when left out.
    pub exponent: Option<Expression>,
    /// `damping E;` N*s/m.
    pub damping: Option<Expression>,
    /// `dissipation E;` by how much a speed raises the force, s/m.
    pub dissipation: Option<Expression>,
    /// `restitution E;` the part of the speed with which what hits parts.
    pub restitution: Option<Expression>,
    /// `rest below E;` the speed of approach below which what hits counts as that fast, m/s.
    pub rest: Option<Expression>,
}

impl PressLaw {
    /// Those of its clauses that a joint has with a clearance only.
    pub fn play_mut(&mut self) -> [(&'static str, &mut Option<Expression>); 4] {
        let Self { exponent, dissipation, restitution, rest, .. } = self;
        [("exponent", exponent), ("dissipation", dissipation), ("restitution", restitution), ("rest below", rest)]
    }

    /// Its clauses in the order in which they are printed.
    pub fn clauses_mut(&mut self) -> [(&'static str, &mut Option<Expression>); 6] {
        let Self { stiffness, exponent, damping, dissipation, restitution, rest } = self;
        [
            ("stiffness", stiffness),
            ("exponent", exponent),
            ("damping", damping),
            ("dissipation", dissipation),
            ("restitution", restitution),
            ("rest below", rest),
        ]
    }
}

/// A shape that touches another one.
#[derive(Clone, Debug)]
pub enum Touching {
    /// The end itself.
    Point,
    /// `circle E`: in the plane across the end's z axis, radius in m.
    Circle(Expression),
    /// `hole E`: the inside of a circle, or around a sphere of one, radius in m.
    Hole(Expression),
    /// `sphere E`: radius in m.
    Sphere(Expression),
    /// `line x`: along an axis of the end; what is free is to its left, seen from where z points to.
    Line(Axis),
    /// `plane z`: through the end, with this outward normal.
    Plane(Axis),
    /// `segment x E`: a thin wall from the end along an axis of it, with this length in m; both sides and ends are free.
    Segment(Axis, Expression),
    /// `slot x E width E`: the inside of what a circle of this width covers on its way along a segment.
    Slot(Axis, [Expression; 2]),
    /// `arc E from E to E`: a thin wall on a circle around the end, between two angles about its z axis from its x axis.
    Arc([Expression; 3]),
    /// `profile TABLE`: the distance of the outline by the angle about the end's z axis, or its height over the x axis.
    Profile(Name),
}

impl Touching {
    /// Its word.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Circle(_) => "circle",
            Self::Hole(_) => "hole",
            Self::Sphere(_) => "sphere",
            Self::Line(_) => "line",
            Self::Plane(_) => "plane",
            Self::Segment(..) => "segment",
            Self::Slot(..) => "slot",
            Self::Arc(_) => "arc",
            Self::Profile(_) => "profile",
        }
    }

    /// Its sizes, each with the word that stands before it, or what it is where there is none.
    #[must_use]
    pub fn sizes(&self) -> Vec<(&'static str, &Expression)> {
        match self {
            Self::Circle(radius) | Self::Hole(radius) | Self::Sphere(radius) => vec![("radius", radius)],
            Self::Segment(_, length) => vec![("length", length)],
            Self::Slot(_, [length, width]) => vec![("length", length), ("width", width)],
            Self::Arc([radius, from, to]) => vec![("radius", radius), ("from", from), ("to", to)],
            Self::Point | Self::Line(_) | Self::Plane(_) | Self::Profile(_) => Vec::new(),
        }
    }

    /// The same to be changed.
    pub fn sizes_mut(&mut self) -> &mut [Expression] {
        match self {
            Self::Circle(size) | Self::Hole(size) | Self::Sphere(size) | Self::Segment(_, size) => {
                std::slice::from_mut(size)
            }
            Self::Slot(_, sizes) => sizes,
            Self::Arc(sizes) => sizes,
            Self::Point | Self::Line(_) | Self::Plane(_) | Self::Profile(_) => &mut [],
        }
    }

    /// Whether it touches in space, and not in a plane.
    #[must_use]
    pub fn is_in_space(&self) -> bool {
        matches!(self, Self::Sphere(_) | Self::Plane(_))
    }

    /// Of two shapes the one with the lower rank has the axes in which they meet.
    #[must_use]
    pub fn rank(&self) -> usize {
        match self {
            Self::Profile(_) => 0,
            Self::Line(_) | Self::Plane(_) | Self::Segment(..) | Self::Slot(..) | Self::Arc(_) => 1,
            Self::Hole(_) => 2,
            Self::Circle(_) | Self::Sphere(_) => 3,
            Self::Point => 4,
        }
    }
}

/// Dry friction on a free axis, along a contact's line or at a junction.
#[derive(Clone, Debug)]
pub struct Friction {
    /// Its name (no dots).
    pub name: Name,
    /// A joint, a contact, or a junction.
    pub target: Name,
    /// `coulomb E;` while it slides: an effort, or a coefficient where the normal force is known.
    pub coulomb: Option<Expression>,
    /// `static E;` up to which it sticks, alike; that of sliding when left out.
    pub at_rest: Option<Expression>,
    /// `stribeck E;` the speed over which the one falls to the other.
    pub stribeck: Option<Expression>,
    /// `viscous E;` effort per flow.
    pub viscous: Option<Expression>,
    /// `normal E;` the normal force, N.
    pub normal: Option<Expression>,
    /// `radius E;` at which it acts on a turning axis, m.
    pub radius: Option<Expression>,
    /// `creep E;` the speed that regularises the law: it does not stick.
    pub creep: Option<Expression>,
    /// `stiffness E;` of the spring by which it sticks where shapes touch in space, N/m.
    pub stiffness: Option<Expression>,
}

impl Friction {
    /// A friction without clauses.
    #[must_use]
    pub fn new(name: Name, target: Name) -> Self {
        Self {
            name,
            target,
            coulomb: None,
            at_rest: None,
            stribeck: None,
            viscous: None,
            normal: None,
            radius: None,
            creep: None,
            stiffness: None,
        }
    }
}

/// The ends of a free axis or of a junction's displacement: one-sided springs with dampers, or rigid with a coefficient
/// of restitution.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Its name (no dots).
    pub name: Name,
    /// A joint or a junction.
    pub target: Name,
    /// `at least E;` the lower end.
    pub least: Option<Expression>,
    /// `at most E;` the upper end.
    pub most: Option<Expression>,
    /// `stiffness E;`
    pub stiffness: Option<Expression>,
    /// `damping E;`
    pub damping: Option<Expression>,
    /// `restitution E;` in the place of stiffness and damping: the part of its speed with which something leaves that
    /// hits it.
    pub restitution: Option<Expression>,
    /// `rest below E;` the speed of a rebound below which it rests.
    pub rest: Option<Expression>,
    /// `start E;` the displacement at t = 0; 0 when left out.
    pub start: Option<Expression>,
}

impl Stop {
    /// A stop without clauses.
    #[must_use]
    pub fn new(name: Name, target: Name) -> Self {
        Self {
            name,
            target,
            least: None,
            most: None,
            stiffness: None,
            damping: None,
            restitution: None,
            rest: None,
            start: None,
        }
    }
}

/// A sharp edge that a fluid flows through: the flow goes with the square root of the pressure.
#[derive(Clone, Debug)]
pub struct Orifice {
    /// Its name (no dots).
    pub name: Name,
    /// A hydraulic 1-junction.
    pub target: Name,
    /// `area E;`, m^2.
    pub area: Option<Expression>,
    /// `coefficient E;` of discharge.
    pub coefficient: Option<Expression>,
    /// `density E;` of the fluid, kg/m^3.
    pub density: Option<Expression>,
    /// `laminar E;` the pressure below which the flow is laminar, Pa.
    pub laminar: Option<Expression>,
}

/// One law of a contact's axis.
#[derive(Clone, Debug)]
pub struct AxisLaw {
    /// The axis.
    pub axis: Axis,
    /// C or R.
    pub kind: ElementKind,
    /// The law's variable, for a nonlinear law.
    pub variable: Option<LawVariable>,
    /// The law, or the parameter of a linear one.
    pub law: Expression,
    /// Where the law starts.
    pub span: Span,
}

/// An expression with its place.
#[derive(Clone, Debug)]
pub struct Expression {
    /// What it is.
    pub kind: ExpressionKind,
    /// The token to blame.
    pub span: Span,
}

/// What an expression is.
#[derive(Clone, Debug)]
pub enum ExpressionKind {
    /// A number; in a unit check it takes the unit that its place asks for.
    Number(f64),
    /// `75 mm`
    Quantity(f64, Unit),
    /// A name, possibly dotted, possibly with a component (`.x`) at the end.
    Name(Name),
    /// `-a`
    Negate(Box<Expression>),
    /// `a + b - c` or `a * b / c`: operators that bind alike, from left to right. The first operand is neither, so that
    /// a chain of any length is one level of the tree.
    Chain(Box<Expression>, Vec<Operation>),
    /// `f(a, b)`
    Call(Name, Vec<Expression>),
    /// `[a, b, c]`; a matrix is a vector of its rows.
    Vector(Vec<Expression>),
    /// `if a < b { c } else { d }`
    If(Box<Choice>),
}

/// An `if`.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The comparison.
    pub comparison: Comparison,
    /// Its left side.
    pub left: Expression,
    /// Its right side.
    pub right: Expression,
    /// The value where it holds.
    pub then: Expression,
    /// The value elsewhere.
    pub otherwise: Expression,
}

/// What a chain does next.
#[derive(Clone, Debug)]
pub struct Operation {
    /// The operator.
    pub operator: BinaryOperator,
    /// Where it stands.
    pub span: Span,
    /// Its right side.
    pub operand: Expression,
}

impl Expression {
    /// The same, where numbers only are in this unit: SI or a quantity. A coherent unit changes nothing, nor does any
    /// unit change 0.
    #[must_use]
    pub fn in_unit(self, unit: &Unit) -> Self {
        match self.number() {
            Some(number) if number != 0.0 && !unit.is_coherent() => {
                Self { kind: ExpressionKind::Quantity(number, unit.clone()), span: self.span }
            }
            _ => self,
        }
    }

    /// The value, where it is made of numbers without units only.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        self.folded(&Self::number)
    }

    /// The value of an expression of numbers whose operands have the values `of`.
    pub(crate) fn folded(&self, of: &dyn Fn(&Self) -> Option<f64>) -> Option<f64> {
        match &self.kind {
            ExpressionKind::Number(value) => Some(*value),
            ExpressionKind::Negate(inner) => Some(-of(inner)?),
            ExpressionKind::Chain(first, rest) => rest.iter().try_fold(of(first)?, |value, operation| {
                let right = of(&operation.operand)?;
                Some(match operation.operator {
                    BinaryOperator::Add => value + right,
                    BinaryOperator::Subtract => value - right,
                    BinaryOperator::Multiply => value * right,
                    BinaryOperator::Divide => value / right,
                })
            }),
            _ => None,
        }
    }
}

/// The operator of an `if`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the field's own words")]
pub enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

/// A binary operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the field's own words")]
pub enum BinaryOperator {
    Add,
    Subtract,
    Multiply,
    Divide,
}
