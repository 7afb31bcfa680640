//! What became of many inputs.

use std::collections::BTreeMap;
use std::fmt;

use super::{KINDS, Kind, Outcome, Violation};

/// What became of the inputs of one kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// All of them.
    pub inputs: u64,
    /// Those that are no tokens.
    pub no_tokens: u64,
    /// Those that were accepted.
    pub accepted: u64,
    /// Those that were refused, by code; an input with several codes counts for each.
    pub refused: BTreeMap<String, u64>,
    /// Those that broke a promise.
    pub violations: u64,
}

/// What became of the inputs of every kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally([Count; KINDS.len()]);

impl Tally {
    /// Counts one input. Gives the codes that are new.
    pub fn count(&mut self, kind: Kind, result: &Result<Outcome, Violation>) -> Vec<String> {
        let count = &mut self.0[kind as usize];
        count.inputs += 1;
        let mut new = Vec::new();
        match result {
            Ok(Outcome::NoTokens) => count.no_tokens += 1,
            Ok(Outcome::Accepted) => count.accepted += 1,
            Ok(Outcome::Refused(codes)) => {
                for code in codes {
                    *count.refused.entry(code.clone()).or_default() += 1;
                }
                new.extend(codes.iter().filter(|code| self.of(code) == 1).cloned());
            }
            Err(_) => count.violations += 1,
        }
        new
    }

    /// What became of the inputs of this kind.
    #[must_use]
    pub fn kind(&self, kind: Kind) -> &Count {
        &self.0[kind as usize]
    }

    /// How many inputs of all kinds were refused with this code.
    #[must_use]
    pub fn of(&self, code: &str) -> u64 {
        self.0.iter().filter_map(|count| count.refused.get(code)).sum()
    }

    /// All codes, each with the number of inputs that were refused with it.
    #[must_use]
    pub fn codes(&self) -> BTreeMap<&str, u64> {
        let mut all = BTreeMap::new();
        for (code, count) in self.0.iter().flat_map(|count| &count.refused) {
            *all.entry(code.as_str()).or_default() += count;
        }
        all
    }

    /// How many inputs of all kinds broke a promise.
    #[must_use]
    pub fn violations(&self) -> u64 {
        self.0.iter().map(|count| count.violations).sum()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<12}{:>9}{:>11}{:>11}{:>8}{:>12}",
            "kind", "inputs", "no tokens", "accepted", "codes", "violations"
        )?;
        for kind in KINDS {
            let Count { inputs, no_tokens, accepted, refused, violations } = self.kind(kind);
            let (name, codes) = (kind.name(), refused.len());
            writeln!(f, "{name:<12}{inputs:>9}{no_tokens:>11}{accepted:>11}{codes:>8}{violations:>12}")?;
        }
        let codes = self.codes();
        write!(f, "{} codes:", codes.len())?;
        codes.iter().try_for_each(|(code, count)| write!(f, " {code} {count}"))?;
        writeln!(f)
    }
}
