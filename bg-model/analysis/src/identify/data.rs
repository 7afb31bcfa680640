//! Measured columns: values at instants, with gaps.

/// A measured column.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its name in the file.
    pub name: String,
    /// The output that it measures: its place in the model's description.
    pub output: usize,
    /// A value for each instant, in the output's unit; none in gaps.
    pub values: Vec<Option<f64>>,
}

/// What was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// The instants, s, ascending.
    pub times: Vec<f64>,
    /// The columns that measure outputs.
    pub columns: Vec<Measured>,
    /// The names of the others.
    pub ignored: Vec<String>,
}

impl Data {
    /// How many values there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.columns.iter().map(|column| column.values.iter().flatten().count()).sum()
    }
}
