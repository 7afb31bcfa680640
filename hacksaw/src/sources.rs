//! Where the parameters' values are from: the paper, or an assumption where it leaves the value out.

/// The parameters whose values stand in the paper.
const PAPER: [&str; 20] = [
    "torque", "k_2", "r_2", "k_2r", "r_2r", "k_23", "r_23", "k_23r", "r_23r", "k_34", "r_34", "k_34r", "r_34r", "k_15",
    "r_15", "k_45r", "r_45r", "k_work", "r_work", "r_cut",
];

/// `paper` or `assumed`.
#[must_use]
pub fn source(parameter: &str) -> &'static str {
    if PAPER.contains(&parameter) { "paper" } else { "assumed" }
}
