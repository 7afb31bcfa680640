//! A linear model and frequency responses as text.
//!
//! In: a linear model. Out: the table of its modes for a terminal, JSON; of responses CSV.

use std::fmt::Write;

use super::response::Response;
use super::state_space::StateSpace;

impl StateSpace {
    /// The modes as a table, and what the linear model leaves out of the states.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!(
            "{} at t = {:?} s: {}, {}, {}\n",
            self.model,
            self.t,
            counted(self.states.len(), "state"),
            counted(self.inputs.len(), "input"),
            counted(self.outputs.len(), "output")
        );
        if !self.modes.is_empty() {
            text.push_str("mode      real 1/s  imaginary rad/s  frequency Hz   damping  shape\n");
        }
        // Real parts below this are rounding.
        let rounding = 1e-14 * self.modes.last().map_or(0.0, |mode| mode.natural);
        for (index, mode) in self.modes.iter().enumerate() {
            let is_undamped = mode.real.abs() <= rounding;
            let damping = mode.damping.map(|damping| if is_undamped { 0.0 } else { damping });
            let damping = damping.map_or_else(|| "-".to_owned(), |damping| format!("{damping:.5}"));
            let (real, imaginary, frequency) =
                (short(if is_undamped { 0.0 } else { mode.real }), short(mode.imaginary), short(mode.frequency));
            let _ = writeln!(
                text,
                "{:>4}  {real:>12}  {imaginary:>15}  {frequency:>12}  {damping:>8}  {}",
                index + 1,
                mode.words
            );
        }
        let left_out = &self.left_out;
        for (name, entries, rotations) in &left_out.orientations {
            let _ = writeln!(text, "{name}: {} for its {entries} entries", counted(*rotations, "rotation"));
        }
        for (names, why) in [
            (&left_out.dependent, "follows from the others"),
            (&left_out.still, "cannot change here"),
            (&left_out.held, "held as it is"),
            (&left_out.integrals, "left out: an integral that only outputs ask for"),
        ] {
            names.iter().for_each(|name| {
                let _ = writeln!(text, "{name}: {why}");
            });
        }
        text
    }

    /// All of it as JSON: names, matrices as lists of rows, modes, operating point. What is not a number is `null`.
    #[must_use]
    pub fn json(&self) -> String {
        as_json(self)
    }
}

/// Responses as CSV: `angular_frequency`, `frequency`, then magnitude and phase of each response; units in parentheses.
#[must_use]
pub fn responses_csv(responses: &[Response]) -> String {
    let mut text = "angular_frequency (rad/s),frequency (Hz)".to_owned();
    for Response { input, output, .. } in responses {
        let _ = write!(
            text,
            ",{0}/{1} ({2}/({3})),phase of {0}/{1} (rad)",
            output.name, input.name, output.unit, input.unit
        );
    }
    text.push('\n');
    for (row, frequency) in responses.first().map_or(&[][..], |response| &response.frequency).iter().enumerate() {
        let _ = write!(text, "{frequency:?},{:?}", frequency / std::f64::consts::TAU);
        for response in responses {
            let _ = write!(text, ",{:?},{:?}", response.magnitude[row], response.phase[row]);
        }
        text.push('\n');
    }
    text
}

/// Responses as JSON.
#[must_use]
pub fn responses_json(responses: &[Response]) -> String {
    as_json(&responses)
}

fn as_json<T: serde::Serialize>(value: &T) -> String {
    // Names are texts and numbers are numbers: nothing that JSON cannot write.
    serde_json::to_string_pretty(value).map_or_else(|error| format!("{{\"error\": \"{error}\"}}\n"), |text| text + "\n")
}

/// `1 step`, `2 steps`.
pub(super) fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A number to five digits.
pub(super) fn short(value: f64) -> String {
    let rounded = format!("{value:.4e}").parse::<f64>().unwrap_or(value);
    let is_plain = rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs());
    if is_plain { format!("{rounded}") } else { format!("{rounded:e}") }
}
