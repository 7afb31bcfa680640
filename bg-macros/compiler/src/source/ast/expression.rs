//! Expressions, as they were written.

use proc_macro2::Span;

use crate::source::ast::{Name, Unit};

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
