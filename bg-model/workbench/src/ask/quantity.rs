//! Numbers as a person gives them: `75`, `75mm`, `30 deg`.
//!
//! In: a text, the unit in which a parameter or an input is declared. Out: the number in that unit. Columns of files
//! have their units in their heads.

use std::f64::consts::TAU;

use bg_units::{Dimension, Unit};
use thiserror::Error;

/// A text that is no number in a unit.
#[derive(Clone, PartialEq, Eq, Debug, Error)]
pub enum QuantityError {
    /// It begins with no number, or what stands after that is no unit.
    #[error("must be a number, and `{0}` is none")]
    NotANumber(String),
    /// What should be a unit is none.
    #[error("must be in {declared} or a unit like it, and `{given}` is no unit")]
    NoUnit {
        /// What there is.
        given: String,
        /// The declared unit.
        declared: String,
    },
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
    match Conversion::between(unit, declared) {
        Ok(conversion) => Ok(conversion.of(number)),
        Err(QuantityError::NoUnit { .. }) => Err(not_a_number()),
        Err(fault) => Err(fault),
    }
}

/// What makes numbers in one unit numbers in another one.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Conversion {
    /// From which unit to which; nothing where they are the same.
    units: Option<(Unit, Unit)>,
}

impl Conversion {
    /// From the unit `given` to the unit `declared`.
    ///
    /// # Errors
    /// [`QuantityError::NoUnit`], [`QuantityError::OtherUnit`].
    pub fn between(given: &str, declared: &str) -> Result<Self, QuantityError> {
        if given == declared {
            return Ok(Self { units: None });
        }
        let none = |_| QuantityError::NoUnit { given: given.to_owned(), declared: declared.to_owned() };
        let other = || QuantityError::OtherUnit { given: given.to_owned(), declared: declared.to_owned() };
        let from: Unit = given.parse().map_err(none)?;
        let to: Unit = declared.parse().map_err(|_| other())?;
        if from.dimension == to.dimension { Ok(Self { units: Some((from, to)) }) } else { Err(other()) }
    }

    /// The number in the other unit.
    pub fn of(self, number: f64) -> f64 {
        self.units.map_or(number, |(from, to)| from.convert(number, to))
    }
}

/// A whole turn in a unit; infinite in one that measures no angle.
pub fn turn(unit: &str) -> f64 {
    let unit = unit.parse::<Unit>().ok().filter(|unit| unit.dimension == Dimension::NONE && unit.angle == 1);
    unit.map_or(f64::INFINITY, |unit| unit.from_si(TAU))
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFINITY: f64 = f64::INFINITY;

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
    fn a_turn_is_one_in_any_unit_of_angles() {
        assert_eq!(
            ["rad", "deg", "rad/s", "m", "", "1"].map(turn),
            [TAU, 360.0, INFINITY, INFINITY, INFINITY, INFINITY]
        );
        let conversion = Conversion::between("ms", "s").unwrap();
        assert_eq!((conversion.of(250.0), Conversion::between("", "1").unwrap().of(0.1)), (0.25, 0.1));
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
