//! What users write for numbers that the language writes otherwise: constants, and units that are not coherent.
//!
//! In: a word. Out: what to write in its place.

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
    Constant {
        name: "deg",
        number: "0.017453292519943295",
        remark: ": angles are in rad, 90 deg are 1.5707963267948966",
    },
    Constant { name: "rpm", number: "0.10471975511965977", remark: ": speeds are in rad/s" },
];

/// Units that are not coherent, what to write in their place, and their size in that.
const OTHER_UNITS: [(&str, &str, &str); 20] = [
    ("deg", "rad", "0.017453292519943295"),
    ("rpm", "rad/s", "0.10471975511965977"),
    ("mm", "m", "1e-3"),
    ("cm", "m", "1e-2"),
    ("km", "m", "1e3"),
    ("g", "kg", "1e-3"),
    ("t", "kg", "1e3"),
    ("ms", "s", "1e-3"),
    ("min", "s", "60"),
    ("h", "s", "3600"),
    ("kN", "N", "1e3"),
    ("bar", "Pa", "1e5"),
    ("kPa", "Pa", "1e3"),
    ("MPa", "Pa", "1e6"),
    ("GPa", "Pa", "1e9"),
    ("kJ", "J", "1e3"),
    ("kW", "W", "1e3"),
    ("mA", "A", "1e-3"),
    ("mH", "H", "1e-3"),
    ("uF", "F", "1e-6"),
];

/// Units that are coherent and begin what users write after a number.
const COHERENT: [&str; 18] =
    ["m", "s", "kg", "A", "K", "rad", "N", "J", "W", "V", "F", "H", "C", "Pa", "Hz", "Ohm", "Wb", "T"];

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

/// What to write for a unit that is not coherent.
pub fn coherent(unit: &str) -> Option<String> {
    let (_, coherent, factor) = OTHER_UNITS.iter().find(|(other, ..)| *other == unit)?;
    Some(format!("write `{coherent}`: 1 {unit} is {factor} {coherent}"))
}

/// What to write where a unit stands after a number.
pub fn without_unit(number: &str, unit: &str) -> Option<String> {
    if COHERENT.contains(&unit) {
        return Some(format!("write `{number}`: numbers are in SI units"));
    }
    let (_, coherent, factor) = OTHER_UNITS.iter().find(|(other, ..)| *other == unit)?;
    Some(format!("write `{number} * {factor}`: numbers are in SI units, here {coherent}"))
}
