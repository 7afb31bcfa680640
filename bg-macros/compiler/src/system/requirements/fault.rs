//! A value that cannot be.

use super::Requirement;
use crate::fault::Explain;

/// What a value that cannot be is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Demand {
    Number,
    Matrix,
    Orientation,
    Stop,
}

/// A value that does not hold what is asked of it.
pub struct RequirementFault<'a> {
    /// What was asked.
    pub requirement: &'a Requirement,
    /// The scalar's value.
    pub value: f64,
}

impl Explain for RequirementFault<'_> {
    fn code(&self) -> &'static str {
        match self.requirement.fault {
            Demand::Number => "BG0701",
            Demand::Matrix => "BG0702",
            Demand::Orientation => "BG0703",
            Demand::Stop => "BG0704",
        }
    }

    fn message(&self) -> String {
        let Requirement { subject, wanted, unit, .. } = self.requirement;
        match unit {
            Some(unit) if self.value > 0.0 => {
                format!("{subject} is {}, too near 0 to calculate with", format!("{:e} {unit}", self.value).trim_end())
            }
            Some(unit) => format!("{subject} is {}; it {wanted}", format!("{} {unit}", self.value).trim_end()),
            None => format!("{subject} {wanted}"),
        }
    }

    fn help(&self) -> String {
        if self.value > 0.0 && self.requirement.unit.is_some() {
            return "give a larger value".to_owned();
        }
        self.requirement.help.to_owned()
    }
}
