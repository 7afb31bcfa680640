//! Parameters, inputs, values, states, memories, tables and units as text.

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{
    Between, Beyond, Bound, Choice, Every, Input, Let, Memory, Parameter, Sample, State, Table, Unit,
};
use crate::source::print::{block, clause, documentation};
use crate::source::words::{BETWEEN, BEYOND, COMPARISONS, word_of};

impl Display for Parameter {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "param {}: {} = {}", self.name, self.unit, self.default)?;
        for (bound, inside, open) in [(&self.lower, "at least", "above"), (&self.upper, "at most", "below")] {
            if let Some(Bound { value, included }) = bound {
                write!(f, ", {} {value}", if *included { inside } else { open })?;
            }
        }
        f.write_str(";")
    }
}

impl Display for Input {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "input {}: {};", self.name, self.unit)
    }
}

impl Display for Let {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let unit = self.unit.as_ref().map_or_else(String::new, |unit| format!(": {unit}"));
        write!(f, "let {}{unit} = {};", self.name, self.value)
    }
}

impl Display for Unit {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if self.factors.first().is_none_or(|&(_, exponent)| exponent < 0) {
            f.write_str("1")?;
        }
        for (i, (symbol, exponent)) in self.factors.iter().enumerate() {
            match (i, *exponent < 0) {
                (_, true) => write!(f, "/{symbol}")?,
                (0, false) => write!(f, "{symbol}")?,
                (_, false) => write!(f, "*{symbol}")?,
            }
            if exponent.abs() != 1 {
                write!(f, "^{}", exponent.abs())?;
            }
        }
        Ok(())
    }
}

impl Display for State {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "state {}: {} = {}{};", self.name, self.unit, self.rate, clause("start", self.start.as_ref()))
    }
}

impl Display for Memory {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self { name, unit, following: Choice { comparison, left, right, then, .. }, start } = self;
        let sign = word_of(&COMPARISONS, comparison);
        write!(f, "memory {name}: {unit} = {then} while {left} {sign} {right}{};", clause("start", start.as_ref()))
    }
}

impl Display for Every {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let sample = |Sample { name, unit, value, start }: &Sample| {
            format!("sample {name}: {unit} = {value}{};", clause("start", start.as_ref()))
        };
        write!(f, "{} ", self.times())?;
        block(f, &self.samples.iter().map(sample).collect::<Vec<_>>())
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self { name, argument, second, value, points, between, beyond } = self;
        let second = second.as_ref().map(|second| format!(", {second}")).unwrap_or_default();
        write!(f, "table {name}: {argument}{second} -> {value} = {points}")?;
        if *between != Between::default() {
            write!(f, ", {}", word_of(&BETWEEN, between))?;
        }
        if *beyond != Beyond::default() {
            write!(f, ", {}", word_of(&BEYOND, beyond))?;
        }
        f.write_str(";")
    }
}
