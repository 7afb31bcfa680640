//! A value that cannot be.

use super::Requirement;
use crate::fault::Explain;

/// A number in front of what is asked of it: BG0701 a number, BG0702 a matrix, BG0703 an orientation.
pub struct RequirementFault<'a> {
    /// What was asked.
    pub requirement: &'a Requirement,
    /// The scalar's value.
    pub value: f64,
}

impl Explain for RequirementFault<'_> {
    fn code(&self) -> &'static str {
        self.requirement.code
    }

    fn message(&self) -> String {
        let Requirement { subject, wanted, unit, .. } = self.requirement;
        match unit {
            Some(unit) => format!("{subject} is {}; it {wanted}", format!("{} {unit}", self.value).trim_end()),
            None => format!("{subject} {wanted}"),
        }
    }

    fn help(&self) -> String {
        self.requirement.help.to_owned()
    }
}
