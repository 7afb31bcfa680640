//! The samples of a run as a table, in the form that a reader wants.
//!
//! In: samples. Out: a CSV file, Parquet, or arrays for numpy. Numbers have all their bits in each of them; what is no
//! number is `NaN` in CSV and for numpy, null in Parquet.

use std::io::{self, Write};

use bg_analysis::npz::{Array, archive};
use bg_model::simulation::Recording;

use crate::files::parquet::{Column, Table, Values};

/// What a table is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// CSV: `t` and the names of the columns, then rows.
    Csv,
    /// The same with units in the head, as in `speed [rpm]`.
    CsvWithUnits,
    /// Parquet: a column for each, and the text `units`, an object of JSON, in the metadata.
    Parquet,
    /// An archive of numpy: an array for each column, and the arrays `names` and `units`, unless a column is called so.
    Npz,
}

impl Form {
    /// Writes `samples`.
    ///
    /// # Errors
    /// A failure of `writer`.
    pub fn write(self, samples: &Recording, writer: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Csv => samples.write_csv(writer),
            Self::CsvWithUnits => samples.write_csv_with_units(writer),
            Self::Parquet => writer.write_all(&parquet(samples).bytes()),
            Self::Npz => writer.write_all(&npz(samples)?),
        }
    }
}

/// Names, units and values of all columns, the time first.
fn columns(samples: &Recording) -> impl Iterator<Item = (&str, &str, &[f64])> {
    let own =
        samples.columns.iter().map(|column| (column.name.as_str(), column.unit.as_str(), column.values.as_slice()));
    std::iter::once(("t", "s", samples.times.as_slice())).chain(own)
}

fn parquet(samples: &Recording) -> Table {
    let column = |(name, _, values): (&str, &str, &[f64])| Column {
        name: name.to_owned(),
        values: Values::Real(values.to_vec()),
    };
    let units: serde_json::Map<_, _> = columns(samples).map(|(name, unit, _)| (name.to_owned(), unit.into())).collect();
    let texts = vec![("units".to_owned(), serde_json::Value::Object(units).to_string())];
    Table { columns: columns(samples).map(column).collect(), texts }
}

fn npz(samples: &Recording) -> io::Result<Vec<u8>> {
    let about = [
        ("names", Array::texts(columns(samples).map(|(name, ..)| name))),
        ("units", Array::texts(columns(samples).map(|(_, unit, _)| unit))),
    ];
    let is_free = |(name, _): &(&str, Array)| columns(samples).all(|(column, ..)| column != *name);
    let numbers = columns(samples).map(|(name, _, values)| (name, Array::numbers(&[values.len()], values)));
    archive(&numbers.chain(about.into_iter().filter(is_free)).collect::<Vec<_>>())
}
