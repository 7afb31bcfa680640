//! A run recorded as a golden output.
//!
//! In: a run and how it was asked for. Out: its two files, each written whole. Tolerances that are there already stay.

use std::fmt::{self, Display, Formatter};
use std::fs;
use std::path::{Component, Path, PathBuf};

use bg_model::run::Trajectory;

use super::GoldenError;
use super::counts::Counts;
use super::file::{Files, Record, Tolerances, tolerances};
use super::{VERSION, size};
use crate::ask::inputs::Named;
use crate::ask::parameters::Values;
use crate::ask::request::Integration;
use crate::files::{FileError, check_is_no_file, whole};
use crate::run::recipe::{input_files, quantities};

/// A place for a golden output, which can be written.
#[derive(Debug)]
pub(crate) struct Destination {
    files: Files,
    model: &'static str,
    /// The tolerances that are there.
    known: Tolerances,
}

impl Destination {
    /// Claims NAME.toml and NAME.csv in `folder`, which is made if it is not there, for the model called `model`.
    pub fn claim(folder: &Path, name: &str, model: &'static str) -> Result<Self, GoldenError> {
        let mut components = Path::new(name).components();
        let is_plain = matches!((components.next(), components.next()), (Some(Component::Normal(_)), None));
        if !is_plain || name.starts_with('.') || name.contains(['/', '\\']) {
            return Err(GoldenError::Name(name.to_owned()));
        }
        let files = Files { folder: folder.to_owned(), name: name.to_owned() };
        let known = if files.toml().exists() {
            files.record(model)?.tolerances
        } else if files.csv().exists() {
            return Err(FileError::Foreign(files.csv()).into());
        } else {
            Tolerances::new()
        };
        check_is_no_file(folder)?;
        fs::create_dir_all(folder).map_err(|source| FileError::Write { path: folder.to_owned(), source })?;
        whole::probe(&files.toml())?;
        whole::probe(&files.csv())?;
        Ok(Self { files, model, known })
    }

    /// Writes `run`, which is what `scene`, of this commit, gives when it is integrated so with these inputs and
    /// parameters. Gives what is recorded.
    pub fn write(
        self,
        (scene, commit): (&str, Option<&str>),
        (inputs, named): (&[String], &[Named]),
        integration: Integration,
        parameters: &Values,
        run: &Trajectory,
    ) -> Result<Recorded, FileError> {
        let record = Record {
            model: self.model.to_owned(),
            version: VERSION.to_owned(),
            commit: commit.map(str::to_owned),
            scene: scene.to_owned(),
            inputs: inputs.to_vec(),
            input_files: input_files(named),
            run: integration,
            parameters: parameters.changed().map(|(info, value)| (info.name.to_owned(), value)).collect(),
            values: quantities(parameters),
            counts: Counts::from(&run.statistics),
            tolerances: tolerances(&run.columns, &self.known),
        };
        let (toml, csv) = (self.files.toml(), self.files.csv());
        // The settings first: a CSV file alone would be taken for one that is not ours.
        whole::write(&toml, |file| {
            let text = record.text().map_err(std::io::Error::other)?;
            file.write_all(text.as_bytes())
        })?;
        whole::write(&csv, |file| run.write_csv(file))?;
        Ok(Recorded { name: self.files.name, size: size(run), csv, toml })
    }
}

/// What is recorded; shown as a line.
#[derive(Debug)]
pub(crate) struct Recorded {
    name: String,
    /// Instants and columns, in words.
    size: String,
    csv: PathBuf,
    toml: PathBuf,
}

impl Recorded {
    /// The same for programs.
    pub fn json(&self) -> serde_json::Value {
        let Self { name, csv, toml, .. } = self;
        serde_json::json!({ "name": name, "csv": csv.display().to_string(), "toml": toml.display().to_string() })
    }
}

impl Display for Recorded {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, size, csv, toml } = self;
        write!(f, "{name}: recorded, {size}, in {} and {}", csv.display(), toml.display())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_that_cannot_be_one_is_told_with_what_to_do() {
        let root = tempfile::tempdir().unwrap();
        let file = root.path().join("file");
        fs::write(&file, "x").unwrap();
        let fault = |folder: &Path, name| Destination::claim(folder, name, "Slide").unwrap_err().to_string();
        let (shown, below) = (file.display(), file.join("below"));
        let expected = format!("cannot write into {}: {shown} is a file; choose a folder with --out", below.display());
        assert_eq!(fault(&below, "x"), expected);
        assert_eq!(fault(root.path(), "a/b"), "--name a/b: must be a plain file name, without a dot in front");
        fs::write(root.path().join("y.csv"), "t\n").unwrap();
        assert!(fault(root.path(), "y").contains("y.csv is no file of an earlier run: move it away"));
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 2);
    }
}
