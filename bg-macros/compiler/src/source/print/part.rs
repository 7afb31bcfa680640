//! Parts as text.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{Argument, For, Part, Port, Start, Use};
use crate::source::print::{block, documentation, statements};
use crate::source::words::{STARTS, word_of};

impl Display for Part {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "{}part {} ", self.visibility.text(), self.name)?;
        statements(f, &self.items)
    }
}

impl Display for Use {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str("part ")?;
        if let Some(name) = &self.name {
            let count = self.count.map_or_else(String::new, |(count, _)| format!("[{count}]"));
            write!(f, "{name}{count}: ")?;
        }
        write!(f, "{}", self.part.name)?;
        let starts = self.starts.iter().map(Start::to_string);
        let entries: Vec<String> = self.arguments.iter().map(Argument::to_string).chain(starts).collect();
        if entries.is_empty() {
            return f.write_str(";");
        }
        f.write_str(" ")?;
        block(f, &entries)
    }
}

impl Display for Argument {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{} = {};", self.name, self.value)
    }
}

impl Display for Port {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Junction(junction) => write!(f, "port {junction}"),
            Self::Alias(name, of) => write!(f, "port {name} = {of};"),
        }
    }
}

impl Display for Start {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "start {} {} {};", self.of, word_of(&STARTS, &self.kind), self.value)
    }
}

impl Display for For {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "for {} in {}..{} ", self.index, self.from, self.to)?;
        statements(f, &self.items)
    }
}
