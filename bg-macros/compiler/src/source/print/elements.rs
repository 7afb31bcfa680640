//! Junctions and elements as text.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{Direction, Element, ElementKind, Held, Junction, JunctionKind, LawVariable, Role};
use crate::source::print::clause;
use crate::source::words::{ELEMENTS, ROLES, word_of};

impl Display for Junction {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let kind = u8::from(self.kind == JunctionKind::One);
        // A number at the end of a name would be read as the cardinality.
        let is_plain = self.cardinality == 1 && !self.name.text.ends_with(']');
        let cardinality = if is_plain { String::new() } else { format!("[{}]", self.cardinality) };
        let domain = self.domain.as_ref().map_or_else(String::new, |domain| format!(": {domain}"));
        write!(f, "{kind} {}{cardinality}{domain};", self.name)
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let variable = self.variable.as_ref().map_or_else(String::new, LawVariable::to_string);
        write!(f, "{} {}{variable} = {}", word_of(&ELEMENTS, &self.kind), self.name, self.law)?;
        let clauses = [
            clause("in", self.frame.as_ref()),
            clause("at", self.displacement.as_ref()),
            clause("start", self.start.as_ref()),
            clause("energy", self.energy.as_ref()),
            clause("holds", self.sticking.as_ref()),
            clause("restitution", self.restitution.as_ref()),
            clause("rest below", self.rest.as_ref()),
        ];
        let held = self.held.as_ref().map_or_else(String::new, |held| format!(" of {held}"));
        write!(f, "{}{held};", clauses.concat())
    }
}

impl Display for Held {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}", self.joint)?;
        match self.direction {
            Some(Direction::Along(axis)) => write!(f, " along {}", axis.letter()),
            Some(Direction::About(axis)) => write!(f, " about {}", axis.letter()),
            None => Ok(()),
        }
    }
}

impl ElementKind {
    /// The field's symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        word_of(&ELEMENTS, &self)
    }
}

impl Display for Role {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(word_of(&ROLES, self))
    }
}

impl Display for LawVariable {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.role {
            Some(role) => write!(f, "({} {})", role, self.name),
            None => write!(f, "({})", self.name),
        }
    }
}
