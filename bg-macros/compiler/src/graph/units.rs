//! Units as they are written, and the energy domains.
//!
//! In: `ast::Unit`. Out: [`Unit`].

use bg_units::{Unit, symbols};

use crate::fault::{Explain, Fault, near_miss};
use crate::source::ast;

pub use bg_units::Dimension;

/// What can be wrong with a unit.
#[derive(Clone, Debug)]
pub enum UnitFault {
    /// The symbol stands for no unit.
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
        format!("`{symbol}` is not a unit")
    }
    fn help(&self) -> String {
        let Self::Unknown { symbol } = self;
        match near_miss(symbol, symbols()) {
            Some(near) => format!("write `{near}`"),
            None => format!("use {}, SI units with prefixes such as mm or kN", symbols().collect::<Vec<_>>().join(" ")),
        }
    }
}

/// The unit as written.
///
/// # Errors
/// A symbol that stands for none.
pub fn unit(unit: &ast::Unit) -> Result<Unit, Fault> {
    let unknown = |(symbol, _): &&(ast::Name, i32)| Unit::of_symbol(&symbol.text).is_none();
    unit.meaning().ok_or_else(|| {
        let name = unit.factors.iter().find(unknown).map(|(symbol, _)| symbol);
        let (span, symbol) = name.map_or((unit.span, String::new()), |name| (name.span, name.text.clone()));
        Fault::new(span, &UnitFault::Unknown { symbol })
    })
}

/// The dimension of one of this module's own texts.
fn of_text(text: &str) -> Dimension {
    text.parse::<Unit>().map_or(Dimension::NONE, |unit| unit.dimension)
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
}
