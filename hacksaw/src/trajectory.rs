//! A sampled run as a table, and its CSV file.
//!
//! In: times and rows of output values, from a run or from a CSV file. Out: columns by name, and the CSV file with the
//! columns of the reference trajectory. Everything after the run itself (figures, checks, summary) works from here.

use std::io::{Read, Write};

use bg_model::scalar::Scalar;
use bg_model::simulation;
use thiserror::Error;

/// A column of a trajectory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name, such as `C2_x`.
    pub name: String,
    /// Its SI unit as text; empty for a pure number.
    pub unit: String,
}

impl From<simulation::Column> for Column {
    fn from(column: simulation::Column) -> Self {
        Self { name: column.name.to_owned(), unit: column.unit.to_owned() }
    }
}

/// The outputs of a run at its sample times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Name and unit of each value of a row.
    pub columns: Vec<Column>,
    /// Sample times, s, ascending.
    pub times: Vec<f64>,
    /// One row of values for each sample time.
    pub rows: Vec<Vec<f64>>,
}

/// A trajectory that cannot be read or written.
#[derive(Debug, Error)]
pub enum TrajectoryError {
    /// A column that is needed is not there.
    #[error("the trajectory has no column `{0}`")]
    MissingColumn(String),
    /// A field of a CSV file is not a number.
    #[error("`{field}` in line {line} is not a number")]
    NotANumber {
        /// The field's text.
        field: String,
        /// Its line, counted from 1, the header included.
        line: usize,
    },
    /// The first column of a CSV file is not the time.
    #[error("the first column must be `t`")]
    NoTime,
    /// Reading or writing failed.
    #[error(transparent)]
    Csv(#[from] csv::Error),
}

impl From<TrajectoryError> for std::io::Error {
    /// Keeps the kind of a failure to write.
    fn from(fault: TrajectoryError) -> Self {
        match fault {
            TrajectoryError::Csv(fault) => fault.into(),
            fault => Self::other(fault),
        }
    }
}

/// The links that move: crank, rod, frame and guide.
pub const LINKS: [u8; 4] = [2, 3, 4, 5];

/// The suffixes of a vector's components.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// The columns of the reference trajectory after `t`: for each link L the position `CL` of its centre of mass, its
/// orientation `RL` (body to inertial, row by row), its momentum `pL` and its angular momentum `hL` about the centre of mass.
#[must_use]
pub fn reference_columns() -> Vec<String> {
    let vector = |symbol: char, link: u8| AXES.map(|axis| format!("{symbol}{link}_{axis}"));
    let matrix = |link: u8| (1..=3).flat_map(move |row| (1..=3).map(move |column| format!("R{link}_{row}{column}")));
    LINKS
        .iter()
        .flat_map(|&link| {
            vector('C', link).into_iter().chain(matrix(link)).chain(vector('p', link)).chain(vector('h', link))
        })
        .collect()
}

impl Trajectory {
    /// A trajectory without samples.
    #[must_use]
    pub fn new(columns: Vec<Column>) -> Self {
        Self { columns, times: Vec::new(), rows: Vec::new() }
    }

    /// Appends the sample at time `t` (s).
    pub fn push(&mut self, t: f64, row: Vec<f64>) {
        debug_assert_eq!(row.len(), self.columns.len());
        self.times.push(t);
        self.rows.push(row);
    }

    /// The place of column `name` in a row.
    ///
    /// # Errors
    /// [`TrajectoryError::MissingColumn`].
    pub fn position(&self, name: &str) -> Result<usize, TrajectoryError> {
        self.columns
            .iter()
            .position(|column| column.name == name)
            .ok_or_else(|| TrajectoryError::MissingColumn(name.to_owned()))
    }

    /// The values of column `name`, one for each sample time.
    ///
    /// # Errors
    /// [`TrajectoryError::MissingColumn`].
    pub fn series(&self, name: &str) -> Result<Vec<f64>, TrajectoryError> {
        let position = self.position(name)?;
        Ok(self.rows.iter().map(|row| row[position]).collect())
    }

    /// The samples at exactly the times `times` (s, ascending), as far as this trajectory has them.
    #[must_use]
    pub fn at(&self, times: &[f64]) -> Self {
        let mut part = Self::new(self.columns.clone());
        let mut wanted = times.iter().peekable();
        for (&t, row) in self.times.iter().zip(&self.rows) {
            while wanted.next_if(|&&time| time < t).is_some() {}
            if wanted.peek() == Some(&&t) {
                part.push(t, row.clone());
            }
        }
        part
    }

    /// Appends the links' angles about z, rad, which the orientations of a plane motion determine.
    ///
    /// # Errors
    /// A missing orientation.
    pub fn add_angles(&mut self) -> Result<(), TrajectoryError> {
        for (link, name) in LINKS.iter().zip(["crank_angle", "rod_angle", "frame_angle", "guide_angle"]) {
            let (sine, cosine) = (self.series(&format!("R{link}_21"))?, self.series(&format!("R{link}_11"))?);
            self.columns.push(Column { name: name.to_owned(), unit: "rad".to_owned() });
            for (row, (sine, cosine)) in self.rows.iter_mut().zip(sine.into_iter().zip(cosine)) {
                row.push(Scalar::atan2(sine, cosine));
            }
        }
        Ok(())
    }

    /// Whether column `name` is there.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.position(name).is_ok()
    }

    /// Whether all columns of [`reference_columns`] are there.
    #[must_use]
    pub fn has_reference_columns(&self) -> bool {
        reference_columns().iter().all(|name| self.has(name))
    }

    /// Writes the CSV file: `t` and the columns of [`reference_columns`], or all columns where not all of those are there;
    /// every number in the shortest form that reads back to the same bits.
    ///
    /// # Errors
    /// A failure of `writer`.
    pub fn write_csv<W: Write>(&self, writer: W) -> Result<(), TrajectoryError> {
        let names = if self.has_reference_columns() {
            reference_columns()
        } else {
            self.columns.iter().map(|column| column.name.clone()).collect()
        };
        let positions = names.iter().map(|name| self.position(name)).collect::<Result<Vec<_>, _>>()?;
        let mut csv = csv::Writer::from_writer(writer);
        csv.write_record(std::iter::once("t").chain(names.iter().map(String::as_str)))?;
        for (t, row) in self.times.iter().zip(&self.rows) {
            csv.write_field(shortest(*t))?;
            for &position in &positions {
                csv.write_field(shortest(row[position]))?;
            }
            csv.write_record(None::<&[u8]>)?;
        }
        csv.flush().map_err(csv::Error::from)?;
        Ok(())
    }

    /// Reads a CSV file whose first column is `t`. Units are left empty.
    ///
    /// # Errors
    /// A file that is no CSV, has no `t`, or a field that is no number.
    pub fn read_csv<R: Read>(reader: R) -> Result<Self, TrajectoryError> {
        let mut csv = csv::Reader::from_reader(reader);
        let header = csv.headers()?.clone();
        if header.get(0) != Some("t") {
            return Err(TrajectoryError::NoTime);
        }
        let columns = header.iter().skip(1).map(|name| Column { name: name.to_owned(), unit: String::new() }).collect();
        let mut trajectory = Self::new(columns);
        for (index, record) in csv.records().enumerate() {
            let number = |field: &str| {
                // Line 1 is the header, so record 0 stands in line 2.
                field
                    .parse::<f64>()
                    .map_err(|_| TrajectoryError::NotANumber { field: field.to_owned(), line: index + 2 })
            };
            let values = record?.iter().map(number).collect::<Result<Vec<_>, _>>()?;
            trajectory.push(values[0], values[1..].to_vec());
        }
        Ok(trajectory)
    }
}

/// The shortest decimal form that reads back to the same bits, with an exponent where that is shorter.
fn shortest(value: f64) -> String {
    format!("{value:?}")
}

/// The sample times `0, step, 2 step, ... , t_end`, s.
///
/// Where `step` is the reciprocal of a whole number n, the times are the quotients k / n, so that they print as `0.3` and
/// not as `0.30000000000000004`. `t_end` is the last time even where it is no multiple of `step`.
#[must_use]
pub fn sample_times(step: f64, t_end: f64) -> Vec<f64> {
    // Rounding of a decimal step is below 1e-16 relative; anything nearer than this is meant to be the reciprocal.
    const RECIPROCAL: f64 = 1e-12;
    let per_second = (1.0 / step).round();
    let is_reciprocal = per_second >= 1.0 && (per_second * step - 1.0).abs() < RECIPROCAL;
    let time = |k: u64| if is_reciprocal { k as f64 / per_second } else { k as f64 * step };
    // A last multiple that all but equals t_end is t_end.
    let margin = 1e-9 * step;
    (0..).map(time).take_while(|&t| t < t_end - margin).chain(std::iter::once(t_end)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sample_times_are_decimal_and_end_at_t_end() {
        assert_eq!(sample_times(0.1, 0.5), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!(sample_times(0.2, 0.5), [0.0, 0.2, 0.4, 0.5]);
        assert_eq!(sample_times(0.3, 0.7), [0.0, 0.3, 0.6, 0.7]);
        assert_eq!(sample_times(2.0, 0.5), [0.0, 0.5]);
        assert_eq!(sample_times(0.002, 5.0).len(), 2501);
    }

    #[test]
    fn csv_has_the_reference_header_and_reads_back_bit_by_bit() {
        let columns: Vec<Column> = std::iter::once("crank_speed".to_owned())
            .chain(reference_columns())
            .map(|name| Column { name, unit: String::new() })
            .collect();
        let row: Vec<f64> = (0..columns.len()).map(|k| (k as f64).sqrt() * 1e-9 - 1.0 / 3.0).collect();
        let mut trajectory = Trajectory::new(columns);
        trajectory.push(0.1, row.clone());
        let mut bytes = Vec::new();
        trajectory.write_csv(&mut bytes).unwrap();
        let text = String::from_utf8(bytes.clone()).unwrap();
        let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        assert_eq!(header.len(), 73);
        assert_eq!(header[..9], ["t", "C2_x", "C2_y", "C2_z", "R2_11", "R2_12", "R2_13", "R2_21", "R2_22"]);
        assert_eq!(header[70..], ["h5_x", "h5_y", "h5_z"]);
        let back = Trajectory::read_csv(bytes.as_slice()).unwrap();
        assert_eq!(back.times, [0.1]);
        assert_eq!(back.rows[0], row[1..]);
    }

    #[test]
    fn csv_has_all_columns_where_the_reference_columns_are_not_there() {
        let columns = ["crank_speed", "C4_x"].map(|name| Column { name: name.to_owned(), unit: String::new() });
        let mut trajectory = Trajectory::new(columns.to_vec());
        trajectory.push(0.5, vec![2.0, 1e-9]);
        let mut bytes = Vec::new();
        trajectory.write_csv(&mut bytes).unwrap();
        assert_eq!(String::from_utf8(bytes).unwrap(), "t,crank_speed,C4_x\n0.5,2.0,1e-9\n");
    }

    #[test]
    fn a_part_has_the_times_that_are_there() {
        let mut trajectory = Trajectory::new(Vec::new());
        (0..5).for_each(|k| trajectory.push(f64::from(k), Vec::new()));
        assert_eq!(trajectory.at(&[0.0, 0.5, 2.0, 4.0, 9.0]).times, [0.0, 2.0, 4.0]);
    }

    #[test]
    fn a_missing_column_is_named() {
        let error = Trajectory::default().series("C2_x").unwrap_err();
        assert_eq!(error.to_string(), "the trajectory has no column `C2_x`");
    }
}
