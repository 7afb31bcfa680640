//! Expressions, by precedence climbing.
//!
//! In: the tokens of a value. Out: an [`Expression`] no higher than [`DEEPEST`], so that later stages may recurse on
//! it; a sum or product of any length is one level. It ends in front of the first token that continues no expression,
//! such as `;`, `,` or a clause's word. Method: operator precedence parsing (Pratt, Top down operator precedence, POPL
//! 1973).

use proc_macro2::{Delimiter, Span};

use super::{
    SyntaxFault,
    cursor::{Block, Cursor, Parsed},
    token::TokenKind,
};
use crate::fault::near_miss;
use crate::source::ast::{BinaryOperator, Choice, Comparison, Expression, ExpressionKind, Operation};
use crate::source::names::is_reserved;
use crate::source::words::{COMPARISONS, OPERATORS, strength, value_of};

/// The greatest height of an expression's tree, far beyond any law that a human writes.
pub const DEEPEST: usize = 200;

/// The deepest nesting of operands. Without optimization this parser takes up to 8 kB of stack for each, and a thread
/// may have no more than 1 MB.
pub const MOST_NESTED: usize = 100;

/// The longest operand that a help line repeats, in characters; a longer one would hide the advice.
const LONGEST_BASE: usize = 40;

/// Inside of a group in an expression.
const GROUP: Block = Block { name: "the group", words: &[], list: false };

/// Operators that compare or join conditions.
const CONDITION: [&str; 8] = ["<", "<=", ">", ">=", "==", "!=", "&&", "||"];

/// An expression and the height of its tree.
struct Tall {
    expression: Expression,
    height: usize,
}

impl Cursor<'_> {
    /// An expression.
    pub fn expression(&mut self) -> Parsed<Expression> {
        self.value().map(|tall| tall.expression)
    }

    /// An expression that no comparison follows.
    fn value(&mut self) -> Parsed<Tall> {
        let tall = self.binary(0)?;
        match self.condition_symbol() {
            Some(operator) => Err(self.note(self.span(), &SyntaxFault::ComparisonOutsideIf { operator })),
            None => Ok(tall),
        }
    }

    /// Operands joined by operators that bind at least as strongly as `weakest`.
    fn binary(&mut self, weakest: u8) -> Parsed<Tall> {
        let mut left = self.operand()?;
        while let Some(operator) = self.operator().filter(|&operator| strength(operator) >= weakest) {
            let span = self.advance();
            let right = self.binary(strength(operator) + 1)?;
            left = self.joined(left, right.height, Operation { operator, span, operand: right.expression })?;
        }
        Ok(left)
    }

    /// `left` with one more operation on it: longer, where it is a chain that binds alike, otherwise one level higher.
    fn joined(&self, left: Tall, height: usize, operation: Operation) -> Parsed<Tall> {
        let span = operation.span;
        match left.expression.kind {
            ExpressionKind::Chain(first, mut rest) if alike(&rest, operation.operator) => {
                rest.push(operation);
                let below = (left.height - 1).max(height);
                self.above(below, ExpressionKind::Chain(first, rest), span)
            }
            kind => {
                let first = Expression { kind, span: left.expression.span };
                let chain = ExpressionKind::Chain(Box::new(first), vec![operation]);
                self.above(left.height.max(height), chain, span)
            }
        }
    }

    /// The operator ahead.
    fn operator(&self) -> Option<BinaryOperator> {
        match self.peek() {
            Some(TokenKind::Symbol(symbol)) => value_of(&OPERATORS, symbol),
            _ => None,
        }
    }

    /// An operand, one level deeper than what it stands in.
    fn operand(&mut self) -> Parsed<Tall> {
        if self.depth >= MOST_NESTED {
            return Err(self.note(self.span(), &SyntaxFault::TooDeep { limit: MOST_NESTED }));
        }
        self.depth += 1;
        let operand = self.primary().and_then(|operand| self.without_power(operand));
        self.depth -= 1;
        operand
    }

    /// A number, name, call, vector, `if`, negated operand, or an expression in parentheses.
    fn primary(&mut self) -> Parsed<Tall> {
        match self.peek() {
            Some(TokenKind::Symbol("-")) => self.negated(),
            Some(TokenKind::Literal(_)) => self.number(1.0),
            Some(TokenKind::Word(word)) if word == "if" => self.choice(),
            Some(TokenKind::Word(word)) if !is_reserved(word) => self.name_or_call(),
            Some(TokenKind::Group(group)) => match group.delimiter() {
                Delimiter::Bracket => self.vector(),
                Delimiter::Brace => Err(self.unexpected("an expression")),
                delimiter => self.block(delimiter, "an operator or `)`"),
            },
            _ => Err(self.unexpected("an expression")),
        }
    }

    /// `-a`; the sign of a number is part of it.
    fn negated(&mut self) -> Parsed<Tall> {
        let span = self.advance();
        let is_power = self.symbol_ahead(1, "^") || self.symbol_ahead(1, "**");
        if self.peek().is_some_and(|token| token.number().is_some()) && !is_power {
            return self.number(-1.0);
        }
        let operand = self.operand()?;
        self.above(operand.height, ExpressionKind::Negate(Box::new(operand.expression)), span)
    }

    /// A decimal number.
    fn number(&mut self, sign: f64) -> Parsed<Tall> {
        let Some(text) = self.peek().and_then(TokenKind::number) else {
            return Err(self.unexpected("an expression"));
        };
        let Some(value) = decimal(&text) else {
            return Err(self.note(self.span(), &SyntaxFault::NotANumber { text }));
        };
        let span = self.advance();
        if self.is(".") {
            return Err(self.unexpected("an operator"));
        }
        let kind = match self.unit_after_number()? {
            Some(unit) => ExpressionKind::Quantity(sign * value, unit),
            None => ExpressionKind::Number(sign * value),
        };
        self.above(0, kind, span)
    }

    /// `frame.R.x` or `pow(a, b)`
    fn name_or_call(&mut self) -> Parsed<Tall> {
        let name = self.name("a value")?;
        let span = name.span;
        if self.delimiter() == Some(Delimiter::Bracket) {
            return Err(self.unexpected("a component such as `.x`"));
        }
        let Some(arguments) = self.enter(Delimiter::Parenthesis, &GROUP) else {
            return self.above(0, ExpressionKind::Name(name), span);
        };
        let (arguments, height) = arguments.elements("`,` or `)`")?;
        self.above(height, ExpressionKind::Call(name, arguments), span)
    }

    /// `[a, b, c]`
    fn vector(&mut self) -> Parsed<Tall> {
        let span = self.span();
        let inner = self.group(Delimiter::Bracket, "`[ ... ]`", &GROUP)?;
        if inner.ended() {
            return Err(inner.unexpected("an expression"));
        }
        let (elements, height) = inner.elements("`,` or `]`")?;
        self.above(height, ExpressionKind::Vector(elements), span)
    }

    /// All expressions of a group, separated by commas, and their height.
    fn elements(mut self, expected: &str) -> Parsed<(Vec<Expression>, usize)> {
        let (mut elements, mut height) = (Vec::new(), 0);
        while !self.ended() {
            let element = self.value()?;
            height = height.max(element.height);
            elements.push(element.expression);
            if let Some(fault) = self.unit_of_number() {
                return Err(self.note(self.span(), &fault));
            }
            if self.eat(",").is_none() {
                self.finish(expected)?;
            }
        }
        Ok((elements, height))
    }

    /// The one expression of a group.
    fn block(&mut self, delimiter: Delimiter, expected: &str) -> Parsed<Tall> {
        let form = if delimiter == Delimiter::Brace { "`{ ... }`" } else { "`( ... )`" };
        let mut inner = self.group(delimiter, form, &GROUP)?;
        let value = inner.value()?;
        if let Some(fault) = inner.bare_vector().or_else(|| inner.unit_of_number()) {
            return Err(inner.note(inner.span(), &fault));
        }
        inner.finish(expected)?;
        Ok(value)
    }

    /// `if a < b { c } else { d }`
    fn choice(&mut self) -> Parsed<Tall> {
        let span = self.advance();
        let (left, comparison, right) = self.compared()?;
        let then = self.block(Delimiter::Brace, "an operator or `}`")?;
        if self.eat_word("else").is_none() {
            if self.word().is_some_and(|word| near_miss(word, ["else"]).is_some()) {
                return Err(self.unexpected("`else`"));
            }
            return Err(self.note(span, &SyntaxFault::IfWithoutElse));
        }
        let otherwise = match self.word() {
            Some("if") => self.operand()?,
            _ => self.block(Delimiter::Brace, "an operator or `}`")?,
        };
        let height = left.height.max(right.height).max(then.height).max(otherwise.height);
        let choice = Choice {
            comparison,
            left: left.expression,
            right: right.expression,
            then: then.expression,
            otherwise: otherwise.expression,
        };
        self.above(height, ExpressionKind::If(Box::new(choice)), span)
    }

    /// `a < b`
    pub fn condition(&mut self) -> Parsed<(Expression, Comparison, Expression)> {
        let (left, comparison, right) = self.compared()?;
        Ok((left.expression, comparison, right.expression))
    }

    fn compared(&mut self) -> Parsed<(Tall, Comparison, Tall)> {
        let left = self.binary(0)?;
        let comparison = self.comparison()?;
        let right = self.binary(0)?;
        match self.joining() {
            Some(operator) => Err(self.note(self.span(), &SyntaxFault::SecondComparison { operator })),
            None => Ok((left, comparison, right)),
        }
    }

    /// What stands ahead and joins two comparisons, also in other languages.
    fn joining(&self) -> Option<String> {
        match self.peek() {
            Some(TokenKind::Symbol(symbol)) if CONDITION.contains(symbol) || matches!(*symbol, "&" | "|") => {
                Some((*symbol).to_owned())
            }
            Some(TokenKind::Word(word)) if matches!(word.as_str(), "and" | "or") => Some(word.clone()),
            _ => None,
        }
    }

    /// `<` and its like.
    fn comparison(&mut self) -> Parsed<Comparison> {
        match self.condition_symbol() {
            Some(operator @ ("==" | "!=")) => Err(self.note(self.span(), &SyntaxFault::Equality { operator })),
            Some(symbol) if let Some(comparison) = value_of(&COMPARISONS, symbol) => {
                self.advance();
                Ok(comparison)
            }
            _ => Err(self.unexpected("`<`, `<=`, `>` or `>=`")),
        }
    }

    /// The comparison or logical operator ahead.
    fn condition_symbol(&self) -> Option<&'static str> {
        match self.peek() {
            Some(TokenKind::Symbol(symbol)) if CONDITION.contains(symbol) => Some(symbol),
            _ => None,
        }
    }

    /// `operand`, after which no `^` may stand.
    fn without_power(&self, operand: Tall) -> Parsed<Tall> {
        let Some(TokenKind::Symbol(operator @ ("^" | "**"))) = self.peek() else { return Ok(operand) };
        let base = operand.expression.to_string();
        let base = if base.chars().count() > LONGEST_BASE { "a".into() } else { base };
        let exponent = match self.ahead(1) {
            Some(TokenKind::Word(word)) => word.clone(),
            Some(TokenKind::Literal(literal)) => literal.to_string(),
            _ => "b".into(),
        };
        Err(self.note(self.span(), &SyntaxFault::Power { operator, base, exponent }))
    }

    /// A tree on top of others of this height.
    fn above(&self, height: usize, kind: ExpressionKind, span: Span) -> Parsed<Tall> {
        if height >= DEEPEST {
            return Err(self.note(span, &SyntaxFault::TooDeep { limit: DEEPEST }));
        }
        Ok(Tall { expression: Expression { kind, span }, height: height + 1 })
    }
}

/// Whether an operator binds as those of a chain.
fn alike(chain: &[Operation], operator: BinaryOperator) -> bool {
    chain.first().is_some_and(|operation| strength(operation.operator) == strength(operator))
}

/// The value of a decimal literal without suffix; `None` also when it is beyond all floating-point numbers.
fn decimal(text: &str) -> Option<f64> {
    let plain = text.replace('_', "");
    let allowed = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-');
    let value = plain.chars().all(allowed).then(|| plain.parse::<f64>().ok())??;
    value.is_finite().then_some(value)
}
