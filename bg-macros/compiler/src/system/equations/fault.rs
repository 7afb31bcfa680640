//! What can go wrong when bonds become equations.

use crate::fault::Explain;

/// A fault of the derivation.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum EquationFault {
    AlgebraicLoop { members: Vec<String> },
    NotLinear { symbol: &'static str, name: String },
    NoEnergy { symbol: &'static str, name: String },
    EnergyOfOtherLaw { symbol: &'static str, name: String },
    DisplacementOfOtherFlow { name: String },
}

use EquationFault as F;

impl Explain for EquationFault {
    fn code(&self) -> &'static str {
        match self {
            F::AlgebraicLoop { .. } => "BG0501",
            F::NotLinear { .. } => "BG0502",
            F::NoEnergy { .. } => "BG0503",
            F::EnergyOfOtherLaw { .. } => "BG0504",
            F::DisplacementOfOtherFlow { .. } => "BG0505",
        }
    }

    fn message(&self) -> String {
        match self {
            F::AlgebraicLoop { members } => {
                format!("algebraic loop: each of these needs the next: {}", members.join(" -> "))
            }
            F::NotLinear { symbol, name } => {
                format!("the law of {symbol} `{name}` is not linear in its variable, so it would not conserve power")
            }
            F::NoEnergy { symbol, name } => {
                format!(
                    "the energy stored in {symbol} `{name}` is not known: its law has no integral that the compiler can find"
                )
            }
            F::EnergyOfOtherLaw { symbol, name } => {
                format!("the energy given for {symbol} `{name}` does not have the law as its derivative")
            }
            F::DisplacementOfOtherFlow { name } => {
                format!("the displacement given for C `{name}` does not change with the flow of its bond")
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::AlgebraicLoop { members } => format!(
                "break the loop with a storage: bond a C or an I to one of its junctions, for example at {}",
                members.first().map_or("one of them", String::as_str)
            ),
            F::NotLinear { .. } => "write it as a factor times the variable, or as `dot`, `cross` of it".to_owned(),
            F::NoEnergy { .. } => "give it behind the law, `energy E`".to_owned(),
            F::EnergyOfOtherLaw { .. } => "correct the energy, or leave it out".to_owned(),
            F::DisplacementOfOtherFlow { .. } => {
                "leave `at` out, then the displacement is a state of its own".to_owned()
            }
        }
    }
}
