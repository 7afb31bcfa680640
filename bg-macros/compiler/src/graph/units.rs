//! Physical dimensions: what a unit symbol stands for, how dimensions multiply, and the energy domains.
//!
//! In: `ast::Unit`. Out: [`Dimension`]. Only coherent SI units exist here, so no unit carries a factor.
//! Source: the SI Brochure, 9th edition, tables 2 and 4.

use crate::fault::{Explain, Fault, near_miss};
use crate::source::ast;
use crate::source::numbers::coherent;

/// Number of SI base quantities: kg, m, s, A, K, mol, cd.
const BASES: usize = 7;

/// The symbols of the SI base units, in the order of the exponents.
const BASE_SYMBOLS: [&str; BASES] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// A product of powers of SI base units. Exponents are counted in halves, so that square roots exist.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Dimension([i16; BASES]);

/// Symbol and base exponents (whole) of the derived units.
const DERIVED: [(&str, [i16; BASES]); 17] = [
    ("rad", [0, 0, 0, 0, 0, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0, 0, 0]),
    ("N", [1, 1, -2, 0, 0, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0, 0, 0]),
    ("J", [1, 2, -2, 0, 0, 0, 0]),
    ("W", [1, 2, -3, 0, 0, 0, 0]),
    ("C", [0, 0, 1, 1, 0, 0, 0]),
    ("V", [1, 2, -3, -1, 0, 0, 0]),
    ("F", [-1, -2, 4, 2, 0, 0, 0]),
    ("Ohm", [1, 2, -3, -2, 0, 0, 0]),
    ("S", [-1, -2, 3, 2, 0, 0, 0]),
    ("Wb", [1, 2, -2, -1, 0, 0, 0]),
    ("T", [1, 0, -2, -1, 0, 0, 0]),
    ("H", [1, 2, -2, -2, 0, 0, 0]),
    ("sr", [0, 0, 0, 0, 0, 0, 0]),
    ("lm", [0, 0, 0, 0, 0, 0, 1]),
    ("kat", [0, 0, -1, 0, 0, 1, 0]),
];

/// Texts that are clearer than base units for the dimensions that mechanisms meet, the first match is used.
const PREFERRED: [&str; 23] = [
    "m", "kg", "s", "m/s", "m/s^2", "N", "Pa", "W", "V", "A", "C", "Ohm", "F", "H", "Wb", "N*m", "kg*m/s", "N/m",
    "N*s/m", "kg*m^2/s", "1/s", "m^3/s", "kg*m^2",
];

impl Dimension {
    /// The dimension of a pure number.
    pub const NONE: Self = Self([0; BASES]);
    /// Time.
    pub const SECOND: Self = Self([0, 0, 2, 0, 0, 0, 0]);
    /// Length.
    pub const METRE: Self = Self([0, 2, 0, 0, 0, 0, 0]);
    /// Power.
    pub const WATT: Self = Self([2, 4, -6, 0, 0, 0, 0]);
    /// Energy.
    pub const JOULE: Self = Self([2, 4, -4, 0, 0, 0, 0]);

    /// The dimension of a unit symbol.
    #[must_use]
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        if let Some(base) = BASE_SYMBOLS.iter().position(|&known| known == symbol) {
            let mut exponents = [0; BASES];
            exponents[base] = 2;
            return Some(Self(exponents));
        }
        let (_, whole) = DERIVED.iter().find(|(known, _)| *known == symbol)?;
        Some(Self(whole.map(|exponent| 2 * exponent)))
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
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if *self == Self::NONE {
            return f.write_str("1");
        }
        if let Some(text) = PREFERRED.iter().find(|text| of_text(text) == *self) {
            return f.write_str(text);
        }
        let factors = |positive: bool| {
            let mut text = Vec::new();
            for (symbol, &halves) in BASE_SYMBOLS.iter().zip(&self.0) {
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

/// The dimension of one of this module's own texts.
fn of_text(text: &str) -> Dimension {
    let mut result = Dimension::NONE;
    for (index, part) in text.split('/').enumerate() {
        for factor in part.split('*') {
            let (symbol, exponent) = factor.split_once('^').unwrap_or((factor, "1"));
            let Some(dimension) = Dimension::of_symbol(symbol) else { continue };
            let power = dimension.power(exponent.parse().unwrap_or(1));
            result = if index == 0 { result.times(power) } else { result.per(power) };
        }
    }
    result
}

/// What can be wrong with a unit.
#[derive(Clone, Debug)]
pub enum UnitFault {
    /// The symbol is none of the coherent SI units.
    Unknown {
        /// The symbol.
        symbol: String,
    },
}

impl Explain for UnitFault {
    fn code(&self) -> &'static str {
        "BG0301"
    }
    fn message(&self) -> String {
        let Self::Unknown { symbol } = self;
        format!("`{symbol}` is not a coherent SI unit")
    }
    fn help(&self) -> String {
        let Self::Unknown { symbol } = self;
        if let Some(help) = coherent(symbol) {
            return help;
        }
        let symbols = || BASE_SYMBOLS.into_iter().chain(DERIVED.iter().map(|(symbol, _)| *symbol));
        match near_miss(symbol, symbols()) {
            Some(near) => format!("write `{near}`"),
            None => format!("use {}", symbols().collect::<Vec<_>>().join(" ")),
        }
    }
}

/// The dimension of a unit as written.
///
/// # Errors
/// A symbol that is no coherent SI unit.
pub fn dimension(unit: &ast::Unit) -> Result<Dimension, Fault> {
    unit.factors.iter().try_fold(Dimension::NONE, |product, (symbol, exponent)| {
        Dimension::of_symbol(&symbol.text)
            .map(|dimension| product.times(dimension.power(*exponent)))
            .ok_or_else(|| Fault::new(symbol.span, &UnitFault::Unknown { symbol: symbol.text.clone() }))
    })
}

/// An energy domain: the names of its variables' units.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Domain {
    /// Its word in the language.
    pub name: &'static str,
    /// Unit of the effort.
    pub effort: &'static str,
    /// Unit of the flow.
    pub flow: &'static str,
    /// Unit of the displacement.
    pub displacement: &'static str,
    /// Unit of the momentum.
    pub momentum: &'static str,
}

/// The domains that a junction can name.
pub const DOMAINS: [Domain; 5] = [
    Domain { name: "translation", effort: "N", flow: "m/s", displacement: "m", momentum: "kg*m/s" },
    Domain { name: "rotation", effort: "N*m", flow: "rad/s", displacement: "rad", momentum: "kg*m^2/s" },
    Domain { name: "electrical", effort: "V", flow: "A", displacement: "C", momentum: "Wb" },
    Domain { name: "hydraulic", effort: "Pa", flow: "m^3/s", displacement: "m^3", momentum: "Pa*s" },
    Domain { name: "thermal", effort: "K", flow: "W/K", displacement: "J/K", momentum: "K*s" },
];

impl Domain {
    /// The domain of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        DOMAINS.into_iter().find(|domain| domain.name == name)
    }

    /// The domain whose effort has this dimension.
    #[must_use]
    pub fn of_effort(effort: Dimension) -> Option<Self> {
        DOMAINS.into_iter().find(|domain| domain.effort_dimension() == effort)
    }

    /// The effort's dimension.
    #[must_use]
    pub fn effort_dimension(&self) -> Dimension {
        of_text(self.effort)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effort_times_flow_is_power_in_every_domain() {
        for domain in DOMAINS {
            assert_eq!(of_text(domain.effort).times(of_text(domain.flow)), Dimension::WATT, "{}", domain.name);
            assert_eq!(of_text(domain.flow).times(Dimension::SECOND), of_text(domain.displacement), "{}", domain.name);
            assert_eq!(of_text(domain.effort).times(Dimension::SECOND), of_text(domain.momentum), "{}", domain.name);
        }
    }

    #[test]
    fn a_dimension_reads_as_the_unit_it_is() {
        assert_eq!(of_text("kg*m/s^2").to_string(), "N");
        assert_eq!(of_text("kg*m^5/A").to_string(), "kg*m^5/A");
        assert_eq!(of_text("V/A").to_string(), "Ohm");
        assert_eq!(of_text("N*m/rad").to_string(), "N*m");
        assert_eq!(of_text("m^2").root().map(|d| d.to_string()), Some("m".to_owned()));
        assert_eq!(of_text("m^255").times(of_text("m^-255/s")).to_string(), "1/s");
        assert_eq!(of_text("1/s").power(1 << 20).to_string(), "1/s^16384");
        assert_eq!(of_text("m").root().map(|d| d.to_string()), Some("m^(1/2)".to_owned()));
    }
}
