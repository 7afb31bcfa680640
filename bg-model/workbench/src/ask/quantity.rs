//! Numbers as a person gives them: `75`, `75mm`, `30 deg`.
//!
//! In: a text, the unit in which a parameter or an input is declared. Out: the number in that unit.

use bg_units::Unit;
use thiserror::Error;

/// A text that is no number in a unit.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum QuantityError {
    /// It begins with no number, or what stands after that is no unit.
    #[error("must be a number, and `{0}` is none")]
    NotANumber(String),
    /// Its unit measures something else.
    #[error("must be in {declared} or a unit like it, and `{given}` is none")]
    OtherUnit {
        /// The unit in the text.
        given: String,
        /// The declared unit.
        declared: String,
    },
}

/// The number that a text gives, in the unit `declared`; a text without a unit is in that.
///
/// # Errors
/// No number, or a unit that cannot be converted.
pub fn quantity(text: &str, declared: &str) -> Result<f64, QuantityError> {
    if let Ok(number) = text.parse() {
        return Ok(number);
    }
    let not_a_number = || QuantityError::NotANumber(text.to_owned());
    // The longest number: the `e` of `2e3mm` is part of one.
    let ends = text.char_indices().rev().map(|(end, _)| end);
    let split = |end: usize| Some((text[..end].trim_end().parse::<f64>().ok()?, text[end..].trim()));
    let (number, unit) = ends.filter_map(split).next().ok_or_else(not_a_number)?;
    let given: Unit = unit.parse().map_err(|_| not_a_number())?;
    let other = || QuantityError::OtherUnit { given: unit.to_owned(), declared: declared.to_owned() };
    let to: Unit = declared.parse().map_err(|_| other())?;
    if given.dimension == to.dimension { Ok(given.convert(number, to)) } else { Err(other()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_converted_to_the_declared_one() {
        for (text, declared, expected) in [
            ("75", "mm", 75.0),
            ("75mm", "m", 0.075),
            ("7.5 cm", "mm", 75.0),
            ("-2e3mm", "m", -2.0),
            ("1450rpm", "rad/s", 1450.0 * std::f64::consts::PI / 30.0),
            ("3 kN/mm", "N/m", 3e6),
            ("5", "", 5.0),
            ("20percent", "", 0.2),
        ] {
            assert_eq!(quantity(text, declared), Ok(expected), "{text}");
        }
    }

    #[test]
    fn what_is_no_such_number_is_told() {
        let fault = |text: &str, declared: &str| quantity(text, declared).unwrap_err().to_string();
        assert_eq!(fault("heavy", "kg"), "must be a number, and `heavy` is none");
        assert_eq!(fault("3 stone", "kg"), "must be a number, and `3 stone` is none");
        assert_eq!(fault("3 s", "kg"), "must be in kg or a unit like it, and `s` is none");
        assert_eq!(fault("mm", "m"), "must be a number, and `mm` is none");
        assert_eq!(fault("", "m"), "must be a number, and `` is none");
    }
}
