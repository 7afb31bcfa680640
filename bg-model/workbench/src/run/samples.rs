//! Samples read back from a CSV file.

use std::io::Read;
use std::path::{Path, PathBuf};

use bg_model::description::OutputInfo;
use bg_model::simulation::{Column, Recording};
use thiserror::Error;

use crate::ask::quantity::{Conversion, QuantityError};
use crate::files::head::{is_row, name_and_unit};

/// A CSV file that is no run.
#[derive(Debug, Error)]
pub enum SamplesError {
    /// A field is not a number.
    #[error("`{field}` in line {line} is not a number")]
    NotANumber {
        /// The field's text.
        field: String,
        /// Its line, counted from 1, the header included.
        line: usize,
    },
    /// The first column is not the time.
    #[error("the first column must be `t`")]
    NoTime,
    /// A column is in no unit of what the model's output of its name is.
    #[error("column `{column}`: {fault}")]
    Unit {
        /// The column.
        column: String,
        /// Why.
        fault: QuantityError,
    },
    /// The time is in no unit of time.
    #[error("the time: {0}")]
    Time(QuantityError),
    /// The first line is a row already.
    #[error("its first line has numbers; write a first line with `t` and the names of the columns")]
    NoHead,
    /// It cannot be read, or is no table.
    #[error(transparent)]
    Csv(#[from] csv::Error),
}

/// A file that is no run, with its name.
#[derive(Debug, Error)]
#[error("cannot read {}: {source}", path.display())]
pub struct Unreadable {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub source: SamplesError,
}

/// Reads a CSV file whose first column is `t`. Units are those in the heads, as in `speed [rpm]`, else left empty; the
/// time is in s then.
///
/// # Errors
/// A file that is no CSV, has no `t`, or a field that is no number.
pub fn read(reader: impl Read) -> Result<Recording, SamplesError> {
    let mut csv = csv::Reader::from_reader(reader);
    let header = csv.headers()?.clone();
    if is_row(&header) {
        return Err(SamplesError::NoHead);
    }
    let mut heads = header.iter().map(name_and_unit);
    let Some(("t", unit)) = heads.next() else { return Err(SamplesError::NoTime) };
    let time = Conversion::between(unit.unwrap_or("s"), "s").map_err(SamplesError::Time)?;
    let mut samples = Recording::new(heads.map(|(name, unit)| Column::new(name, unit.unwrap_or_default())).collect());
    for (index, record) in csv.records().enumerate() {
        let number = |field: &str| {
            // Line 1 is the header, so record 0 stands in line 2.
            field.parse::<f64>().map_err(|_| SamplesError::NotANumber { field: field.to_owned(), line: index + 2 })
        };
        let values = record?.iter().map(number).collect::<Result<Vec<_>, _>>()?;
        samples.push(time.of(values[0]), values[1..].iter().copied());
    }
    Ok(samples)
}

/// Reads the CSV file at `path`, as [`read`] does.
///
/// # Errors
/// [`Unreadable`].
pub fn read_file(path: &Path) -> Result<Recording, Unreadable> {
    let unreadable = |source| Unreadable { path: path.to_owned(), source };
    let file = std::fs::File::open(path).map_err(|fault| unreadable(csv::Error::from(fault).into()))?;
    read(file).map_err(unreadable)
}

/// Reads the file of a run of a model that has these outputs, as [`read_file`] does: columns of their names are in
/// their units then. A file may have others, or none, which are these.
///
/// # Errors
/// [`Unreadable`].
pub fn read_file_of<'a>(
    path: &Path,
    outputs: impl Iterator<Item = &'a OutputInfo> + Clone,
) -> Result<Recording, Unreadable> {
    let mut samples = read_file(path)?;
    for column in &mut samples.columns {
        let Some(output) = outputs.clone().find(|output| output.name == column.name) else { continue };
        if !column.unit.is_empty() {
            let unit = Conversion::between(&column.unit, output.unit).map_err(|fault| Unreadable {
                path: path.to_owned(),
                source: SamplesError::Unit { column: column.name.clone(), fault },
            })?;
            column.values.iter_mut().for_each(|value| *value = unit.of(*value));
        }
        output.unit.clone_into(&mut column.unit);
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_table_reads_back_bit_for_bit() {
        let mut samples = Recording::new(vec![Column::new("a", ""), Column::new("b", "")]);
        samples.push(0.0, [1.0 / 3.0, -0.0]);
        samples.push(0.1 + 0.2, [1e-300, f64::INFINITY]);
        let mut bytes = Vec::new();
        samples.write_csv(&mut bytes).unwrap();
        assert_eq!(read(&bytes[..]).unwrap(), samples);
        assert!(String::from_utf8(bytes).unwrap().starts_with("t,a,b\n0.0,0.3333333333333333,-0.0\n"));
    }

    #[test]
    fn units_in_heads_are_read_back() {
        let mut samples = Recording::new(vec![Column::new("wagon[0].x", "mm"), Column::new("ratio", "")]);
        samples.push(0.25, [1.0, 2.0]);
        let mut bytes = Vec::new();
        samples.write_csv_with_units(&mut bytes).unwrap();
        assert_eq!(String::from_utf8_lossy(&bytes), "t [s],wagon[0].x [mm],ratio\n0.25,1.0,2.0\n");
        assert_eq!(read(&bytes[..]).unwrap(), samples);
        assert_eq!(read("t [ms],wagon[0].x [mm],ratio\n250,1,2\n".as_bytes()).unwrap(), samples);
    }

    #[test]
    fn columns_come_in_the_units_of_a_model() {
        let output = |name, unit| OutputInfo { name, of: name, observes: name, unit };
        let outputs = [output("x", "m"), output("speed", "rad/s")];
        let read = |text: &str| {
            let file = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(file.path(), text).unwrap();
            read_file_of(file.path(), outputs.iter()).map_err(|fault| fault.source.to_string())
        };
        let run = read("t [ms],x [mm],speed,other [V]\n250,1500,2,3\n").unwrap();
        let columns: Vec<_> = run.columns.iter().map(|column| (column.unit.as_str(), column.values[0])).collect();
        assert_eq!((run.times[0], columns), (0.25, vec![("m", 1.5), ("rad/s", 2.0), ("V", 3.0)]));
        assert_eq!(
            read("t,x [kg]\n0,1\n").unwrap_err(),
            "column `x`: must be in m or a unit like it, and `kg` is none"
        );
    }

    #[test]
    fn what_is_no_run_is_said() {
        let fault = |text: &str| read(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(fault("x,y\n1,2\n"), "the first column must be `t`");
        assert_eq!(fault("t [mm],y\n1,2\n"), "the time: must be in s or a unit like it, and `mm` is none");
        assert!(fault("0,1\n1,2\n").starts_with("its first line has numbers; write a first line with `t`"));
        assert_eq!(fault("t,y\n1,two\n"), "`two` in line 2 is not a number");
    }
}
