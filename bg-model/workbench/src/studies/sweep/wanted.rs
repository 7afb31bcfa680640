//! What is kept of each run: numbers made of its outputs, times of its events, whole trajectories.
//!
//! In: a run. Out: a number for each column. Largest and least are those of the solution, whatever the samples. Means
//! and integrals are those of straight lines between the samples (trapezoidal rule); where that is not exact enough,
//! the model can observe an `integral(..)`, or samples can be finer.

use bg_analysis::criterion::Criterion;
use bg_analysis::criterion::of_run::{Found, Look};
use bg_model::description::Description;
use bg_model::simulation::{Column, Recording};
use serde::{Deserialize, Serialize};

use crate::show::extras::peaks;

/// A number made of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Reduction {
    /// Its largest value.
    Max,
    /// Its least value.
    Min,
    /// Its mean over time.
    Mean,
    /// Its last sample.
    Final,
    /// Its integral over time.
    Integral,
}

impl Reduction {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Max, Self::Min, Self::Mean, Self::Final, Self::Integral];

    /// Its name in a plan.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Max => "max",
            Self::Min => "min",
            Self::Mean => "mean",
            Self::Final => "final",
            Self::Integral => "integral",
        }
    }

    fn of(self, run: &Recording, column: &Column) -> f64 {
        let (times, values) = (&run.times[..], &column.values[..]);
        match self {
            Self::Max => peaks(run, column).largest.value,
            Self::Min => peaks(run, column).least.value,
            Self::Final => values.last().copied().unwrap_or(f64::NAN),
            Self::Integral => integral(times, values),
            Self::Mean => match times {
                [first, .., last] => integral(times, values) / (last - first),
                _ => f64::NAN,
            },
        }
    }
}

fn integral(times: &[f64], values: &[f64]) -> f64 {
    let strip = |k: usize| (times[k + 1] - times[k]) * (values[k] + values[k + 1]) / 2.0;
    (1..times.len()).map(|k| strip(k - 1)).sum()
}

/// What is kept of each run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Outputs by their index, and what is made of them.
    pub reductions: Vec<(usize, Reduction)>,
    /// The times of so many events.
    pub event_times: usize,
    /// The outputs of which all samples are kept; of none there are no trajectories.
    pub trajectories: Vec<usize>,
}

impl Wanted {
    /// Whether something is summed over samples: a mean or an integral.
    #[must_use]
    pub fn has_sums(&self) -> bool {
        self.reductions.iter().any(|(_, by)| matches!(by, Reduction::Mean | Reduction::Integral))
    }

    /// Whether a run has to find the peaks of its outputs.
    #[must_use]
    pub fn has_peaks(&self) -> bool {
        self.reductions.iter().any(|(_, reduction)| matches!(reduction, Reduction::Max | Reduction::Min))
    }

    /// Names and units of the columns that a run fills.
    #[must_use]
    pub fn columns(&self, model: &Description) -> Vec<(String, String)> {
        let reduced = self.reductions.iter().map(|&(output, reduction)| {
            let (info, name) = (&model.outputs[output], reduction.name());
            let unit = match reduction {
                Reduction::Integral => format!("{}*s", info.unit),
                _ => info.unit.to_owned(),
            };
            (format!("{}_{name}", info.name), unit)
        });
        reduced.chain((1..=self.event_times).map(|event| (format!("event_{event}"), "s".to_owned()))).collect()
    }

    /// The numbers of a run that came to its end; an event that there was not is not a number.
    #[must_use]
    pub fn numbers(&self, run: &Recording) -> Vec<f64> {
        let reduced = self.reductions.iter().map(|&(output, by)| by.of(run, &run.columns[output]));
        let events = (0..self.event_times).map(|event| run.events.get(event).copied().unwrap_or(f64::NAN));
        reduced.chain(events).collect()
    }
}

/// Numbers of a run by their names, and what is looked at of a run for them.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// What is looked at.
    pub look: Look,
    /// The numbers.
    pub named: Vec<(String, Criterion)>,
}

impl Numbers {
    /// Names and units of their columns.
    pub fn columns(&self) -> impl Iterator<Item = (String, String)> + use<'_> {
        self.named.iter().map(|(name, number)| (name.clone(), number.unit().to_owned()))
    }

    /// Their values of a run, each in its unit.
    #[must_use]
    pub fn of(&self, found: &Found) -> Vec<f64> {
        let value = |number: &Criterion| number.shown(self.look.criteria().value(number, &found.known));
        self.named.iter().map(|(_, number)| value(number)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_made_of_samples_that_need_not_be_equally_far_apart() {
        let mut run = Recording::new(vec![Column::new("a", "N"), Column::new("x", "m")]);
        run.push(1.0, [0.0, 2.0]);
        run.push(2.0, [0.0, 4.0]);
        run.push(4.0, [0.0, -2.0]);
        run.events = vec![1.5];
        let reductions = Reduction::ALL.map(|reduction| (1, reduction)).to_vec();
        let wanted = Wanted { reductions, event_times: 2, trajectories: vec![] };
        let numbers = wanted.numbers(&run);
        assert_eq!(numbers[..6], [4.0, -2.0, 5.0 / 3.0, -2.0, 5.0, 1.5]);
        assert!(numbers[6].is_nan());
    }
}
