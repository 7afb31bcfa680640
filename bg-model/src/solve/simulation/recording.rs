//! A recording: the samples of a run of a model, as columns by name.
//!
//! In: a model and what is to be recorded of it. Out: an observer, and after the run a table: a row for each sample, with the
//! names and units of the model's description.

use nalgebra::SVector;

use super::Observer;
use crate::model::description::Description;
use crate::model::system::{Model, Powers};

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
}

/// A column of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name, such as `C2_x`.
    pub name: &'static str,
    /// Its unit, SI; empty for a pure number.
    pub unit: &'static str,
}

/// The samples of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Name and unit of each value of a row.
    pub columns: Vec<Column>,
    /// Sample times, s, ascending.
    pub times: Vec<f64>,
    /// One row of values for each sample.
    pub rows: Vec<Vec<f64>>,
    /// The times at which switches have changed their branches, s.
    pub events: Vec<f64>,
}

impl Recording {
    /// The place of column `name` in a row: of the first of that name.
    #[must_use]
    pub fn position(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The values of column `name`, one for each sample; nothing where there is no such column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let position = self.position(name)?;
        Some(self.rows.iter().map(|row| row[position]).collect())
    }
}

/// An observer that records a model's samples and the times of its events. Allocates at each sample.
#[derive(Clone, Debug)]
pub struct Recorder<'a, Mo, const N: usize, const G: usize, const M: usize> {
    model: &'a Mo,
    parts: Vec<Part>,
    /// What has been recorded.
    pub recording: Recording,
}

impl<'a, Mo, const N: usize, const G: usize, const M: usize> Recorder<'a, Mo, N, G, M>
where
    Mo: Model<f64, N, G, M>,
{
    /// Records these parts of a model, in this order.
    #[must_use]
    pub fn new(model: &'a Mo, parts: &[Part]) -> Self {
        let columns = parts.iter().flat_map(|part| part.columns(model.description())).collect();
        Self { model, parts: parts.to_vec(), recording: Recording { columns, ..Recording::default() } }
    }
}

impl<Mo, const N: usize, const G: usize, const M: usize> Observer<N, G> for Recorder<'_, Mo, N, G, M>
where
    Mo: Model<f64, N, G, M>,
{
    fn sample(&mut self, t: f64, x: &SVector<f64, N>, negative: &[bool; G]) {
        let mut row = Vec::with_capacity(self.recording.columns.len());
        for part in &self.parts {
            part.write(self.model, t, x, negative, &mut row);
        }
        self.recording.times.push(t);
        self.recording.rows.push(row);
    }

    fn event(&mut self, t: f64, _: &SVector<f64, N>, _: usize, _: &[bool; G]) {
        self.recording.events.push(t);
    }
}

impl Part {
    fn columns(self, of: &Description) -> Vec<Column> {
        let column = |name, unit| Column { name, unit };
        match self {
            Self::Outputs => of.outputs.iter().map(|output| column(output.name, output.unit)).collect(),
            Self::States => of.states.iter().map(|state| column(state.name, state.unit)).collect(),
            Self::Energy => vec![column("stored energy", "J")],
            Self::Powers => vec![column("supplied power", "W"), column("dissipated power", "W")],
        }
    }

    fn write<Mo, const N: usize, const G: usize, const M: usize>(
        self,
        model: &Mo,
        t: f64,
        x: &SVector<f64, N>,
        negative: &[bool; G],
        row: &mut Vec<f64>,
    ) where
        Mo: Model<f64, N, G, M>,
    {
        match self {
            Self::Outputs => {
                let mut outputs = SVector::<f64, M>::zeros();
                model.outputs(t, x, negative, &mut outputs);
                row.extend(outputs.iter());
            }
            Self::States => row.extend(x.iter()),
            Self::Energy => row.push(model.stored_energy(t, x, negative)),
            Self::Powers => {
                let Powers { supplied, dissipated } = model.powers(t, x, negative);
                row.extend([supplied, dissipated]);
            }
        }
    }
}
