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

#[cfg(test)]
mod tests {
    use super::*;
    use bg_model::mechanism::Mechanism;
    use bg_model::parameters::Parameters;

    /// The table of `docs/hacksaw.md` says the same of every parameter.
    #[test]
    fn the_document_says_the_same() {
        let text = include_str!("../../docs/hacksaw.md");
        let rows = text.lines().filter(|line| line.ends_with("| P |") || line.ends_with("| A |"));
        let told: Vec<(&str, &str)> = rows
            .flat_map(|row| {
                let source = if row.ends_with("| P |") { "paper" } else { "assumed" };
                let names = row.split('|').nth(2).unwrap_or("").split(',').map(|name| name.trim().trim_matches('`'));
                names.filter(|name| !name.is_empty()).map(move |name| (name, source))
            })
            .collect();
        for info in <crate::mechanism::Hacksaw as Mechanism>::Parameters::table() {
            assert!(told.contains(&(info.name, source(info.name))), "{}: {}", info.name, source(info.name));
        }
    }
}
