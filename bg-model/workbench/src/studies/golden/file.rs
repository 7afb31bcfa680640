//! The two files of a golden output: settings, counts and tolerances in NAME.toml, the trajectory in NAME.csv.
//!
//! In: a folder. Out: the golden outputs in it, as far as the files can be read.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use bg_model::simulation::{Column, Recording};
use serde::Deserialize;

use super::GoldenError;
use super::counts::Counts;
use crate::ask::parameters::{one_line, place_of};
use crate::ask::request::Integration;
use crate::run::recipe::Quantity;
use crate::run::samples;

/// How far values of a unit may be off: `relative` times the largest recorded value of the unit, plus `absolute`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// In units of the largest recorded value of the unit.
    pub relative: f64,
    /// In the unit.
    pub absolute: f64,
}

/// The same input gives the same bytes on every machine, so a tolerance is there for changes of the compiler or the
/// integrator that reorder operations: they are to pass where the motion forgives them. 1e-9 is a tenth of the default
/// tolerance of the steps. The absolute part is for units of which all values are rounding, as a user knows: a charge
/// of 1e-12 C is none.
impl Default for Tolerance {
    fn default() -> Self {
        Self { relative: 1e-9, absolute: 0.0 }
    }
}

/// Tolerances by unit; `1` is that of pure numbers.
pub type Tolerances = BTreeMap<String, Tolerance>;

/// The unit as the key of its tolerance.
pub(super) fn key(unit: &str) -> &str {
    if unit.is_empty() { "1" } else { unit }
}

/// A tolerance for each unit of `columns`: that of `known`, else the default.
pub(super) fn tolerances(columns: &[Column], known: &Tolerances) -> Tolerances {
    let units: BTreeSet<&str> = columns.iter().map(|column| key(&column.unit)).collect();
    units.into_iter().map(|unit| (unit.to_owned(), known.get(unit).copied().unwrap_or_default())).collect()
}

/// What stands above the settings.
const HEAD: &str = "\
# A golden output: how it is run, what that takes, and how far a later run may be off. Its values are in the CSV file.
# Edit the tolerances as you like: `golden record` keeps them, and writes all else anew.
# A value may be off by `relative` times the largest value of its unit in the run, plus `absolute`, in that unit.
";

/// What NAME.toml says.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The name of the graph.
    pub model: String,
    /// The version of the workbench that recorded it.
    pub version: String,
    /// The commit that the model was from, where it was known.
    #[serde(default)]
    pub commit: Option<String>,
    /// The scene, by its name on the command line.
    pub scene: String,
    /// The inputs that are set, as `--input` takes them; files are seen from where the program is started.
    #[serde(default)]
    pub inputs: Vec<String>,
    /// The CRC-32 of the files that they name, by the inputs' names.
    #[serde(default)]
    pub input_files: BTreeMap<String, String>,
    /// How it is integrated.
    pub run: Integration,
    /// The parameters that are not at their defaults.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
    /// All parameters of the graph as they were then; a run follows the defaults of now.
    #[serde(default)]
    pub values: BTreeMap<String, Quantity>,
    /// What the run took.
    pub counts: Counts,
    /// How far its values may be off.
    pub tolerances: Tolerances,
}

impl Record {
    /// The text of NAME.toml. Numbers have the shortest form that reads back to the same bits.
    pub(super) fn text(&self) -> Result<String, toml::ser::Error> {
        let Self { model, version, commit, scene, inputs, input_files, run, parameters, values, counts, tolerances } =
            self;
        let Integration { t_end, step, method, hint, rtol, atol, fixed_step } = run;
        let mut text = format!("{HEAD}model = {model:?}\nversion = {version:?}\n");
        text += &commit.as_ref().map(|commit| format!("commit = {commit:?}\n")).unwrap_or_default();
        text += &format!("scene = {scene:?}\n");
        if !inputs.is_empty() {
            text += &format!("inputs = {inputs:?}\n");
        }
        text +=
            &format!("\n[run]\nt_end = {t_end:?}\nstep = {step:?}\nmethod = {:?}\nrtol = {rtol:?}\n", method.name());
        text += &hint.map(|hint| format!("hint = {:?}\n", hint.name())).unwrap_or_default();
        text += &atol.map(|atol| format!("atol = {atol:?}\n")).unwrap_or_default();
        text += &format!("fixed_step = {fixed_step:?}\n");
        if !input_files.is_empty() {
            text += "\n# The CRC-32 of the files of the inputs.\n[input_files]\n";
        }
        for (name, crc32) in input_files {
            text += &format!("{name} = {crc32:?}\n");
        }
        if !parameters.is_empty() {
            text += "\n[parameters]\n";
        }
        for (name, value) in parameters {
            text += &format!("{name} = {value:?}\n");
        }
        if !values.is_empty() {
            text += "\n# All parameters as they were. A later run has the defaults of its time, and those of \
                [parameters].\n\
                     [values]\n";
        }
        for (name, Quantity { value, unit }) in values {
            text += &format!("{name:?} = {{ value = {value:?}, unit = {unit:?} }}\n");
        }
        text += &format!("\n[counts]\n{}", toml::to_string(counts)?);
        for (unit, Tolerance { relative, absolute }) in tolerances {
            text += &format!("\n[tolerances.{unit:?}]\nrelative = {relative:?}\nabsolute = {absolute:?}\n");
        }
        Ok(text)
    }
}

/// A golden output.
#[derive(Clone, Debug, PartialEq)]
pub struct Golden {
    /// Where it is.
    pub files: Files,
    /// How it was run, and what that took.
    pub record: Record,
    /// Its trajectory; units are empty.
    pub samples: Recording,
}

/// Where the files of a golden output are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// The folder.
    pub folder: PathBuf,
    /// The name.
    pub name: String,
}

impl Files {
    /// NAME.toml in the folder.
    #[must_use]
    pub fn toml(&self) -> PathBuf {
        self.folder.join(format!("{}.toml", self.name))
    }

    /// NAME.csv in the folder.
    #[must_use]
    pub fn csv(&self) -> PathBuf {
        self.folder.join(format!("{}.csv", self.name))
    }

    /// What NAME.toml says of the model called `model`.
    ///
    /// # Errors
    /// A file that cannot be read, or is one of another model.
    pub fn record(&self, model: &str) -> Result<Record, GoldenError> {
        let path = self.toml();
        let text =
            fs::read_to_string(&path).map_err(|source| GoldenError::Unreadable { path: path.clone(), source })?;
        let record: Record = toml::from_str(&text).map_err(|fault| {
            let [line, column] = place_of(&fault, &text);
            GoldenError::Toml { path: path.clone(), line, column, message: one_line(fault.message()) }
        })?;
        if record.model != model {
            return Err(GoldenError::OtherModel { path, found: record.model, expected: model.to_owned() });
        }
        let is_none = |value: f64| !(value.is_finite() && value >= 0.0);
        let is_wrong = |(_, tolerance): &(_, &Tolerance)| is_none(tolerance.relative) || is_none(tolerance.absolute);
        match record.tolerances.iter().find(is_wrong) {
            Some((unit, _)) => Err(GoldenError::Tolerance { path, unit: unit.clone() }),
            None => Ok(record),
        }
    }

    /// The golden output of the model called `model`.
    ///
    /// # Errors
    /// As [`Files::record`]; a trajectory that cannot be read.
    pub fn read(self, model: &str) -> Result<Golden, GoldenError> {
        let record = self.record(model)?;
        let samples = samples::read_file(&self.csv())?;
        Ok(Golden { files: self, record, samples })
    }
}

/// The files of the golden outputs in `folder` by name: all of them, or those called `names`; empty where it has none.
///
/// # Errors
/// A folder that cannot be read, an unknown name.
pub fn list(folder: &Path, names: &[String]) -> Result<Vec<Files>, GoldenError> {
    let unreadable = |source| GoldenError::Unreadable { path: folder.to_owned(), source };
    let entries = match fs::read_dir(folder) {
        Err(fault) if fault.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(unreadable)?,
    };
    let mut recorded = BTreeSet::new();
    for entry in entries {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            recorded.extend(path.file_stem().and_then(|stem| stem.to_str()).map(str::to_owned));
        }
    }
    if recorded.is_empty() {
        return Ok(Vec::new());
    }
    if let Some(name) = names.iter().find(|name| !recorded.contains(*name)) {
        let known = recorded.into_iter().collect();
        return Err(GoldenError::Unknown { name: name.clone(), folder: folder.to_owned(), known });
    }
    let chosen = if names.is_empty() { recorded.into_iter().collect() } else { names.to_vec() };
    Ok(chosen.into_iter().map(|name| Files { folder: folder.to_owned(), name }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use bg_model::integrator::Integrator;
    use bg_model::statistics::Statistics;

    #[test]
    fn what_is_written_reads_back() {
        let run =
            Integration { t_end: 1.0, step: 0.1, method: Integrator::Rk4, fixed_step: 1e-5, ..Integration::default() };
        let counts = Counts::from(&Statistics { steps: 5, guard_evaluations: 7, ..Statistics::default() });
        let tolerance = Tolerance { relative: 1e-300, absolute: 2.0 };
        let tolerances = ["1", "N*m/rad", "kg*m^2"].map(|unit| (unit.to_owned(), tolerance));
        let values = [1e-7, 12_345_678_901_234_567_890.0, -0.0, 1.0 / 3.0].into_iter().enumerate();
        let record = Record {
            model: "Slide".to_owned(),
            version: "0.1.0".to_owned(),
            commit: Some("0123".to_owned()),
            scene: "fast".to_owned(),
            inputs: vec!["force=cubic:load.csv".to_owned()],
            input_files: [("force".to_owned(), "00c0ffee".to_owned())].into(),
            parameters: values.map(|(index, value)| (format!("p_{index}"), value)).collect(),
            values: [("wagon[0].k".to_owned(), Quantity { value: 0.1, unit: "N/m".to_owned() })].into(),
            run: run.clone(),
            counts,
            tolerances: tolerances.into(),
        };
        let without = Record {
            parameters: BTreeMap::new(),
            values: BTreeMap::new(),
            commit: None,
            run: Integration { atol: Some(1e-12), hint: Some(Integrator::Nystrom), ..run },
            ..record.clone()
        };
        for record in [record, without] {
            assert_eq!(toml::from_str(&record.text().unwrap()), Ok(record));
        }
    }

    #[test]
    fn a_unit_gets_the_tolerance_that_is_known_or_the_default() {
        let columns = ["m", "", "m"].map(|unit| Column::new("x", unit));
        let wide = Tolerance { relative: 0.5, absolute: 2.0 };
        let known = Tolerances::from([("1".to_owned(), wide), ("N".to_owned(), wide)]);
        let expected = [("1".to_owned(), wide), ("m".to_owned(), Tolerance::default())];
        assert_eq!(tolerances(&columns, &known), Tolerances::from(expected));
    }
}
