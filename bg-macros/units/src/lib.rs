//! Units of measurement: what a symbol stands for, how units multiply, what a number in one is in coherent SI.
//!
//! In: the text of a unit, `kN/mm`. Out: a [`Unit`], which is a [`Dimension`] and a size in coherent SI.
//! Sources: the SI Brochure, 9th edition, tables 2, 4, 7 and 8; for inch, foot, pound and horsepower NIST Special
//! Publication 811 (2008), appendix B.

#![doc = include_str!("../README.md")]

mod dimension;
mod symbols;

pub use dimension::Dimension;
pub use symbols::symbols;

use std::str::FromStr;

/// A unit: what it measures, and its size in the coherent SI unit of that.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// The power of the radian in it, which has no dimension: FMI counts it among the bases.
    pub angle: i32,
    /// Its size is `numerator / denominator`: two numbers, so that 75 mm are 75 / 1000 m to the last digit.
    numerator: f64,
    /// See `numerator`.
    denominator: f64,
}

/// A symbol that stands for no unit.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UnknownSymbol(
    /// What stands there in place of one.
    pub String,
);

impl std::fmt::Display for UnknownSymbol {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}` is not a unit", self.0)
    }
}

impl std::error::Error for UnknownSymbol {}

impl Unit {
    /// The unit of a pure number.
    pub const ONE: Self = Self { dimension: Dimension::NONE, angle: 0, numerator: 1.0, denominator: 1.0 };

    /// The unit of a symbol, with its prefix if it has one: `mm`, `rpm`, `kg`.
    #[must_use]
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        symbols::find(symbol)
    }

    /// The coherent SI unit of a dimension.
    #[must_use]
    pub const fn coherent(dimension: Dimension) -> Self {
        Self { dimension, ..Self::ONE }
    }

    /// The product of two units.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self {
            dimension: self.dimension.times(other.dimension),
            angle: self.angle + other.angle,
            numerator: self.numerator * other.numerator,
            denominator: self.denominator * other.denominator,
        }
    }

    /// A whole power.
    #[must_use]
    pub fn power(self, exponent: i32) -> Self {
        let (numerator, denominator) =
            if exponent < 0 { (self.denominator, self.numerator) } else { (self.numerator, self.denominator) };
        let size = |base: f64| base.powi(exponent.saturating_abs());
        Self {
            dimension: self.dimension.power(exponent),
            angle: self.angle.saturating_mul(exponent),
            numerator: size(numerator),
            denominator: size(denominator),
        }
    }

    /// Its size in the coherent SI unit of its dimension.
    #[must_use]
    pub fn size(self) -> f64 {
        self.in_si(1.0)
    }

    /// Whether it is the coherent SI unit of its dimension.
    #[must_use]
    pub fn is_coherent(self) -> bool {
        self.numerator == self.denominator
    }

    /// What a number in this unit is in coherent SI.
    #[must_use]
    pub fn in_si(self, number: f64) -> f64 {
        if self.is_coherent() { number } else { number * self.numerator / self.denominator }
    }

    /// What a number in coherent SI is in this unit.
    #[must_use]
    pub fn from_si(self, number: f64) -> f64 {
        if self.is_coherent() { number } else { number * self.denominator / self.numerator }
    }

    /// What a number in this unit is in another one of the same dimension.
    #[must_use]
    pub fn convert(self, number: f64, to: Self) -> f64 {
        self.times(to.power(-1)).in_si(number)
    }
}

impl FromStr for Unit {
    type Err = UnknownSymbol;

    /// Factors with whole powers, joined by `*` and `/`; each `/` is for the one factor after it. `1`, or nothing, is a
    /// pure number.
    fn from_str(text: &str) -> Result<Self, UnknownSymbol> {
        let mut product = Self::ONE;
        if text.trim().is_empty() {
            return Ok(product);
        }
        for (index, part) in text.split('/').enumerate() {
            for (place, factor) in part.split('*').enumerate() {
                let sign = if index > 0 && place == 0 { -1 } else { 1 };
                let (symbol, exponent) = factor.trim().split_once('^').unwrap_or((factor.trim(), "1"));
                let unknown = || UnknownSymbol(factor.trim().to_owned());
                let exponent: i8 = exponent.trim().parse().map_err(|_| unknown())?;
                let unit = if symbol.trim() == "1" { Some(Self::ONE) } else { Self::of_symbol(symbol.trim()) };
                product = product.times(unit.ok_or_else(unknown)?.power(sign * i32::from(exponent)));
            }
        }
        Ok(product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Unit {
        text.parse().expect("a unit")
    }

    /// Two units of one dimension, and how many of the second the first is.
    fn ratio(of: &str, to: &str) -> f64 {
        let (of, to) = (unit(of), unit(to));
        assert_eq!(of.dimension, to.dimension);
        of.convert(1.0, to)
    }

    #[test]
    fn sizes_are_those_of_the_tables() {
        assert_eq!(unit("mm").in_si(75.0), 0.075);
        assert_eq!(unit("um").in_si(3.0), 3e-6);
        assert_eq!(unit("kN/mm").in_si(3.0), 3e6);
        assert_eq!(ratio("bar", "Pa"), 1e5);
        assert_eq!(ratio("h", "s"), 3600.0);
        assert_eq!(ratio("km/h", "m/s"), 1.0 / 3.6);
        assert_eq!(ratio("l", "m^3"), 1e-3);
        assert_eq!(ratio("l/min", "m^3/s"), 1.0 / 60_000.0);
        assert_eq!(ratio("inch", "mm"), 25.4);
        assert_eq!(ratio("kWh", "J"), 3.6e6);
        assert_eq!(ratio("g/cm^3", "kg/m^3"), 1e3);
        assert_eq!(ratio("mm^2", "m^2"), 1e-6);
        assert!((ratio("rpm", "rad/s") - 0.104_719_755_119_659_77).abs() < 1e-17);
        assert!((ratio("deg", "rad") - 0.017_453_292_519_943_295).abs() < 1e-18);
        // Source: NIST SP 811, appendix B.9.
        assert!((ratio("lbf*inch", "N*m") - 0.112_984_829).abs() < 1e-9);
        assert!((ratio("psi", "Pa") - 6894.757).abs() < 1e-3);
        assert!((ratio("hp", "W") - 745.699_872).abs() < 1e-6);
    }

    #[test]
    fn a_symbol_is_itself_before_it_is_a_prefix_and_another() {
        assert_eq!(ratio("min", "s"), 60.0);
        assert_eq!(unit("cd").dimension, Dimension::of_bases([0, 0, 0, 0, 0, 0, 1]));
        assert_eq!(unit("Pa").dimension, unit("N/m^2").dimension);
        assert_eq!(unit("T").dimension, unit("Wb/m^2").dimension);
        assert_eq!(ratio("kg", "g"), 1e3);
        assert_eq!(ratio("mg", "kg"), 1e-6);
    }

    #[test]
    fn each_slash_is_for_one_factor() {
        assert_eq!(unit("N*m*s/rad"), unit("N*m*s*rad^-1"));
        assert_eq!(unit("m/s*kg").dimension, unit("kg*m/s").dimension);
        assert_eq!(unit("W/m^2/K").dimension, unit("kg/s^3/K").dimension);
        assert_eq!((unit("rad/s").angle, unit("rpm").angle, unit("N*m/rad").angle), (1, 1, -1));
    }

    #[test]
    fn what_is_no_unit_is_named() {
        for text in ["elephant", "kkg", "m^2.5", "m^", "N m", "m^300", "kmin", "mdeg"] {
            assert!(text.parse::<Unit>().is_err(), "{text}");
        }
        assert_eq!("N/xx".parse::<Unit>().map_err(|error| error.to_string()), Err("`xx` is not a unit".to_owned()));
    }
}
