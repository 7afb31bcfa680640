//! The files of a run: where they go, whether they can be written, and writing them.
//!
//! In: the command line's choice of places. Out: files. All places are tried before the run, so a long run is not lost to a
//! directory that cannot be written.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::figures::{FIGURES, FigureError};
use crate::overview;
use crate::summary::Summary;
use crate::trajectory::{Trajectory, TrajectoryError};

/// Where the files of a run go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// The CSV file.
    pub csv: PathBuf,
    /// The directory of figures, overview page and summary; `None` where only the CSV file is wanted.
    pub directory: Option<PathBuf>,
    /// Whether figures and the overview page are wanted.
    pub figures: bool,
}

/// A file that cannot be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The file system refuses.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file or directory.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The trajectory cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Trajectory {
        /// The file.
        path: PathBuf,
        /// Why.
        source: TrajectoryError,
    },
    /// A work-precision diagram cannot be drawn.
    #[error("diagram of {name}: {source}")]
    Diagram {
        /// Its case.
        name: String,
        /// Why.
        source: FigureError,
    },
    /// A figure cannot be drawn.
    #[error("figure {number}: {source}")]
    Figure {
        /// Its number.
        number: u8,
        /// Why.
        source: FigureError,
    },
}

impl Places {
    /// The places that the command line chooses: without `csv` the trajectory goes into `directory`; without figures and
    /// with `csv` nothing goes there.
    #[must_use]
    pub fn new(directory: &Path, csv: Option<&Path>, figures: bool) -> Self {
        Self {
            csv: csv.map_or_else(|| directory.join("trajectory.csv"), Path::to_owned),
            directory: (figures || csv.is_none()).then(|| directory.to_owned()),
            figures,
        }
    }

    fn page(directory: &Path) -> PathBuf {
        directory.join("index.html")
    }

    /// All files that will be written.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = vec![self.csv.clone()];
        if let Some(directory) = &self.directory {
            files.extend(["summary.txt", "summary.json"].map(|name| directory.join(name)));
            if self.figures {
                files.push(Self::page(directory));
                files.extend(FIGURES.iter().map(|figure| directory.join(figure.file_name())));
            }
        }
        files
    }

    /// Makes the directory and tries every file without changing one that is there.
    ///
    /// # Errors
    /// The first place that cannot be written.
    pub fn prepare(&self) -> Result<(), OutputError> {
        if let Some(directory) = &self.directory {
            fs::create_dir_all(directory).map_err(|source| OutputError::File { path: directory.clone(), source })?;
        }
        self.files()
            .into_iter()
            .try_for_each(|path| try_writing(&path).map_err(|source| OutputError::File { path, source }))
    }

    /// Writes the CSV file from `output` and everything else from `trajectory` and `summary`, whose list of files it fills.
    ///
    /// # Errors
    /// The first file that cannot be written.
    pub fn write(
        &self,
        output: &Trajectory,
        trajectory: &Trajectory,
        summary: &mut Summary,
    ) -> Result<(), OutputError> {
        summary.files = self.files();
        write_csv(&self.csv, output)?;
        let Some(directory) = &self.directory else { return Ok(()) };
        if self.figures {
            let mut drawn = Vec::new();
            // A run that failed before its first sample has nothing to draw.
            for figure in FIGURES.into_iter().filter(|_| !trajectory.times.is_empty()) {
                let svg = figure.draw(trajectory);
                let svg = svg.map_err(|source| OutputError::Figure { number: figure.number, source })?;
                write_text(&directory.join(figure.file_name()), &svg)?;
                drawn.push(figure);
            }
            let data = self.csv.strip_prefix(directory).ok().map(|path| path.display().to_string());
            write_text(&Self::page(directory), &overview::page(summary, &drawn, data.as_deref()))?;
        }
        write_text(&directory.join("summary.txt"), &summary.to_string())?;
        let json = serde_json::to_string_pretty(summary).expect("a summary has text keys only");
        write_text(&directory.join("summary.json"), &(json + "\n"))
    }
}

/// Opens a file for writing as the run will, and removes it if it was not there.
fn try_writing(path: &Path) -> io::Result<()> {
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Ok(_) => fs::remove_file(path),
        Err(fault) if fault.kind() == io::ErrorKind::AlreadyExists => {
            OpenOptions::new().write(true).open(path).map(|_| ())
        }
        Err(fault) => Err(fault),
    }
}

fn write_csv(path: &Path, trajectory: &Trajectory) -> Result<(), OutputError> {
    let fault = |source| OutputError::File { path: path.to_owned(), source };
    let mut file = BufWriter::new(File::create(path).map_err(fault)?);
    trajectory.write_csv(&mut file).map_err(|source| OutputError::Trajectory { path: path.to_owned(), source })?;
    file.flush().map_err(fault)
}

fn write_text(path: &Path, text: &str) -> Result<(), OutputError> {
    fs::write(path, text).map_err(|source| OutputError::File { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_follow_the_command_line() {
        let (out, csv) = (Path::new("out"), Path::new("run.csv"));
        assert_eq!(Places::new(out, None, true).files().len(), 20);
        assert_eq!(Places::new(out, None, true).csv, Path::new("out/trajectory.csv"));
        assert_eq!(Places::new(out, Some(csv), true).files()[0], csv);
        assert_eq!(Places::new(out, Some(csv), false).files(), [csv]);
        assert_eq!(Places::new(out, None, false).files().len(), 3);
    }

    #[test]
    fn preparing_changes_nothing_that_is_there() {
        let directory = tempfile::tempdir().unwrap();
        let places = Places::new(&directory.path().join("a/b"), None, true);
        places.prepare().unwrap();
        assert!(!places.csv.exists());
        fs::write(&places.csv, "before").unwrap();
        places.prepare().unwrap();
        assert_eq!(fs::read_to_string(&places.csv).unwrap(), "before");
    }

    #[test]
    fn a_place_that_cannot_be_written_is_named() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("file");
        fs::write(&file, "").unwrap();
        let fault = Places::new(&file, None, true).prepare().unwrap_err().to_string();
        assert!(fault.starts_with(&format!("cannot write {}: ", file.display())), "{fault}");
    }
}
