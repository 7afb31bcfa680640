//! A recording: the samples of a run of a model, as columns by name.
//!
//! In: a model and what is to be recorded of it. Out: an observer, and after the run a table: a value for each sample
//! in every column, with the names and units of the model's description.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use thiserror::Error;

#[cfg(feature = "std")]
use super::PeakMonitor;
use super::{Observer, Peaks, raise};
use crate::model::description::Description;
use crate::model::dynamics::Machine;
use crate::model::system::Powers;
use crate::solve::failure::NoNumber;

/// What is recorded at each sample beside its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The observed outputs.
    Outputs,
    /// The states.
    States,
    /// The energy in all storage elements: `stored energy`, J.
    Energy,
    /// The powers over the model's boundary: `supplied power` and `dissipated power`, W.
    Powers,
    /// What pictures show, a column for each place of the description's drawing: `shown 0` and so on.
    Shown,
}

/// A column of a recording: a quantity over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Its name, such as `C2_x`.
    pub name: String,
    /// Its unit, SI; empty for a pure number, and where it is not known.
    pub unit: String,
    /// Its values, one for each sample.
    pub values: Vec<f64>,
    /// Its least and its largest value over the whole run, between samples as well; none where that was not asked for.
    pub peaks: Option<Peaks>,
    /// The same from an instant on that was given; none where none was, or where the run has not come there.
    pub settled: Option<Peaks>,
}

/// The samples of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Sample times, s, ascending.
    pub times: Vec<f64>,
    /// What was recorded, each with as many values as there are times.
    pub columns: Vec<Column>,
    /// The times at which switches have changed their branches, s.
    pub events: Vec<f64>,
}

/// A column that is needed and not there.
#[derive(Clone, PartialEq, Eq, Error)]
#[error("there is no column `{0}`")]
pub struct MissingColumn(pub String);

debug_is_display!(MissingColumn);

impl Column {
    /// A column without values.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), values: Vec::new(), peaks: None, settled: None }
    }
}

impl Recording {
    /// Without samples, of these columns.
    #[must_use]
    pub fn new(columns: Vec<Column>) -> Self {
        Self { columns, ..Self::default() }
    }

    /// The column called `name`: the first of that name; none where there is no such column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        Some(&column.values)
    }

    /// The same; of a name that no column has the error says so.
    ///
    /// # Errors
    /// [`MissingColumn`].
    pub fn values(&self, name: &str) -> Result<&[f64], MissingColumn> {
        self.column(name).ok_or_else(|| MissingColumn(name.to_owned()))
    }

    /// The peaks of the column called `name`; none where there is no such column, or where they were not asked for.
    #[must_use]
    pub fn peaks(&self, name: &str) -> Option<Peaks> {
        self.columns.iter().find(|column| column.name == name)?.peaks
    }

    /// Whether there is a column called `name`.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.column(name).is_some()
    }

    /// The values of sample `index`, one for each column.
    ///
    /// # Panics
    /// There is no such sample.
    pub fn row(&self, index: usize) -> impl Iterator<Item = f64> {
        self.columns.iter().map(move |column| column.values[index])
    }

    /// Appends the sample at `t` (s) with a value for each column.
    pub fn push(&mut self, t: f64, row: impl IntoIterator<Item = f64>) {
        self.times.push(t);
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
        debug_assert!(self.columns.iter().all(|column| column.values.len() == self.times.len()));
    }

    /// The samples at exactly the instants `times` (s, ascending), as far as there are any; with all events.
    #[must_use]
    pub fn at(&self, times: &[f64]) -> Self {
        let mut wanted = times.iter().peekable();
        let is_wanted = |t: &f64| {
            while wanted.next_if(|&time| time < t).is_some() {}
            wanted.peek() == Some(&t)
        };
        let kept: Vec<bool> = self.times.iter().map(is_wanted).collect();
        let of =
            |values: &[f64]| values.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(value, _)| *value).collect();
        let columns = self.columns.iter().map(|column| Column { values: of(&column.values), ..column.clone() });
        Self { times: of(&self.times), columns: columns.collect(), events: self.events.clone() }
    }
}

/// An observer that records a model's samples and the times of its events. Allocates at each sample. Where a value is
/// not finite the run ends, and [`Recorder::fault`] says which.
#[derive(Clone)]
pub struct Recorder<'a> {
    model: &'a dyn Machine,
    parts: Vec<Part>,
    /// The values of a sample on their way.
    row: Vec<f64>,
    /// What has been recorded.
    pub recording: Recording,
    /// The largest absolute value of each state at the samples.
    pub largest: Vec<f64>,
    /// The first value that could not be calculated: nothing is recorded from there on, and the run ends.
    pub fault: Option<NoNumber>,
}

impl<'a> Recorder<'a> {
    /// Records these parts of a model, in this order.
    #[must_use]
    pub fn new(model: &'a dyn Machine, parts: &[Part]) -> Self {
        let columns = parts.iter().flat_map(|part| part.columns(model.description())).collect();
        let (parts, recording) = (parts.to_vec(), Recording::new(columns));
        Self { model, parts, row: Vec::new(), recording, largest: vec![0.0; model.states()], fault: None }
    }

    /// Takes over the peaks of the outputs, as far as these are recorded.
    #[cfg(feature = "std")]
    pub(crate) fn keep(&mut self, found: &PeakMonitor<'_>) {
        let mut columns = self.recording.columns.iter_mut();
        for part in &self.parts {
            let count = part.columns(self.model.description()).len();
            let of_part = columns.by_ref().take(count);
            if *part == Part::Outputs {
                for (index, column) in of_part.enumerate() {
                    (column.peaks, column.settled) = (found.peaks(index), found.settled(index));
                }
            } else {
                of_part.for_each(drop);
            }
        }
    }

    /// The model.
    #[cfg(feature = "std")]
    pub(crate) const fn model(&self) -> &'a dyn Machine {
        self.model
    }
}

impl Observer for Recorder<'_> {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        if self.fault.is_some() {
            return;
        }
        raise(&mut self.largest, x);
        self.row.clear();
        let mut faulty = None;
        for part in &self.parts {
            let first = self.row.len();
            part.write(self.model, t, x, negative, &mut self.row);
            let is_calculated = *part != Part::Shown;
            let place = self.row[first..].iter().position(|value| is_calculated && !value.is_finite());
            faulty = faulty.or(place.map(|place| (first + place, (*part == Part::Outputs).then_some(place))));
        }
        match faulty {
            None => self.recording.push(t, self.row.iter().copied()),
            Some((column, output)) => {
                self.fault = Some(NoNumber {
                    name: self.recording.columns[column].name.clone(),
                    observes: output.map(|output| self.model.description().outputs[output].observes),
                    value: self.row[column],
                    t,
                    origin: self.model.not_finite(t, x, negative),
                });
            }
        }
    }

    fn event(&mut self, t: f64, _: &[f64], _: usize, _: &[bool]) {
        if self.fault.is_none() {
            self.recording.events.push(t);
        }
    }

    fn is_done(&self) -> bool {
        self.fault.is_some()
    }
}

impl Part {
    fn columns(self, of: &Description) -> Vec<Column> {
        let column = |name: &str, unit: &str| Column::new(name, unit);
        match self {
            Self::Outputs => of.outputs.iter().map(|output| column(output.name, output.unit)).collect(),
            Self::States => of.states.iter().map(|state| column(state.name, state.unit)).collect(),
            Self::Energy => vec![column("stored energy", "J")],
            Self::Powers => vec![column("supplied power", "W"), column("dissipated power", "W")],
            Self::Shown => (0..of.drawing.tape.results.len()).map(|k| Column::new(format!("shown {k}"), "")).collect(),
        }
    }

    fn write(self, model: &dyn Machine, t: f64, x: &[f64], negative: &[bool], row: &mut Vec<f64>) {
        match self {
            Self::Outputs => {
                let first = row.len();
                row.resize(first + model.description().outputs.len(), 0.0);
                model.outputs(t, x, negative, &mut row[first..]);
            }
            Self::States => row.extend(x),
            Self::Energy => row.push(model.stored_energy(t, x, negative)),
            Self::Powers => {
                let Powers { supplied, dissipated } = model.powers(t, x, negative);
                row.extend([supplied, dissipated]);
            }
            Self::Shown => model.shown(t, x, negative, row),
        }
    }
}
