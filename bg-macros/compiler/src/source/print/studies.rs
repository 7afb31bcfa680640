//! Tracks, observations and scenes as text.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{Close, Expectation, Item, Observation, Rigid, Scene, Track, Tune, Watch};
use crate::source::print::{block, clause, documentation, list};
use crate::source::words::{TRACKS, word_of};

/// The longest list that stays on one line, in columns; three levels of indentation keep it within 120.
const LINE: usize = 108;

impl Display for Track {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let start = clause("start", self.start.as_ref());
        write!(f, "{} {} of {}{start};", word_of(&TRACKS, &self.kind), self.name, self.junction)
    }
}

impl Display for Close {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "close {} = {};", self.joint, self.gap)
    }
}

impl Display for Watch {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Value(observation) => observation.fmt(f),
            Self::All(name) => write!(f, "all of {name}"),
        }
    }
}

impl Display for Observation {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match (&self.name, &self.unit) {
            (Some(name), Some(unit)) => write!(f, "{name}: {unit} = {}", self.value),
            (Some(name), None) => write!(f, "{name} = {}", self.value),
            (None, _) => self.value.fmt(f),
        }
    }
}

impl Display for Scene {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        let mut entries = Vec::new();
        if !self.observe.is_empty() {
            entries.push(Item::Observe(self.observe.clone()).to_string());
        }
        match &self.tune {
            Tune::All => {}
            Tune::Only(names) => entries.push(format!("tune {}", list(names, ", "))),
            Tune::AllBut(names) => entries.push(format!("tune all but {}", list(names, ", "))),
        }
        if !self.without.is_empty() {
            entries.push(format!("without {}", list(&self.without, ", ")));
        }
        match &self.rigid {
            Rigid::None => {}
            Rigid::All(_) => entries.push("rigid joints;".into()),
            Rigid::Some(names) => entries.push(format!("rigid {}", list(names, ", "))),
        }
        if !self.dependent.is_empty() {
            entries.push(format!("dependent {}", list(&self.dependent, ", ")));
        }
        entries.extend(self.all_reactions.then(|| "all reactions;".into()));
        entries.extend(self.angles.then(|| "angles;".into()));
        entries.extend(self.expect.iter().map(Expectation::to_string));
        write!(f, "scene {} ", self.name)?;
        block(f, &entries)
    }
}

impl Display for Expectation {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::IntegralCausality => f.write_str("expect integral causality;"),
            Self::Planar(_) => f.write_str("expect planar;"),
            Self::States(states, _) => write!(f, "expect states = {states};"),
            Self::IndependentSpeeds(_) => f.write_str("expect independent speeds;"),
        }
    }
}

/// `observe { a; b = E }`, on several lines when it is long.
pub(super) fn observe(f: &mut Formatter<'_>, watched: &[Watch]) -> Result {
    let line = list(watched, "; ");
    f.write_str("observe ")?;
    if line.chars().count() <= LINE {
        return f.write_str(&line);
    }
    let entries: Vec<String> = watched.iter().map(|watch| format!("{watch};")).collect();
    block(f, &entries)
}
