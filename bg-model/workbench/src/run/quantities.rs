//! What is observed of a run: its quantities with their components, their units in print, the range of their values.

use std::ops::Range;

use bg_model::description::{Description, OutputInfo};

/// The observed quantities, each with its components.
pub(crate) fn quantities(description: &'static Description) -> impl Iterator<Item = &'static [OutputInfo]> {
    description.outputs.chunk_by(|a, b| a.of == b.of)
}

/// A unit as it is set in print: `kg*m^2/s` as kg·m²/s.
pub(crate) fn set_unit(unit: &str) -> String {
    let mut parts = unit.split('^');
    let mut set = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (power, rest) = part.split_at(part.find(|c: char| !c.is_ascii_digit()).unwrap_or(part.len()));
        set += &superscript(power);
        set += rest;
    }
    set.replace('*', "\u{B7}")
}

/// An exponent in raised digits.
pub(crate) fn superscript(exponent: &str) -> String {
    const RAISED: [char; 10] = [
        '\u{2070}', '\u{B9}', '\u{B2}', '\u{B3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}', '\u{2078}',
        '\u{2079}',
    ];
    exponent.chars().map(|c| c.to_digit(10).map_or('\u{207B}', |digit| RAISED[digit as usize])).collect()
}

/// The range of the finite values of `curve`.
pub fn extent(curve: impl IntoIterator<Item = f64>) -> Range<f64> {
    let range = curve
        .into_iter()
        .filter(|value| value.is_finite())
        .fold(f64::INFINITY..f64::NEG_INFINITY, |range, value| range.start.min(value)..range.end.max(value));
    if range.start <= range.end { range } else { 0.0..0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_set_as_in_print() {
        assert_eq!(set_unit("kg*m^2/s"), "kg\u{B7}m\u{B2}/s");
        assert_eq!(set_unit("W/m^2/K^4"), "W/m\u{B2}/K\u{2074}");
        assert_eq!(set_unit("N"), "N");
    }
}
