//! What users write for numbers that the language writes otherwise: constants, and words for units.
//!
//! In: a word. Out: what to write in its place.

use crate::fault::near_miss;

/// A name for a number that the language does not have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Constant {
    /// The name, in small letters.
    name: &'static str,
    /// The number.
    number: &'static str,
    /// What else there is to say.
    remark: &'static str,
}

const CONSTANTS: [Constant; 4] = [
    Constant { name: "pi", number: "3.141592653589793", remark: "" },
    Constant { name: "tau", number: "6.283185307179586", remark: "" },
    Constant { name: "deg", number: "1 deg", remark: ": a unit stands after its number, as in `90 deg`" },
    Constant { name: "rpm", number: "1 rpm", remark: ": a unit stands after its number, as in `1450 rpm`" },
];

/// Words for units, and their symbols.
const WORDS_OF_UNITS: [(&str, &str); 16] = [
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("millimetre", "mm"),
    ("millimeter", "mm"),
    ("metre", "m"),
    ("meter", "m"),
    ("sec", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("hour", "h"),
    ("minute", "min"),
    ("Nm", "N*m"),
    ("RPM", "rpm"),
    ("kph", "km/h"),
];

/// The constant of this name.
pub fn constant(name: &str) -> Option<&'static Constant> {
    CONSTANTS.iter().find(|constant| constant.name.eq_ignore_ascii_case(name))
}

impl Constant {
    /// How to write it.
    pub fn written(&self) -> String {
        format!("write `{}` for {}{}", self.number, self.name, self.remark)
    }
}

/// The symbol of the unit that a word stands for, or nearly.
pub fn symbol_for(word: &str) -> Option<&'static str> {
    let named = WORDS_OF_UNITS.iter().find(|(known, _)| *known == word).map(|(_, symbol)| *symbol);
    named.or_else(|| near_miss(word, bg_units::symbols().filter(|symbol| symbol.len() > 1)))
}
