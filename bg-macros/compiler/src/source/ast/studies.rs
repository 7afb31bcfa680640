//! What is followed, observed, watched and tuned; scenes, each one use of a mechanism.

use proc_macro2::Span;

use crate::source::ast::{Expression, Name, Unit};

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
