//! Pictures of signals, which are outputs or made of them: over time, against each other, as spectra over frequency or
//! over the orders of a shaft.
//!
//! In: which signals and over what, as options or as a text; runs and measurements. Out: a plot with a series for each
//! signal of each run.

use bg_analysis::criterion::{Criteria, Signal};
use bg_analysis::spectrum::{over_frequency, over_order};
use bg_model::description::Description;
use bg_model::simulation::Recording;

use super::figures::plot::{Mark, Plot, Series, with_unit};

/// What signals are drawn over.
#[derive(Clone, Debug)]
pub enum Over {
    /// The time, s.
    Time,
    /// Another signal.
    Signal(Signal),
    /// The frequency, Hz: amplitudes.
    Frequency,
    /// The orders of a shaft with this angle: amplitudes.
    Order(Signal),
}

/// What is drawn of each run.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The model.
    pub model: &'static Description,
    /// The signals, one at least.
    pub shown: Vec<Signal>,
    /// What they are drawn over.
    pub over: Over,
    /// From this time on, s.
    pub from: f64,
    /// Spectra up to this frequency or order only; else a quarter above the last amplitude that is a thousandth of the
    /// largest.
    pub up_to: Option<f64>,
    /// Whether the vertical axis is logarithmic.
    pub is_logarithmic: bool,
}

/// Where a spectrum may end: a quarter above the last amplitude that is a thousandth of the largest one.
fn end_of(spectrum: &[(f64, f64)]) -> f64 {
    let largest = spectrum.iter().fold(0.0_f64, |largest, (_, amplitude)| largest.max(*amplitude));
    let last = spectrum.iter().rposition(|(_, amplitude)| *amplitude >= 1e-3 * largest).unwrap_or(0);
    spectrum.get((last + last / 4).max(20)).map_or(f64::INFINITY, |(place, _)| *place)
}

impl Drawing {
    /// What a text asks for: `y over x`, `spectrum of x`, `orders of x over angle`, or a signal, over time; with `,
    /// 2..` at its end from 2 s on.
    ///
    /// # Errors
    /// A sentence.
    pub fn read(model: &'static Description, text: &str) -> Result<Self, String> {
        let (what, from) = match text.rsplit_once(',').map(|(what, from)| (what, from.trim().strip_suffix(".."))) {
            Some((what, Some(from))) => {
                let from: f64 = from.trim().parse().map_err(|_| format!("`{from}` is no time in s"))?;
                (what.trim(), from)
            }
            _ => (text.trim(), 0.0),
        };
        let mut criteria = Criteria::new(model);
        let mut signal = |text: &str| criteria.signal(text.trim()).map_err(|fault| fault.to_string());
        let (shown, over) = if let Some(of) = what.strip_prefix("spectrum of ") {
            (signal(of)?, Over::Frequency)
        } else if let Some(of) = what.strip_prefix("orders of ") {
            let (of, angle) = of
                .split_once(" over ")
                .ok_or("orders are those of a shaft: give its angle, as in `orders of x over crank.angle`")?;
            (signal(of)?, Over::Order(signal(angle)?))
        } else if let Some((of, over)) = what.split_once(" over ") {
            (signal(of)?, Over::Signal(signal(over)?))
        } else {
            (signal(what)?, Over::Time)
        };
        // The lines of a spectrum are of all sizes.
        let is_logarithmic = matches!(over, Over::Frequency | Over::Order(_));
        Ok(Self { model, shown: vec![shown], over, from, up_to: None, is_logarithmic })
    }

    fn signals(&self) -> impl Iterator<Item = &Signal> {
        let over = match &self.over {
            Over::Signal(signal) | Over::Order(signal) => Some(signal),
            Over::Time | Over::Frequency => None,
        };
        self.shown.iter().chain(over)
    }

    /// Whether a run has the columns that are needed.
    ///
    /// # Errors
    /// The name of one that it has not.
    pub fn check(&self, run: &Recording) -> Result<(), &'static str> {
        let mut needed = self.signals().flat_map(Signal::outputs).map(|place| self.model.outputs[place].name);
        needed.find(|name| !run.columns.iter().any(|column| column.name == *name)).map_or(Ok(()), Err)
    }

    /// The plot of runs with their names, the first of which needs none; of models with these values of their
    /// parameters.
    #[must_use]
    pub fn plot(&self, scene: &str, runs: &[(&str, &Recording)], parameters: &[f64]) -> Plot {
        let is_alone = runs.len() == 1;
        let series = runs.iter().flat_map(|(name, run)| self.series(name, run, parameters, is_alone)).collect();
        let names: Vec<&str> = self.shown.iter().map(|signal| signal.text.as_str()).collect();
        let unit = self.shown[0].unit();
        let is_one_unit = self.shown.iter().all(|signal| signal.unit() == unit);
        let what = with_unit(&names.join(", "), if is_one_unit { unit } else { "" });
        let (across, what) = match &self.over {
            Over::Order(angle) => (format!("order of {}", angle.text), format!("amplitude of {what}")),
            Over::Signal(over) => (with_unit(&over.text, over.unit()), what),
            Over::Frequency => ("frequency in Hz".to_owned(), format!("amplitude of {what}")),
            Over::Time => ("t in s".to_owned(), what),
        };
        let is_path =
            matches!(&self.over, Over::Signal(over) if is_one_unit && over.unit() == unit && !unit.is_empty());
        let shown = names.join(", ");
        let heading = match &self.over {
            Over::Order(angle) => format!("{scene}: orders of {shown} over {}", angle.text),
            Over::Signal(over) => format!("{scene}: {shown} over {}", over.text),
            Over::Frequency => format!("{scene}: spectrum of {shown}"),
            Over::Time => format!("{scene}: {shown}"),
        };
        let mut plot = Plot::new(&heading, &across, &what, series);
        (plot.is_true_to_scale, plot.is_logarithmic) = (is_path, self.is_logarithmic);
        plot
    }

    /// What is drawn of a run, which is called `name` where there are several.
    fn series(&self, name: &str, run: &Recording, parameters: &[f64], is_alone: bool) -> Vec<Series> {
        let from = run.times.partition_point(|t| *t < self.from);
        let times = &run.times[from..];
        let column = |place: usize| {
            let wanted = self.model.outputs[place].name;
            let found = run.columns.iter().find(|column| column.name == wanted);
            found.map_or(&[][..], |column| &column.values[from..])
        };
        let values = |signal: &Signal| signal.values(self.model, parameters, times, column);
        let below = |mut points: Vec<(f64, f64)>| {
            let end = self.up_to.unwrap_or_else(|| end_of(&points));
            points.retain(|(place, _)| *place <= end);
            points
        };
        let along = |own: Vec<f64>, over: &[f64]| over.iter().copied().zip(own).collect::<Vec<(f64, f64)>>();
        let points = |signal: &Signal| {
            let own = values(signal);
            match &self.over {
                Over::Order(angle) => below(over_order(&values(angle), &own)),
                Over::Frequency => below(over_frequency(times, &own)),
                Over::Signal(over) => along(own, &values(over)),
                Over::Time => along(own, times),
            }
        };
        let several = self.shown.len() > 1;
        let called = |signal: &Signal| match (several, name) {
            (_, "") if several || !is_alone => signal.text.clone(),
            (_, "") => String::new(),
            (true, name) => format!("{}, {name}", signal.text),
            (false, name) => name.to_owned(),
        };
        let one = |signal: &Signal| Series { name: called(signal), points: points(signal), mark: Mark::Line };
        self.shown.iter().map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spectrum_ends_above_its_last_line() {
        let line = |place: usize| (place as f64, if matches!(place, 3 | 80) { 1.0 } else { 1e-5 });
        let spectrum: Vec<(f64, f64)> = (0..1000).map(line).collect();
        assert_eq!(end_of(&spectrum), 100.0);
        assert_eq!(end_of(&spectrum[..10]), f64::INFINITY);
        assert_eq!(end_of(&[]), f64::INFINITY);
    }
}
