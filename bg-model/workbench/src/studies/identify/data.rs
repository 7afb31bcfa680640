//! Measured columns: a CSV file with gaps, matched to a model's outputs.
//!
//! In: a file whose first column is `t`, which output each column measures; units may stand in the heads, as in `t
//! [ms]`. Out: values at instants, none where a field is empty or `nan`.

use std::io::Read;
use std::path::{Path, PathBuf};

use bg_analysis::identify::{Data, Measured};
use bg_model::description::OutputInfo;
use thiserror::Error;

use crate::ask::parameters::nearest;
use crate::ask::quantity::{Conversion, QuantityError};
use crate::files::head::{is_row, name_and_unit};

/// A file that is no measurement.
#[derive(Debug, Error)]
#[error("cannot use {}: {fault}", path.display())]
pub struct Unusable {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub fault: DataError,
}

/// Why it is none.
#[derive(Debug, Error)]
pub enum DataError {
    /// It cannot be read, or is no table.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// The first column is not the time.
    #[error("the first column must be `t`, the time in s")]
    NoTime,
    /// The first line is a row already.
    #[error("its first line has numbers; write a first line with `t`, the time in s, and the names of outputs")]
    NoHead,
    /// The unit in a head is not one of what the column measures.
    #[error("column `{column}`: {fault}")]
    Unit {
        /// The column.
        column: String,
        /// Why.
        fault: QuantityError,
    },
    /// A field is not a number.
    #[error("`{field}` in line {line} is not a number; leave the field empty where nothing was measured")]
    NotANumber {
        /// The field's text.
        field: String,
        /// Its line, counted from 1, the header included.
        line: usize,
    },
    /// The times do not ascend from 0 on.
    #[error("the time {t} s {place} is not after the one before it, or below 0")]
    Order {
        /// The time.
        t: f64,
        /// Its line or row, in words.
        place: String,
    },
    /// No time is after the start.
    #[error("the last time must be after 0 s: a run ends there")]
    NoSpan,
    /// There is no column of the time.
    #[error("there is no column `t`, the time in s")]
    NoTimeColumn,
    /// Columns are of different lengths.
    #[error("the column `{name}` has {values} values, and `t` has {times}")]
    Lengths {
        /// The column.
        name: String,
        /// How many values it has.
        values: usize,
        /// How many the time has.
        times: usize,
    },
    /// No column measures anything.
    #[error(
        "none of its columns ({0}) has the name of an output; name them as the outputs, or say what they are with \
         --column NAME=OUTPUT"
    )]
    NothingMeasured(String),
    /// A column that is spoken of is not there.
    #[error("it has no column `{name}`{}", .near.as_ref().map_or_else(String::new, |near| format!("; \
        did you mean `{near}`?")))]
    NoColumn {
        /// The name.
        name: String,
        /// The column with the most similar name.
        near: Option<String>,
    },
}

/// Reads the file at `path`: columns of the names of `outputs` are these, others are what `named` says, in pairs of
/// column and output; with `only` no other columns are used.
///
/// # Errors
/// [`Unusable`].
pub fn read_file(
    path: &Path,
    outputs: &'static [OutputInfo],
    named: &[(String, usize)],
    only: &[usize],
) -> Result<Data, Unusable> {
    let unusable = |fault| Unusable { path: path.to_owned(), fault };
    let file = std::fs::File::open(path).map_err(|fault| unusable(csv::Error::from(fault).into()))?;
    read(file, outputs, named, only).map_err(unusable)
}

/// The same of what is read.
///
/// # Errors
/// [`DataError`].
pub fn read(
    reader: impl Read,
    outputs: &'static [OutputInfo],
    named: &[(String, usize)],
    only: &[usize],
) -> Result<Data, DataError> {
    let mut csv = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(reader);
    if is_row(csv.headers()?) {
        return Err(DataError::NoHead);
    }
    let mut rows = Rows::new(csv.headers()?.iter(), outputs, named, only)?;
    for (index, record) in csv.records().enumerate() {
        // Line 1 is the header, so record 0 stands in line 2.
        let line = index + 2;
        let record = record?;
        let number = |field: &str| {
            let number = field.parse::<f64>();
            number.map_err(|_| DataError::NotANumber { field: field.to_owned(), line })
        };
        let mut fields = record.iter();
        let t = number(fields.next().unwrap_or_default())?;
        let values = fields.map(|field| if field.is_empty() { Ok(f64::NAN) } else { number(field) });
        rows.push(t, values, || format!("in line {line}"))?;
    }
    rows.data()
}

/// The same of columns by name, one of which is `t`, as they would be in a file; what is not finite was not measured.
///
/// # Errors
/// [`DataError`].
pub fn of_columns(
    columns: &[(String, Vec<f64>)],
    outputs: &'static [OutputInfo],
    named: &[(String, usize)],
    only: &[usize],
) -> Result<Data, DataError> {
    let is_time = |(head, _): &&(String, Vec<f64>)| name_and_unit(head).0 == "t";
    let (_, times) = columns.iter().find(is_time).ok_or(DataError::NoTimeColumn)?;
    let others: Vec<&(String, Vec<f64>)> = columns.iter().filter(|column| !is_time(column)).collect();
    if let Some((name, values)) = others.iter().find(|(_, values)| values.len() != times.len()) {
        return Err(DataError::Lengths { name: name.clone(), values: values.len(), times: times.len() });
    }
    let heads = columns.iter().find(is_time).into_iter().chain(others.iter().copied()).map(|(head, _)| head.as_str());
    let mut rows = Rows::new(heads, outputs, named, only)?;
    for (row, &t) in times.iter().enumerate() {
        rows.push(t, others.iter().map(|(_, values)| Ok(values[row])), || format!("in row {}", row + 1))?;
    }
    rows.data()
}

/// Rows that are read one after the other, in the units of their heads.
struct Rows {
    names: Vec<String>,
    time: Conversion,
    times: Vec<f64>,
    /// A place for each column but that of the time; none where it measures nothing.
    columns: Vec<Option<(Measured, Conversion)>>,
}

impl Rows {
    /// Without rows, of these heads.
    fn new<'a>(
        heads: impl Iterator<Item = &'a str>,
        outputs: &'static [OutputInfo],
        named: &[(String, usize)],
        only: &[usize],
    ) -> Result<Self, DataError> {
        let mut heads = heads.map(name_and_unit);
        let Some(("t", unit)) = heads.next() else { return Err(DataError::NoTime) };
        let conversion = |column: &str, unit: Option<&str>, declared: &str| {
            let fault = |fault| DataError::Unit { column: column.to_owned(), fault };
            Conversion::between(unit.unwrap_or(declared), declared).map_err(fault)
        };
        let time = conversion("t", unit, "s")?;
        let heads: Vec<(&str, Option<&str>)> = heads.collect();
        let names: Vec<String> = heads.iter().map(|&(name, _)| name.to_owned()).collect();
        if let Some((name, _)) = named.iter().find(|(name, _)| !names.contains(name)) {
            let near = names.iter().map(|known| (strsim::jaro_winkler(name, known), known));
            let near = near.filter(|(similarity, _)| *similarity > 0.7).max_by(|a, b| a.0.total_cmp(&b.0));
            return Err(DataError::NoColumn { name: name.clone(), near: near.map(|(_, name)| name.clone()) });
        }
        let output_of = |name: &str| {
            let said = named.iter().find(|(column, _)| column == name).map(|(_, output)| *output);
            let output = said.or_else(|| outputs.iter().position(|output| output.name == name));
            output.filter(|output| only.is_empty() || only.contains(output))
        };
        let column = |(name, unit): (&str, Option<&str>)| {
            let Some(output) = output_of(name) else { return Ok(None) };
            let measured = Measured { name: name.to_owned(), output, values: Vec::new() };
            Ok(Some((measured, conversion(name, unit, outputs[output].unit)?)))
        };
        let columns = heads.into_iter().map(column).collect::<Result<_, DataError>>()?;
        Ok(Self { names, time, times: Vec::new(), columns })
    }

    /// A row that stands at `place`.
    fn push(
        &mut self,
        t: f64,
        values: impl Iterator<Item = Result<f64, DataError>>,
        place: impl Fn() -> String,
    ) -> Result<(), DataError> {
        let t = self.time.of(t);
        if !(t >= 0.0 && t.is_finite() && self.times.last().is_none_or(|&last| t > last)) {
            return Err(DataError::Order { t, place: place() });
        }
        self.times.push(t);
        for (column, value) in self.columns.iter_mut().zip(values) {
            if let Some((column, unit)) = column {
                column.values.push(Some(unit.of(value?)).filter(|value| value.is_finite()));
            }
        }
        Ok(())
    }

    fn data(self) -> Result<Data, DataError> {
        let Self { names, times, columns, .. } = self;
        let ignored = names.iter().zip(&columns).filter(|(_, column)| column.is_none()).map(|(name, _)| name.clone());
        let ignored = ignored.collect();
        let columns = columns.into_iter().flatten().map(|(column, _)| column).collect();
        let data = Data { times, columns, ignored };
        if data.count() == 0 {
            return Err(DataError::NothingMeasured(names.join(", ")));
        }
        if data.times.last().is_none_or(|&last| last <= 0.0) {
            return Err(DataError::NoSpan);
        }
        Ok(data)
    }
}

/// The output that a `NAME=OUTPUT` names; the text of what is wrong with it.
///
/// # Errors
/// It is no such pair, or there is no such output.
pub fn pair(text: &str, outputs: &'static [OutputInfo]) -> Result<(String, usize), String> {
    let (column, name) = text.split_once('=').ok_or_else(|| format!("{text}: give it as NAME=OUTPUT"))?;
    let (column, name) = (column.trim(), name.trim());
    let output = outputs.iter().position(|output| output.name == name);
    let near = || {
        let near = nearest(name, outputs.iter().map(|output| output.name));
        near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
    };
    output.map(|output| (column.to_owned(), output)).ok_or_else(|| format!("there is no output `{name}`{}", near()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn output(name: &'static str) -> OutputInfo {
        OutputInfo { name, of: name, observes: name, unit: "m" }
    }
    static OUTPUTS: [OutputInfo; 2] = [output("x"), output("force")];

    fn read(text: &str, named: &[(&str, usize)]) -> Result<Data, String> {
        let named: Vec<(String, usize)> = named.iter().map(|(name, output)| ((*name).to_owned(), *output)).collect();
        super::read(text.as_bytes(), &OUTPUTS, &named, &[]).map_err(|fault| fault.to_string())
    }

    #[test]
    fn gaps_and_other_names() {
        let data = read("t, x, load ,note\n0,1,2,3\n0.1,,nan,4\n0.2,5,6,\n", &[("load", 1)]).unwrap();
        assert_eq!((data.times.as_slice(), data.ignored.as_slice()), (&[0.0, 0.1, 0.2][..], &["note".to_owned()][..]));
        assert_eq!(data.columns[0].values, [Some(1.0), None, Some(5.0)]);
        assert_eq!((data.columns[1].output, &data.columns[1].values), (1, &vec![Some(2.0), None, Some(6.0)]));
        assert_eq!(data.count(), 4);
    }

    #[test]
    fn columns_with_units_in_their_heads_are_converted() {
        let data = read("t [ms],x [mm],other [furlong]\n0,250,1\n100,500,2\n", &[]).unwrap();
        assert_eq!((data.times.as_slice(), &data.columns[0].values), (&[0.0, 0.1][..], &vec![Some(0.25), Some(0.5)]));
        assert_eq!(data.ignored, ["other"]);
        let fault = |text: &str| read(text, &[]).unwrap_err();
        assert_eq!(fault("t,x [kg]\n0,1\n"), "column `x`: must be in m or a unit like it, and `kg` is none");
        assert_eq!(
            fault("t [fortnight],x\n0,1\n"),
            "column `t`: must be in s or a unit like it, and `fortnight` is no unit"
        );
    }

    #[test]
    fn columns_are_what_a_file_of_them_is() {
        let column = |name: &str, values: &[f64]| (name.to_owned(), values.to_vec());
        let of = |columns: &[(String, Vec<f64>)]| of_columns(columns, &OUTPUTS, &[("load".to_owned(), 1)], &[]);
        let x = column("x [mm]", &[250.0, f64::NAN]);
        let data = of(&[x.clone(), column("t [ms]", &[0.0, 100.0]), column("load", &[2.0, 3.0])]).unwrap();
        let text = "t [ms],x [mm],load\n0,250,2\n100,,3\n";
        assert_eq!(data, super::read(text.as_bytes(), &OUTPUTS, &[("load".to_owned(), 1)], &[]).unwrap());
        let fault = |columns: &[(String, Vec<f64>)]| of(columns).unwrap_err().to_string();
        assert_eq!(fault(std::slice::from_ref(&x)), "there is no column `t`, the time in s");
        assert_eq!(fault(&[x, column("t", &[0.0])]), "the column `x [mm]` has 2 values, and `t` has 1");
        let fell = [column("t", &[1.0, 0.5]), column("load", &[0.0, 0.0])];
        assert_eq!(fault(&fell), "the time 0.5 s in row 2 is not after the one before it, or below 0");
    }

    #[test]
    fn what_cannot_be_used_is_said() {
        let fault = |text: &str, named: &[(&str, usize)]| read(text, named).unwrap_err();
        assert!(fault("x,y\n", &[]).contains("must be `t`"));
        assert!(fault("0,1\n0.1,2\n", &[]).starts_with("its first line has numbers; write a first line with `t`"));
        assert!(fault("t,x\n0,a\n", &[]).contains("`a` in line 2"));
        assert!(fault("t,x\n1,0\n0.5,0\n", &[]).contains("line 3"));
        assert!(fault("t,y\n0,1\n", &[]).contains("none of its columns (y)"));
        assert_eq!(fault("t,x\n0,1\n", &[]), "the last time must be after 0 s: a run ends there");
        assert!(fault("t,lode\n0,1\n", &[("load", 1)]).contains("did you mean `lode`"));
        assert!(pair("a=forse", &OUTPUTS).unwrap_err().contains("did you mean `force`"));
        assert_eq!(pair("a = x", &OUTPUTS), Ok(("a".to_owned(), 0)));
    }
}
