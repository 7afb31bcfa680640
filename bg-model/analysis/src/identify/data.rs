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
    /// The first part of them, of the time from the first to the last instant.
    #[must_use]
    pub fn until(&self, part: f64) -> Self {
        let (first, last) = (self.times.first().copied().unwrap_or(0.0), self.times.last().copied().unwrap_or(0.0));
        let count = self.times.partition_point(|&t| t <= first + part * (last - first));
        let column = |column: &Measured| Measured { values: column.values[..count].to_vec(), ..column.clone() };
        Self {
            times: self.times[..count].to_vec(),
            columns: self.columns.iter().map(column).collect(),
            ignored: self.ignored.clone(),
        }
    }

    /// How many values there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.columns.iter().map(|column| column.values.iter().flatten().count()).sum()
    }
}
