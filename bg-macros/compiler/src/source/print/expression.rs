//! Expressions as text, with no parenthesis more than needed.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{Choice, Expression, ExpressionKind, Operation};
use crate::source::words::{COMPARISONS, OPERATORS, strength, word_of};

/// How strongly a minus binds: more than any binary operator.
const MINUS: u8 = 3;

impl Display for Expression {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.kind {
            ExpressionKind::Number(value) => f.write_str(&number(*value)),
            ExpressionKind::Quantity(value, unit) => write!(f, "{} {unit}", number(*value)),
            ExpressionKind::Name(name) => name.fmt(f),
            ExpressionKind::Negate(operand) => {
                // The sign of a number is part of the number, so that the minus in front of one needs parentheses.
                let is_number = matches!(
                    operand.kind,
                    ExpressionKind::Number(value) | ExpressionKind::Quantity(value, _) if value.is_sign_positive()
                );
                f.write_str("-")?;
                enclosed(f, operand, is_number || binding(operand) < MINUS)
            }
            ExpressionKind::Chain(first, rest) => operations(f, first, rest),
            ExpressionKind::Call(function, arguments) => write!(f, "{function}({})", separated(arguments)),
            ExpressionKind::Vector(elements) => write!(f, "[{}]", separated(elements)),
            ExpressionKind::If(choice) => choice.fmt(f),
        }
    }
}

impl Choice {
    /// The comparison as text.
    pub(crate) fn condition(&self) -> String {
        format!("{} {} {}", self.left, word_of(&COMPARISONS, &self.comparison), self.right)
    }
}

impl Display for Choice {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "if {} {{ {} }} else ", self.condition(), self.then)?;
        match &self.otherwise.kind {
            ExpressionKind::If(next) => next.fmt(f),
            _ => write!(f, "{{ {} }}", self.otherwise),
        }
    }
}

/// A sum or product of any length.
fn operations(f: &mut Formatter<'_>, first: &Expression, rest: &[Operation]) -> Result {
    let weakest = rest.first().map_or(MINUS, |operation| strength(operation.operator));
    enclosed(f, first, binding(first) < weakest)?;
    for Operation { operator, operand, .. } in rest {
        write!(f, " {} ", word_of(&OPERATORS, operator))?;
        enclosed(f, operand, binding(operand) <= strength(*operator))?;
    }
    Ok(())
}

/// An operand, in parentheses if need be.
fn enclosed(f: &mut Formatter<'_>, operand: &Expression, parentheses: bool) -> Result {
    if parentheses { write!(f, "({operand})") } else { operand.fmt(f) }
}

/// How strongly an expression holds together; an `if` stands in parentheses as an operand, for the eye.
fn binding(expression: &Expression) -> u8 {
    match &expression.kind {
        // What stands after a unit could be read as a part of it.
        ExpressionKind::If(_) | ExpressionKind::Quantity(..) => 0,
        ExpressionKind::Chain(_, rest) => rest.first().map_or(MINUS, |operation| strength(operation.operator)),
        _ => MINUS,
    }
}

/// Expressions separated by commas.
fn separated(expressions: &[Expression]) -> String {
    expressions.iter().map(Expression::to_string).collect::<Vec<_>>().join(", ")
}

/// The shortest text that reads back as `value`; with an exponent where plain digits would be mostly zeros.
fn number(value: f64) -> String {
    let plain = value.to_string();
    let exponent = format!("{value:e}");
    let is_plain = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if is_plain || plain.len() <= exponent.len() { plain } else { exponent }
}
