//! Units: `kg*m^2/s`, `1/s`, `1`.
//!
//! In: the tokens after a `:`, or after a number. Out: a [`Unit`]; after a `:` whether its symbols are known is for a
//! later stage.

use proc_macro2::Delimiter;

use super::{
    SyntaxFault,
    cursor::{Cursor, Parsed, Reported},
    token::{TokenKind, joined},
};
use crate::source::ast::{Name, Unit};

impl Cursor<'_> {
    /// The unit after a number, if one is there: known symbols, and no statement of which one is the first word.
    pub fn unit_after_number(&mut self) -> Parsed<Option<Unit>> {
        let begins_element = self.starts_statement() && self.word_ahead(1).is_some();
        if begins_element || !self.is_symbol_of_unit(0) {
            return Ok(None);
        }
        let start = self.span();
        let mut factors = vec![self.unit_factor(1)?];
        while let Some(sign) = self.unit_separator().filter(|_| self.is_symbol_of_unit(1)) {
            self.advance();
            factors.push(self.unit_factor(sign)?);
        }
        Ok(Some(Unit { factors, span: joined(start, self.last_span()) }))
    }

    /// Whether the token `ahead` is the symbol of a unit, and neither calls a function nor begins a name with dots.
    fn is_symbol_of_unit(&self, ahead: usize) -> bool {
        let is_known = self.word_ahead(ahead).is_some_and(|word| bg_units::Unit::of_symbol(word).is_some());
        let is_call = matches!(self.ahead(ahead + 1),
            Some(TokenKind::Group(group)) if group.delimiter() == Delimiter::Parenthesis);
        is_known && !is_call && !self.symbol_ahead(ahead + 1, ".")
    }

    /// A unit; each `/` is for the one factor after it.
    pub fn unit(&mut self) -> Parsed<Unit> {
        let start = self.span();
        let mut end = start;
        let mut factors = Vec::new();
        if self.peek().and_then(TokenKind::number).as_deref() == Some("1") {
            self.advance();
        } else {
            factors.push(self.unit_factor(1)?);
            end = self.last_span();
        }
        while let Some(sign) = self.unit_separator() {
            self.advance();
            factors.push(self.unit_factor(sign)?);
            end = self.last_span();
        }
        self.end_unit()?;
        Ok(Unit { factors, span: joined(start, end) })
    }

    /// The sign that the separator ahead gives to the exponent after it.
    fn unit_separator(&self) -> Option<i32> {
        match self.peek() {
            Some(TokenKind::Symbol("*")) => Some(1),
            Some(TokenKind::Symbol("/")) => Some(-1),
            _ => None,
        }
    }

    /// `m^2`
    fn unit_factor(&mut self, sign: i32) -> Parsed<(Name, i32)> {
        let Some(text) = self.word().map(str::to_owned) else { return Err(self.not_a_unit()) };
        let span = self.advance();
        let exponent = if self.eat("^").is_some() { self.unit_exponent()? } else { 1 };
        Ok((Name::new(text, span), sign * exponent))
    }

    /// `2`, `-1`
    fn unit_exponent(&mut self) -> Parsed<i32> {
        let sign = if self.eat("-").is_some() { -1 } else { 1 };
        let digits = self.peek().and_then(TokenKind::number);
        let Some(exponent) = digits.and_then(|digits| digits.parse::<u8>().ok()) else {
            return Err(self.not_a_unit());
        };
        self.advance();
        Ok(sign * i32::from(exponent))
    }

    /// Refuses what looks like a further factor without a separator.
    fn end_unit(&self) -> Parsed<()> {
        match self.peek() {
            Some(TokenKind::Symbol("." | "^" | "**" | "-" | "+")) => Err(self.not_a_unit()),
            Some(TokenKind::Word(_) | TokenKind::Literal(_) | TokenKind::Group(_)) if !self.starts_statement() => {
                Err(self.not_a_unit())
            }
            _ => Ok(()),
        }
    }

    /// Notes that the token ahead does not belong in a unit.
    fn not_a_unit(&self) -> Reported {
        self.note(self.span(), &SyntaxFault::NotAUnit { found: self.found() })
    }
}
