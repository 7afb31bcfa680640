//! Junctions and elements: the words of a bond graph.

use crate::source::ast::{Axis, Expression, Name};

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
