//! Measured columns: a CSV file with gaps, matched to a model's outputs.
//!
//! In: a file whose first column is `t`, which output each column measures; units may stand in the heads, as in `t [ms]`. Out: values at instants, none where a
//! field is empty or `nan`.

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
    #[error("the time {t} s in line {line} is not after the one before it, or below 0")]
    Order {
        /// The time.
        t: f64,
        /// Its line.
        line: usize,
    },
    /// No column measures anything.
    #[error(
        "none of its columns ({0}) has the name of an output; name them as the outputs, or say what they are with \
         --column NAME=OUTPUT"
    )]
    NothingMeasured(String),
    /// A column that is spoken of is not there.
    #[error("it has no column `{name}`{}", .near.as_ref().map_or_else(String::new, |near| format!("; did you mean `{near}`?")))]
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
    let heads = csv.headers()?.clone();
    let (header, units): (Vec<String>, Vec<Option<&str>>) =
        heads.iter().map(name_and_unit).map(|(name, unit)| (name.to_owned(), unit)).unzip();
    if header.first().map(String::as_str) != Some("t") {
        return Err(DataError::NoTime);
    }
    if let Some((name, _)) = named.iter().find(|(name, _)| !header[1..].contains(name)) {
        let near = header[1..].iter().map(|known| (strsim::jaro_winkler(name, known), known));
        let near = near.filter(|(similarity, _)| *similarity > 0.7).max_by(|a, b| a.0.total_cmp(&b.0));
        return Err(DataError::NoColumn { name: name.clone(), near: near.map(|(_, name)| name.clone()) });
    }
    let output_of = |name: &String| {
        let said = named.iter().find(|(column, _)| column == name).map(|(_, output)| *output);
        said.or_else(|| outputs.iter().position(|output| output.name == name))
    };
    let is_used = |output: &usize| only.is_empty() || only.contains(output);
    let places: Vec<Option<usize>> = header[1..].iter().map(|name| output_of(name).filter(is_used)).collect();
    let conversion = |(place, declared): (usize, &str)| {
        let fault = |fault| DataError::Unit { column: header[place].clone(), fault };
        Conversion::between(units[place].unwrap_or(declared), declared).map_err(fault)
    };
    let time = conversion((0, "s"))?;
    let of_column = |(index, output): (usize, &Option<usize>)| {
        output.map(|output| conversion((index + 1, outputs[output].unit))).transpose()
    };
    let conversions = places.iter().enumerate().map(of_column).collect::<Result<Vec<_>, _>>()?;
    let column = |(name, output): (&String, &Option<usize>)| {
        output.map(|output| Measured { name: name.clone(), output, values: Vec::new() })
    };
    let mut columns: Vec<Option<Measured>> = header[1..].iter().zip(&places).map(column).collect();
    let mut times: Vec<f64> = Vec::new();
    for (index, record) in csv.records().enumerate() {
        // Line 1 is the header, so record 0 stands in line 2.
        let line = index + 2;
        let record = record?;
        let number = |field: &str| {
            let number = field.parse::<f64>();
            number.map_err(|_| DataError::NotANumber { field: field.to_owned(), line })
        };
        let mut fields = record.iter();
        let t = time.of(number(fields.next().unwrap_or_default())?);
        if !(t >= 0.0 && t.is_finite() && times.last().is_none_or(|&last| t > last)) {
            return Err(DataError::Order { t, line });
        }
        times.push(t);
        for ((column, conversion), field) in columns.iter_mut().zip(&conversions).zip(fields) {
            if let (Some(column), Some(unit)) = (column, conversion) {
                let value = if field.is_empty() { None } else { Some(unit.of(number(field)?)) };
                let value = value.filter(|value| value.is_finite());
                column.values.push(value);
            }
        }
    }
    let ignored = header[1..].iter().zip(&columns).filter(|(_, column)| column.is_none()).map(|(name, _)| name.clone());
    let data = Data { ignored: ignored.collect(), times, columns: columns.into_iter().flatten().collect() };
    if data.count() == 0 {
        return Err(DataError::NothingMeasured(header[1..].join(", ")));
    }
    Ok(data)
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
    fn what_cannot_be_used_is_said() {
        let fault = |text: &str, named: &[(&str, usize)]| read(text, named).unwrap_err();
        assert!(fault("x,y\n", &[]).contains("must be `t`"));
        assert!(fault("0,1\n0.1,2\n", &[]).starts_with("its first line has numbers; write a first line with `t`"));
        assert!(fault("t,x\n0,a\n", &[]).contains("`a` in line 2"));
        assert!(fault("t,x\n1,0\n0.5,0\n", &[]).contains("line 3"));
        assert!(fault("t,y\n0,1\n", &[]).contains("none of its columns (y)"));
        assert!(fault("t,lode\n0,1\n", &[("load", 1)]).contains("did you mean `lode`"));
        assert!(pair("a=forse", &OUTPUTS).unwrap_err().contains("did you mean `force`"));
        assert_eq!(pair("a = x", &OUTPUTS), Ok(("a".to_owned(), 0)));
    }
}
