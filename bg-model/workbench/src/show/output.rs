//! The files of a run: which there are, where they go, and writing them.
//!
//! In: the command line's choice of places. Out: files. All places are claimed before the run, so a long run is not
//! lost to a directory that cannot be written. What goes wrong with one output does not keep the others back.

use std::fmt;
use std::path::{Path, PathBuf};

use thiserror::Error;

use bg_model::simulation::Recording;

use crate::files::{FileError, RunFolder, console, whole};
use crate::run::summary::Summary;
use crate::show::extras::Page as Texts;
use crate::show::figures::{Figure, FigureError};
use crate::show::shown::{Exhibits, Page, PageFiles};
use crate::show::trajectory::Form;

/// The names of the files beside the figures.
const CSV: &str = "trajectory.csv";
const TEXT: &str = "summary.txt";
const JSON: &str = "summary.json";

/// Where the files of a run go.
#[derive(Clone, Debug)]
pub struct Places {
    /// The trajectory's files that are not the folder's, each with its form; [`console::STANDARD`] is standard output.
    pub tables: Vec<(Form, PathBuf)>,
    /// What the trajectory in the folder is written as, where there is one.
    pub own: Option<Form>,
    /// The folder of figures, page and summary; `None` where only the trajectory is wanted.
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
    /// A file of the trajectory has the name of another file of the run.
    #[error("{}: the run writes another file of this name; choose another for the trajectory", .0.display())]
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
    /// The places that the command line chooses: without `tables` the trajectory goes into `folder` in the form `own`;
    /// with them and without a page nothing goes there.
    #[must_use]
    pub fn new(
        folder: &Path,
        tables: Vec<(Form, PathBuf)>,
        own: Form,
        page: Option<PageFiles>,
        figures: Vec<Figure>,
    ) -> Self {
        let has_folder = page.is_some() || tables.is_empty();
        let usual = (own, folder.join(CSV));
        let own = (tables.is_empty() || tables.contains(&usual)).then_some(own);
        let tables = tables.into_iter().filter(|table| *table != usual).collect();
        Self { tables, own, folder: (has_folder || own.is_some()).then(|| folder.to_owned()), figures, page }
    }

    /// The same without a trajectory in the folder.
    #[must_use]
    pub fn without_own_table(self) -> Self {
        Self { own: None, ..self }
    }

    /// The names of the files that may go into the folder.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let csv = self.own.map(|_| CSV);
        let names = csv.into_iter().chain([TEXT, JSON]).map(str::to_owned);
        let of_page = self.page.iter().flat_map(|PageFiles { page, figures, glb, .. }| {
            let figures = self.figures.iter().filter(|_| *figures).map(|figure| figure.file.clone());
            std::iter::once(page.clone()).chain(glb.clone()).chain(figures)
        });
        names.chain(of_page).collect()
    }

    /// Whether the trajectory goes to standard output.
    #[must_use]
    pub fn has_standard_output(&self) -> bool {
        self.tables.iter().any(|(_, path)| path.as_os_str() == console::STANDARD)
    }

    /// Claims the folder and tries the other files, without changing what is there.
    ///
    /// # Errors
    /// The first place that cannot be written.
    pub fn claim(&self) -> Result<Claimed, OutputError> {
        let own = |path: &Path| self.folder.as_ref().is_some_and(|folder| path.starts_with(folder));
        let names = self.names();
        for (index, (_, table)) in self.tables.iter().enumerate() {
            let is_twice = self.tables[..index].iter().any(|(_, other)| other == table);
            let clash = |folder: &PathBuf| names.iter().any(|name| folder.join(name) == *table);
            if is_twice || self.folder.as_ref().is_some_and(clash) {
                return Err(OutputError::Clash(table.clone()));
            }
        }
        // A file below the folder can be tried when the folder is there, any other before it is made.
        let (below, elsewhere): (Vec<_>, Vec<_>) = self.tables.iter().map(|(_, path)| path).partition(|path| own(path));
        elsewhere.into_iter().try_for_each(|path| whole::probe(path))?;
        let folder = self.folder.as_ref().map(|folder| RunFolder::claim(folder, &names)).transpose()?;
        below.into_iter().try_for_each(|path| whole::probe(path))?;
        Ok(Claimed { places: self.clone(), folder })
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
    /// The trajectory's files that are not in the folder.
    pub tables: Vec<PathBuf>,
    /// The folder and the number of the run's files in it.
    pub folder: Option<(PathBuf, usize)>,
    /// The page in it that shows the run.
    pub page: Option<String>,
    /// What failed.
    pub faults: Vec<OutputError>,
}

impl Claimed {
    /// Writes the trajectory, which is `output`, and everything else from `run` and `summary`, whose list of files it
    /// fills. `texts` are those of the page; `exhibits` is what it shows beside them.
    pub fn write(
        self,
        output: &Recording,
        run: &Recording,
        texts: &Texts,
        exhibits: &Exhibits<'_>,
        summary: &mut Summary,
    ) -> Written {
        let mut written = Written::default();
        for (form, path) in &self.places.tables {
            match whole::write(path, |file| form.write(output, file)) {
                Ok(()) if path.as_os_str() == console::STANDARD => {}
                Ok(()) => written.tables.push(path.clone()),
                Err(fault) => written.faults.push(fault.into()),
            }
        }
        let (Some(folder), Some(path)) = (self.folder, self.places.folder) else { return written };
        let own = self.places.own.map(|form| (form, output));
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
        summary.files = written.tables.clone();
        let rows = &output.times;
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

/// Writes the files of the folder at `path` and gives their number: the trajectory where there is an `output` to write,
/// the page and what comes with it where there is one, and the summary.
fn fill(
    mut folder: RunFolder,
    path: &Path,
    output: Option<(Form, &Recording)>,
    page: Option<&Page<'_>>,
    summary: &mut Summary,
) -> Result<usize, FileError> {
    let more = page.map_or_else(Vec::new, Page::more);
    let names = output.map(|_| CSV).into_iter().chain([TEXT, JSON]).chain(page.map(Page::name)).map(str::to_owned);
    let names = names.chain(more.iter().map(|(name, _)| name.clone()));
    summary.files.extend(names.map(|name| path.join(name)));

    if let Some((form, output)) = output {
        folder.write(CSV, |file| form.write(output, file))?;
    }
    for (name, bytes) in &more {
        folder.write(name, |file| file.write_all(bytes))?;
    }
    folder.write_text(TEXT, &summary.to_string())?;
    folder.write_text(JSON, &summary.json())?;
    if let Some(page) = page {
        folder.write_text(page.name(), &page.html(summary))?;
    }
    Ok(folder.publish()?.len())
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tables: Vec<String> = self.tables.iter().map(|path| path.display().to_string()).collect();
        let tables = (!tables.is_empty()).then(|| tables.join(", "));
        let folder = self.folder.as_ref().map(|(folder, count)| format!("{count} files in {}", folder.display()));
        let both: Vec<String> = tables.into_iter().chain(folder).collect();
        f.write_str(if both.is_empty() { "nothing" } else { "" })?;
        f.write_str(&both.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::show::shown::PageForm;

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
        let places = |tables: &[&Path], page, figures| {
            let tables = tables.iter().map(|path| (Form::Csv, path.to_path_buf())).collect();
            Places::new(out, tables, Form::Csv, page, figures)
        };
        let files = |places: &Places| places.tables.iter().map(|(_, path)| path.clone()).collect::<Vec<_>>();
        assert_eq!(places(&[], page(), figures()).names().len(), 6);
        let both = places(&[csv], page(), figures());
        assert_eq!((files(&both), both.names().len()), (vec![csv.to_owned()], 5));
        let alone = places(&[csv], None, Vec::new());
        assert_eq!((files(&alone), alone.folder), (vec![csv.to_owned()], None));
        assert_eq!(places(&[], None, Vec::new()).names(), [CSV, TEXT, JSON]);
        let form = PageForm::Whole;
        let report = PageFiles { page: "p.html".to_owned(), form, figures: false, glb: Some("p.glb".to_owned()) };
        let report = places(&[csv], Some(report), figures());
        assert_eq!(
            (report.folder.as_deref(), report.names().join(" ").as_str()),
            (Some(out), "summary.txt summary.json p.html p.glb")
        );
        assert_eq!(places(&[], page(), figures()).without_own_table().names().len(), 5);
        // The place that the trajectory has anyway.
        let usual = places(&[&out.join(CSV)], page(), figures());
        assert_eq!((files(&usual), usual.names().len()), (Vec::new(), 6));
        let more = places(&[&out.join(CSV), csv], None, Vec::new());
        assert_eq!((files(&more), more.names().len()), (vec![csv.to_owned()], 3));
    }

    #[test]
    fn claiming_changes_nothing_that_can_be_seen() {
        let directory = tempfile::tempdir().unwrap();
        let tables = vec![(Form::Npz, directory.path().join("run.csv"))];
        let page = Some(PageFiles::of_run());
        let places = Places::new(&directory.path().join("a/b"), tables, Form::Csv, page, figures());
        drop(places.claim().unwrap());
        // Where it cannot be told whose lock there is, that stays.
        assert!(!cfg!(unix) || !directory.path().join("a/b").exists());
        assert!(!directory.path().join("run.csv").exists());
    }

    #[test]
    fn a_trajectory_does_not_take_the_name_of_another_file() {
        let directory = tempfile::tempdir().unwrap();
        let [json, run] = [JSON, "run"].map(|name| directory.path().join(name));
        for tables in [vec![(Form::Csv, json)], vec![(Form::Csv, run.clone()), (Form::Npz, run)]] {
            let page = Some(PageFiles::of_run());
            let fault = Places::new(directory.path(), tables, Form::Csv, page, figures()).claim().unwrap_err();
            assert!(matches!(fault, OutputError::Clash(_)));
        }
    }

    #[test]
    fn what_was_written_is_said() {
        let written = |tables: &[&str], folder: Option<usize>| {
            let folder = folder.map(|count| (PathBuf::from("out"), count));
            let tables = tables.iter().map(PathBuf::from).collect();
            Written { tables, folder, ..Written::default() }.to_string()
        };
        assert_eq!(written(&[], Some(20)), "20 files in out");
        assert_eq!(written(&["run.csv", "run.npz"], Some(19)), "run.csv, run.npz and 19 files in out");
        assert_eq!(written(&["run.csv"], None), "run.csv");
        assert_eq!(written(&[], None), "nothing");
    }
}
