//! What physics asks of the values that a model's parameters give, such as a mass above 0.
//!
//! In: a model's table of requirements and the values of their scalars. Out: nothing, or the first that does not hold.
//! What numbers alone decide, the compiler has decided.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use thiserror::Error;

/// One thing that is asked of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// The value in the words of the description, such as "the mass of body `rod`".
    pub subject: &'static str,
    /// What is asked of it, such as "must be above 0".
    pub wanted: &'static str,
    /// The unit, where the scalar is the value itself.
    pub unit: Option<&'static str>,
    /// Whether the scalar must be above 0; otherwise at least 0.
    pub is_strict: bool,
    /// The parameters that it depends on.
    pub parameters: &'static [&'static str],
}

/// A value that cannot be.
#[derive(Clone, Copy, PartialEq, Error)]
#[error("{}{}{}", .requirement.subject, .requirement.said_of(*.value), .requirement.depends())]
pub struct Impossible {
    /// What does not hold.
    pub requirement: &'static Requirement,
    /// The scalar's value; that of the subject, in its unit, where it has one.
    pub value: f64,
}

debug_is_display!(Impossible);

impl Requirement {
    /// What is wrong with the value.
    fn said_of(&self, value: f64) -> String {
        // A pure number has no unit in print.
        match self.unit.map(|unit| if unit == "1" { "" } else { unit }) {
            Some(unit) if value > 0.0 => {
                format!(" is {}, too near 0 to calculate with", format!("{value:e} {unit}").trim_end())
            }
            Some(unit) => format!(" is {}; it {}", format!("{value} {unit}").trim_end(), self.wanted),
            None => format!(" {}", self.wanted),
        }
    }

    /// The parameters to change.
    fn depends(&self) -> String {
        let names: Vec<String> = self.parameters.iter().map(|name| format!("`{name}`")).collect();
        if names.is_empty() { String::new() } else { format!("; it depends on {}", names.join(", ")) }
    }

    /// Whether a value is allowed; what is no number is not, nor is one so near 0 that it has no reciprocal.
    fn holds(&self, value: f64) -> bool {
        if self.is_strict && self.unit.is_some() {
            value >= f64::MIN_POSITIVE
        } else {
            value > 0.0 || value == 0.0 && !self.is_strict
        }
    }
}

/// Checks one value for each requirement.
///
/// # Errors
/// The first that does not hold. What is not a number does not.
pub fn require(requirements: &'static [Requirement], values: &[f64]) -> Result<(), Impossible> {
    let failed = requirements.iter().zip(values).find(|(requirement, value)| !requirement.holds(**value));
    failed.map_or(Ok(()), |(requirement, &value)| Err(Impossible { requirement, value }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MASS: Requirement = Requirement {
        subject: "the mass of body `rod`",
        wanted: "must be above 0",
        unit: Some("kg"),
        is_strict: true,
        parameters: &["length", "density"],
    };
    const STIFFNESS: Requirement =
        Requirement { subject: "the stiffness of `pin`", unit: Some("N/m"), is_strict: false, parameters: &[], ..MASS };
    const TENSOR: Requirement = Requirement {
        subject: "the inertia of body `rod`",
        wanted: "must be symmetric",
        unit: None,
        is_strict: false,
        parameters: &["a"],
    };
    static ALL: [Requirement; 3] = [MASS, STIFFNESS, TENSOR];
    static SLIP: [Requirement; 1] = [Requirement { subject: "the slip", unit: Some("1"), parameters: &[], ..MASS }];

    #[test]
    fn zero_is_too_little_for_some() {
        assert!(require(&ALL, &[1.0, 0.0, 0.0]).is_ok());
        assert!(require(&ALL, &[0.0, 1.0, 1.0]).is_err());
        assert!(require(&ALL, &[1.0, -1e-300, 1.0]).is_err());
        assert!(require(&ALL, &[f64::NAN, 1.0, 1.0]).is_err());
    }

    #[test]
    fn what_has_no_reciprocal_is_too_near_zero() {
        assert!(require(&ALL, &[1e-307, 1e-320, 1e-320]).is_ok());
        assert_eq!(
            require(&ALL, &[1e-320, 1.0, 1.0]).unwrap_err().to_string(),
            "the mass of body `rod` is 1e-320 kg, too near 0 to calculate with; it depends on `length`, `density`"
        );
    }

    #[test]
    fn the_first_that_fails_is_named_with_its_value_and_its_parameters() {
        let text = |values: &[f64]| require(&ALL, values).unwrap_err().to_string();
        assert_eq!(
            text(&[-2.0, -1.0, 1.0]),
            "the mass of body `rod` is -2 kg; it must be above 0; it depends on `length`, `density`"
        );
        assert_eq!(text(&[1.0, -1.0, 1.0]), "the stiffness of `pin` is -1 N/m; it must be above 0");
        let slip = require(&SLIP, &[-0.5]).unwrap_err().to_string();
        assert_eq!(slip, "the slip is -0.5; it must be above 0");
        assert_eq!(text(&[1.0, 1.0, -1.0]), "the inertia of body `rod` must be symmetric; it depends on `a`");
    }
}
