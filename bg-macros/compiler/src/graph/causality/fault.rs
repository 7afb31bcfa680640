//! What can go wrong with causal strokes.

use crate::fault::Explain;

/// A fault of causality.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum CausalFault {
    Conflict { junction: String, variable: Role, first: (String, String), second: (String, String) },
    Underdetermined { junction: String, variable: Role },
    Derivative { kind: ElementKind, name: String, by: String, by_inertia: bool },
    OneWay { symbol: &'static str, name: String, needs: &'static str, by: String },
}

use crate::graph::{ElementKind, Role};
use CausalFault as F;

impl Explain for CausalFault {
    fn code(&self) -> &'static str {
        match self {
            F::Conflict { .. } => "BG0401",
            F::Underdetermined { .. } => "BG0402",
            F::Derivative { .. } => "BG0403",
            F::OneWay { .. } => "BG0404",
        }
    }

    fn message(&self) -> String {
        match self {
            F::Conflict { junction, variable, first, second } => format!(
                "causal conflict: two bonds determine the {variable} of `{junction}`: {} (forced by {}) and {} (forced \
                 by {})",
                first.0, first.1, second.0, second.1
            ),
            F::Underdetermined { junction, variable } => {
                format!("causal conflict: no bond is left to determine the {variable} of `{junction}`")
            }
            F::Derivative { kind, name, by, .. } => {
                let symbol = kind.symbol();
                format!("{symbol} `{name}` would be in derivative causality: its state is already determined by {by}")
            }
            F::OneWay { symbol, name, needs, by } => {
                format!(
                    "the law of {symbol} `{name}` needs its {needs}, but that is what it would have to give: {by} \
                    determines the other variable"
                )
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::Conflict { variable: Role::Effort, .. } => {
                "put a 1-junction with an R between one of the two and the junction".to_owned()
            }
            F::Conflict { .. } => {
                "put a 0-junction with an R or a C between one of the two and the junction".to_owned()
            }
            F::Underdetermined { junction, variable: Role::Effort } => format!("bond a C or an R to `{junction}`"),
            F::Underdetermined { junction, .. } => format!("bond an I or an R to `{junction}`"),
            F::Derivative { kind: ElementKind::I, name, by_inertia, .. } => {
                let compliant = format!(
                    "let a C and an R (a compliant coupling) sit between them, `1 -> 0 -> C` in front of `{name}`"
                );
                if *by_inertia {
                    format!(
                        "{compliant}, or hold them together exactly with a residual sink, `rSe rigid = 0` at the \
                         0-junction of `.. -> 0 -> 1 -> {name}`, or merge the two inertias into one I"
                    )
                } else {
                    compliant
                }
            }
            F::Derivative { name, .. } => format!("let an R sit in series with `{name}`, or merge the two C into one"),
            F::OneWay { symbol: "TF" | "MTF", .. } => {
                "hold the two flows together by an `rSe`; between two joints a gear is `JointGearPair` of the library"
                    .to_owned()
            }
            F::OneWay { name, .. } => format!("write the law of `{name}` as an expression of the other variable"),
        }
    }
}
