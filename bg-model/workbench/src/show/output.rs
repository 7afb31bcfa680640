//! The files of a run: which there are, where they go, and writing them.
//!
//! In: the command line's choice of places. Out: files. All places are claimed before the run, so a long run is not
//! lost to a directory that cannot be written. What goes wrong with one output does not keep the others back.

use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

use bg_model::simulation::Recording;

use crate::files::{FileError, RunFolder, whole};
use crate::run::summary::Summary;
use crate::show::extras::Page as Texts;
use crate::show::figures::{Figure, FigureError};
use crate::show::shown::{Exhibits, Page, PageFiles};

/// The names of the files beside the figures.
const CSV: &str = "trajectory.csv";
const TEXT: &str = "summary.txt";
const JSON: &str = "summary.json";

/// Where the files of a run go.
#[derive(Clone, Debug)]
pub struct Places {
    /// The CSV file, where it is not one of the folder's.
    pub csv: Option<PathBuf>,
    /// The folder of figures, page and summary; `None` where only the CSV file is wanted.
    pub folder: Option<PathBuf>,
    /// The figures that are wanted.
    pub figures: Vec<Figure>,
    /// The page, where one is wanted.
    pub page: Option<PageFiles>,
}

/// An output that fails.
#[derive(Debug, Error)]
pub enum OutputError {
    /// It does not reach its place.
    #[error(transparent)]
    File(#[from] FileError),
    /// The CSV file has the name of another file of the run.
    #[error("--csv {}: the run writes another file of this name; choose another", .0.display())]
    Clash(PathBuf),
    /// A work-precision diagram cannot be drawn.
    #[error("diagram of {name}: {source}")]
    Diagram {
        /// Its case.
        name: String,
        /// Why.
        source: FigureError,
    },
    /// A figure cannot be drawn.
    #[error("figure {file}: {source}")]
    Figure {
        /// Its file.
        file: String,
        /// Why.
        source: FigureError,
    },
}

impl Places {
    /// The places that the command line chooses: without `csv` the trajectory goes into `folder`; without a page and
    /// with `csv` nothing goes there.
    #[must_use]
    pub fn new(folder: &Path, csv: Option<&Path>, page: Option<PageFiles>, figures: Vec<Figure>) -> Self {
        Self {
            csv: csv.filter(|csv| *csv != folder.join(CSV)).map(Path::to_owned),
            folder: (page.is_some() || csv.is_none()).then(|| folder.to_owned()),
            figures,
            page,
        }
    }

    /// The names of the files that may go into the folder.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let csv = self.csv.is_none().then_some(CSV);
        let names = csv.into_iter().chain([TEXT, JSON]).map(str::to_owned);
        let of_page = self.page.iter().flat_map(|PageFiles { page, figures, glb }| {
            let figures = self.figures.iter().filter(|_| *figures).map(|figure| figure.file.clone());
            std::iter::once(page.clone()).chain(glb.clone()).chain(figures)
        });
        names.chain(of_page).collect()
    }

    /// Claims the folder and tries the CSV file, without changing what is there.
    ///
    /// # Errors
    /// The first place that cannot be written.
    pub fn claim(&self) -> Result<Claimed, OutputError> {
        let own = |path: &Path| self.folder.as_ref().is_some_and(|folder| path.starts_with(folder));
        if let Some(csv) = &self.csv {
            let names = self.names();
            let clash = |folder: &PathBuf| names.iter().any(|name| folder.join(name) == *csv);
            if self.folder.as_ref().is_some_and(clash) {
                return Err(OutputError::Clash(csv.clone()));
            }
        }
        // A file below the folder can be tried when the folder is there, any other before it is made.
        let (below, elsewhere): (Vec<_>, Vec<_>) = self.csv.iter().partition(|csv| own(csv));
        elsewhere.into_iter().try_for_each(|csv| whole::probe(csv))?;
        let folder = self.folder.as_ref().map(|folder| RunFolder::claim(folder, &self.names())).transpose()?;
        below.into_iter().try_for_each(|csv| whole::probe(csv))?;
        Ok(Claimed { places: self.clone(), folder })
    }
}

/// What a CSV file has.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a> {
    /// The samples.
    pub samples: &'a Recording,
    /// The columns after `t`; `None` for all.
    pub columns: Option<&'a [String]>,
}

impl Table<'_> {
    fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        match self.columns {
            Some(columns) => self.samples.write_columns(columns.iter().map(String::as_str), file),
            None => self.samples.write_csv(file),
        }
    }
}

/// Places that are this run's until it has written.
#[derive(Debug)]
pub struct Claimed {
    places: Places,
    folder: Option<RunFolder>,
}

/// What was written.
#[derive(Debug, Default)]
pub struct Written {
    /// The CSV file, where it is not in the folder.
    pub csv: Option<PathBuf>,
    /// The folder and the number of the run's files in it.
    pub folder: Option<(PathBuf, usize)>,
    /// The page in it that shows the run.
    pub page: Option<String>,
    /// What failed.
    pub faults: Vec<OutputError>,
}

impl Claimed {
    /// Writes the CSV file from `output` and everything else from `run` and `summary`, whose list of files it fills.
    /// `texts` are those of the page; `exhibits` is what it shows beside them.
    pub fn write(
        self,
        output: &Table<'_>,
        run: &Recording,
        texts: &Texts,
        exhibits: &Exhibits<'_>,
        summary: &mut Summary,
    ) -> Written {
        let mut written = Written::default();
        if let Some(csv) = &self.places.csv {
            match whole::write(csv, |file| output.write(file)) {
                Ok(()) => written.csv = Some(csv.clone()),
                Err(fault) => written.faults.push(fault.into()),
            }
        }
        let (Some(folder), Some(path)) = (self.folder, self.places.folder) else { return written };
        let own = self.places.csv.is_none().then_some(output);
        let mut figures = Vec::new();
        let has_files = self.places.page.as_ref().is_some_and(|page| page.figures);
        // A run that failed before its first sample has nothing to draw; the page has charts of the usual ones.
        let is_drawn = |figure: &Figure| !run.times.is_empty() && (has_files || exhibits.is_own(figure));
        for figure in self.places.figures.into_iter().filter(is_drawn) {
            match (figure.draw)(run) {
                Ok(svg) => figures.push((figure, svg)),
                // Its outputs are not among those that were chosen.
                Err(FigureError::Column(_)) => {}
                Err(source) => written.faults.push(OutputError::Figure { file: figure.file, source }),
            }
        }
        summary.files = written.csv.iter().cloned().collect();
        let rows = &output.samples.times;
        let page = self.places.page.as_ref().map(|files| Page { files, exhibits, texts, figures, run, rows });
        match fill(folder, &path, own, page.as_ref(), summary) {
            Ok(count) => {
                written.folder = Some((path, count));
                written.page = page.map(|page| page.name().to_owned());
            }
            Err(fault) => written.faults.push(fault.into()),
        }
        written
    }
}

/// Writes the files of the folder at `path` and gives their number: the CSV file where there is an `output` to write,
/// the page and what comes with it where there is one, and the summary.
fn fill(
    mut folder: RunFolder,
    path: &Path,
    output: Option<&Table<'_>>,
    page: Option<&Page<'_>>,
    summary: &mut Summary,
) -> Result<usize, FileError> {
    let more = page.map_or_else(Vec::new, Page::more);
    let names = output.map(|_| CSV).into_iter().chain([TEXT, JSON]).chain(page.map(Page::name)).map(str::to_owned);
    let names = names.chain(more.iter().map(|(name, _)| name.clone()));
    summary.files.extend(names.map(|name| path.join(name)));

    if let Some(output) = output {
        folder.write(CSV, |file| output.write(file))?;
    }
    for (name, bytes) in &more {
        folder.write(name, |file| file.write_all(bytes))?;
    }
    folder.write_text(TEXT, &summary.to_string())?;
    let json = serde_json::to_string_pretty(summary).expect("a summary has text keys only");
    folder.write_text(JSON, &(json + "\n"))?;
    if let Some(page) = page {
        folder.write_text(page.name(), &page.html(summary))?;
    }
    Ok(folder.publish()?.len())
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let csv = self.csv.as_ref().map(|csv| csv.display().to_string());
        let folder = self.folder.as_ref().map(|(folder, count)| format!("{count} files in {}", folder.display()));
        let both: Vec<String> = csv.into_iter().chain(folder).collect();
        f.write_str(if both.is_empty() { "nothing" } else { "" })?;
        f.write_str(&both.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures() -> Vec<Figure> {
        let figure = |file: &str| Figure {
            file: file.to_owned(),
            anchor: String::new(),
            title: String::new(),
            caption: String::new(),
            draw: std::sync::Arc::new(|_| Ok(String::new())),
        };
        ["a.svg", "b.svg"].map(figure).to_vec()
    }

    #[test]
    fn places_follow_the_command_line() {
        let (out, csv) = (Path::new("out"), Path::new("run.csv"));
        let page = || Some(PageFiles::of_run());
        assert_eq!(Places::new(out, None, page(), figures()).names().len(), 6);
        let both = Places::new(out, Some(csv), page(), figures());
        assert_eq!((both.csv.as_deref(), both.names().len()), (Some(csv), 5));
        let alone = Places::new(out, Some(csv), None, Vec::new());
        assert_eq!((alone.csv.as_deref(), alone.folder), (Some(csv), None));
        assert_eq!(Places::new(out, None, None, Vec::new()).names(), [CSV, TEXT, JSON]);
        let report = PageFiles { page: "p.html".to_owned(), figures: false, glb: Some("p.glb".to_owned()) };
        let report = Places::new(out, Some(csv), Some(report), figures());
        assert_eq!(
            (report.folder.as_deref(), report.names().join(" ").as_str()),
            (Some(out), "summary.txt summary.json p.html p.glb")
        );
        // The place that the trajectory has anyway.
        let usual = Places::new(out, Some(&out.join(CSV)), page(), figures());
        assert_eq!((usual.csv.as_deref(), usual.names().len()), (None, 6));
    }

    #[test]
    fn claiming_changes_nothing_that_can_be_seen() {
        let directory = tempfile::tempdir().unwrap();
        let places = Places::new(
            &directory.path().join("a/b"),
            Some(&directory.path().join("run.csv")),
            Some(PageFiles::of_run()),
            figures(),
        );
        drop(places.claim().unwrap());
        // Where it cannot be told whose lock there is, that stays.
        assert!(!cfg!(unix) || !directory.path().join("a/b").exists());
        assert!(!directory.path().join("run.csv").exists());
    }

    #[test]
    fn a_csv_file_does_not_take_the_name_of_another() {
        let directory = tempfile::tempdir().unwrap();
        let fault =
            Places::new(directory.path(), Some(&directory.path().join(JSON)), Some(PageFiles::of_run()), figures())
                .claim()
                .unwrap_err();
        assert!(matches!(fault, OutputError::Clash(_)));
    }

    #[test]
    fn what_was_written_is_said() {
        let written = |csv: Option<&str>, folder: Option<usize>| {
            let folder = folder.map(|count| (PathBuf::from("out"), count));
            Written { csv: csv.map(PathBuf::from), folder, ..Written::default() }.to_string()
        };
        assert_eq!(written(None, Some(20)), "20 files in out");
        assert_eq!(written(Some("run.csv"), Some(19)), "run.csv and 19 files in out");
        assert_eq!(written(Some("run.csv"), None), "run.csv");
        assert_eq!(written(None, None), "nothing");
    }
}
