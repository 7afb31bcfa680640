//! Expressions with resolved names.
//!
//! In: `ast::Expression`. Out: [`Term`]. No longer occurs: a name as text.

use proc_macro2::Span;

use super::NodeId;
use super::units::Dimension;
use crate::source::ast::{BinaryOperator, Comparison};
use crate::source::words::{value_of, word_of};

/// An expression with its place in the source.
#[derive(Clone, Debug)]
pub struct Term {
    /// What it is.
    pub kind: TermKind,
    /// The token to blame.
    pub span: Span,
}

/// What an expression is.
#[derive(Clone, Debug)]
pub enum TermKind {
    /// A number; its unit is what its place asks for.
    Number(f64),
    /// A number in coherent SI, with its dimension.
    Quantity(f64, Dimension),
    /// A quantity of the graph.
    Reference(Reference),
    /// One component (0, 1, 2) of a vector.
    Component(Box<Term>, usize),
    /// `-a`
    Negate(Box<Term>),
    /// Operators that bind alike, from left to right.
    Chain(Box<Term>, Vec<Operation>),
    /// A function.
    Call(Builtin, Vec<Term>),
    /// The value of a table at its arguments, or a derivative of it.
    Lookup(Lookup, Vec<Term>),
    /// A vector, or a matrix by its rows.
    Vector(Vec<Term>),
    /// `if left < right { then } else { otherwise }`, with `left < right` as written.
    If(Comparison, String, Box<[Term; 4]>),
    /// The first at an instant of this clock, an index into [`BondGraph::clocks`](super::BondGraph::clocks), else the
    /// second.
    AtInstant(usize, Box<[Term; 2]>),
    /// The solution of the assembly for this guess.
    Guess(usize),
    /// A time integral since t = 0.
    Integral(usize),
}

/// What is asked of a table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Lookup {
    /// The table, an index into [`BondGraph::tables`](super::BondGraph::tables).
    pub table: usize,
    /// Its value (0), its derivative (1) or its second derivative (2) by the argument.
    pub order: usize,
}

/// What a chain does next.
#[derive(Clone, Debug)]
pub struct Operation {
    /// The operator.
    pub operator: BinaryOperator,
    /// Where it stands.
    pub span: Span,
    /// Its right side.
    pub operand: Term,
}

/// A quantity of the graph.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Reference {
    /// Time, s.
    Time,
    /// The variable of the law that the expression stands in.
    Variable,
    /// A parameter.
    Parameter(usize),
    /// An input.
    Input(usize),
    /// A named expression.
    Let(usize),
    /// A position or orientation.
    Track(usize),
    /// The flow of a 1-junction, or of an element's bond.
    Flow(NodeId),
    /// The effort of a 0-junction, or of an element's bond.
    Effort(NodeId),
    /// The power into an element, W.
    Power(NodeId),
    /// The energy stored in a C or I, J.
    Energy(NodeId),
    /// The displacement of a C, or of a scalar 1-junction.
    Displacement(NodeId),
    /// An angle that counts turns.
    Turn(usize),
    /// The momentum of an I.
    Momentum(NodeId),
    /// A state of the graph's own, an index into `integrals`.
    Own(usize),
    /// The energy of all storage elements, J.
    StoredEnergy,
    /// The power of all sources into the model, W.
    SuppliedPower,
    /// The power of all resistors out of the model, W.
    DissipatedPower,
}

/// A function of the language.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "the names are those of the language; `NAMES` lists them")]
pub enum Builtin {
    Sqrt,
    Root,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan2,
    Exp,
    Ln,
    Tanh,
    Abs,
    Pow,
    Dot,
    Cross,
    Norm,
    Skew,
    Transpose,
    Inverse,
    Outer,
    Identity,
    Diagonal,
    RotationX,
    RotationY,
    RotationZ,
}

/// What is one of these by the names of the language's functions; the others are words of the resolver's own.
const NAMES: [(&str, Builtin); 25] = [
    ("sqrt", Builtin::Sqrt),
    ("root", Builtin::Root),
    ("sin", Builtin::Sin),
    ("cos", Builtin::Cos),
    ("tan", Builtin::Tan),
    ("asin", Builtin::Asin),
    ("acos", Builtin::Acos),
    ("atan2", Builtin::Atan2),
    ("exp", Builtin::Exp),
    ("ln", Builtin::Ln),
    ("tanh", Builtin::Tanh),
    ("abs", Builtin::Abs),
    ("pow", Builtin::Pow),
    ("dot", Builtin::Dot),
    ("cross", Builtin::Cross),
    ("norm", Builtin::Norm),
    ("skew", Builtin::Skew),
    ("transpose", Builtin::Transpose),
    ("inverse", Builtin::Inverse),
    ("outer", Builtin::Outer),
    ("identity", Builtin::Identity),
    ("diagonal", Builtin::Diagonal),
    ("rotation_x", Builtin::RotationX),
    ("rotation_y", Builtin::RotationY),
    ("rotation_z", Builtin::RotationZ),
];

impl Builtin {
    /// The function of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        value_of(&NAMES, name)
    }

    /// The function's name.
    #[must_use]
    pub fn name(self) -> &'static str {
        word_of(&NAMES, &self)
    }
}

impl Term {
    /// Hands every part of the expression to `each`, itself first, in the order of reading.
    pub fn visit<'t>(&'t self, each: &mut dyn FnMut(&'t Term)) {
        each(self);
        match &self.kind {
            TermKind::Number(_)
            | TermKind::Quantity(..)
            | TermKind::Reference(_)
            | TermKind::Guess(_)
            | TermKind::Integral(_) => {}
            TermKind::Component(inner, _) | TermKind::Negate(inner) => inner.visit(each),
            TermKind::Chain(first, rest) => {
                first.visit(each);
                rest.iter().for_each(|operation| operation.operand.visit(each));
            }
            TermKind::Call(_, parts) | TermKind::Lookup(_, parts) | TermKind::Vector(parts) => {
                parts.iter().for_each(|part| part.visit(each));
            }
            TermKind::If(_, _, parts) => parts.iter().for_each(|part| part.visit(each)),
            TermKind::AtInstant(_, parts) => parts.iter().for_each(|part| part.visit(each)),
        }
    }

    /// The references in the expression itself (not in its lets), in the order of reading.
    pub fn references(&self, found: &mut Vec<Reference>) {
        self.visit(&mut |part| {
            if let TermKind::Reference(reference) = part.kind {
                found.push(reference);
            }
        });
    }

    /// Whether it is a linear function of the variable of its law, without a constant, as far as its form shows.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.degree() == Some(1)
    }

    /// Its degree in the variable of its law, 0 or 1; none where it is neither.
    fn degree(&self) -> Option<u8> {
        match &self.kind {
            TermKind::Reference(Reference::Variable) => Some(1),
            TermKind::Number(_)
            | TermKind::Quantity(..)
            | TermKind::Reference(_)
            | TermKind::Guess(_)
            | TermKind::Integral(_) => Some(0),
            TermKind::Component(inner, _) | TermKind::Negate(inner) => inner.degree(),
            TermKind::Chain(first, rest) => rest.iter().try_fold(first.degree()?, |degree, operation| {
                let right = operation.operand.degree()?;
                match operation.operator {
                    BinaryOperator::Add | BinaryOperator::Subtract => (degree == right).then_some(degree),
                    BinaryOperator::Multiply => Some(degree + right).filter(|&sum| sum < 2),
                    BinaryOperator::Divide => (right == 0).then_some(degree),
                }
            }),
            TermKind::Lookup(_, arguments) => arguments.iter().all(|part| part.degree() == Some(0)).then_some(0),
            TermKind::Call(builtin, arguments) => degree_of_call(*builtin, arguments),
            TermKind::Vector(parts) => {
                let is_zero = |part: &&Term| matches!(part.kind, TermKind::Number(0.0));
                let mut degrees = parts.iter().filter(|part| !is_zero(part)).map(Self::degree);
                let first = degrees.next().unwrap_or(Some(0))?;
                degrees.all(|degree| degree == Some(first)).then_some(first)
            }
            TermKind::If(_, _, parts) => parts.iter().all(|part| part.degree() == Some(0)).then_some(0),
            TermKind::AtInstant(_, parts) => parts.iter().all(|part| part.degree() == Some(0)).then_some(0),
        }
    }
}

fn degree_of_call(builtin: Builtin, arguments: &[Term]) -> Option<u8> {
    use Builtin as B;
    let sum = arguments.iter().map(Term::degree).sum::<Option<u8>>()?;
    let is_linear = matches!(builtin, B::Dot | B::Cross | B::Outer | B::Skew | B::Transpose | B::Diagonal);
    (sum == 0 || sum == 1 && is_linear).then_some(sum)
}
