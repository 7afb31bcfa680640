//! Physical dimensions: products of powers of the base quantities.

use crate::Unit;
use crate::symbols::BASES;

/// A product of powers of SI base units. Exponents are counted in halves, so that square roots exist.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Dimension([i16; Self::BASES]);

/// Texts that are clearer than base units for the dimensions that mechanisms meet, the first match is used.
const PREFERRED: [&str; 23] = [
    "m", "kg", "s", "m/s", "m/s^2", "N", "Pa", "W", "V", "A", "C", "Ohm", "F", "H", "Wb", "N*m", "kg*m/s", "N/m",
    "N*s/m", "kg*m^2/s", "1/s", "m^3/s", "kg*m^2",
];

impl Dimension {
    /// Number of SI base quantities: kg, m, s, A, K, mol, cd.
    pub const BASES: usize = 7;
    /// The dimension of a pure number.
    pub const NONE: Self = Self([0; Self::BASES]);
    /// Time.
    pub const SECOND: Self = Self([0, 0, 2, 0, 0, 0, 0]);
    /// Length.
    pub const METRE: Self = Self([0, 2, 0, 0, 0, 0, 0]);
    /// Power.
    pub const WATT: Self = Self([2, 4, -6, 0, 0, 0, 0]);
    /// Energy.
    pub const JOULE: Self = Self([2, 4, -4, 0, 0, 0, 0]);

    /// The dimension of whole powers of kg, m, s, A, K, mol, cd.
    #[must_use]
    pub fn of_bases(exponents: [i16; Self::BASES]) -> Self {
        Self(exponents.map(|exponent| exponent.saturating_mul(2)))
    }

    /// The powers of kg, m, s, A, K, mol, cd, where all are whole.
    #[must_use]
    pub fn bases(self) -> Option<[i16; Self::BASES]> {
        self.0.iter().all(|halves| halves % 2 == 0).then(|| self.0.map(|halves| halves / 2))
    }

    /// The product of two dimensions.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_add(other.0[i])))
    }

    /// The quotient of two dimensions.
    #[must_use]
    pub fn per(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_sub(other.0[i])))
    }

    /// A whole power.
    #[must_use]
    pub fn power(self, exponent: i32) -> Self {
        let limited = |e: i16| i32::from(e).saturating_mul(exponent).clamp(i16::MIN.into(), i16::MAX.into());
        Self(self.0.map(|e| i16::try_from(limited(e)).unwrap_or(0)))
    }

    /// The square root, where its exponents are whole or half.
    #[must_use]
    pub fn root(self) -> Option<Self> {
        self.0.iter().all(|e| e % 2 == 0).then(|| Self(self.0.map(|e| e / 2)))
    }
}

impl std::fmt::Display for Dimension {
    /// The coherent SI unit of the dimension.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if *self == Self::NONE {
            return f.write_str("1");
        }
        let is_this = |text: &&&str| text.parse::<Unit>().is_ok_and(|unit| unit.dimension == *self);
        if let Some(text) = PREFERRED.iter().find(is_this) {
            return f.write_str(text);
        }
        let factors = |positive: bool| {
            let mut text = Vec::new();
            for (symbol, &halves) in BASES.iter().zip(&self.0) {
                if (halves > 0) == positive && halves != 0 {
                    text.push(match halves.unsigned_abs() {
                        2 => (*symbol).to_owned(),
                        even if even % 2 == 0 => format!("{symbol}^{}", even / 2),
                        odd => format!("{symbol}^({odd}/2)"),
                    });
                }
            }
            text
        };
        let (above, below) = (factors(true), factors(false));
        f.write_str(&if above.is_empty() { "1".to_owned() } else { above.join("*") })?;
        below.iter().try_for_each(|factor| write!(f, "/{factor}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_text(text: &str) -> Dimension {
        text.parse::<Unit>().expect("a unit").dimension
    }

    #[test]
    fn a_dimension_reads_as_the_unit_it_is() {
        assert_eq!(of_text("kg*m/s^2").to_string(), "N");
        assert_eq!(of_text("kg*m^5/A").to_string(), "kg*m^5/A");
        assert_eq!(of_text("V/A").to_string(), "Ohm");
        assert_eq!(of_text("N*m/rad").to_string(), "N*m");
        assert_eq!(of_text("m^2").root().map(|d| d.to_string()), Some("m".to_owned()));
        assert_eq!(of_text("m^120").times(of_text("m^-120/s")).to_string(), "1/s");
        assert_eq!(of_text("1/s").power(1 << 20).to_string(), "1/s^16384");
        assert_eq!(of_text("m").root().map(|d| d.to_string()), Some("m^(1/2)".to_owned()));
        assert_eq!(
            (of_text("N").bases(), of_text("m").root().and_then(Dimension::bases)),
            (Some([1, 1, -2, 0, 0, 0, 0]), None)
        );
    }
}
