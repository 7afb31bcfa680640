//! A text and its graphs.
//!
//! In: a text in the language of `bond_graph!`. Out: its graphs, or its faults; files are opened by who has them.

use std::path::PathBuf;

pub use bg_loaded::Counted;
use bg_loaded::{Fault, Graph, load_wanted, with_points};
use bg_workbench::scenes::in_small_letters;
use thiserror::Error;

/// Brackets in brackets: a text has some ten.
pub const DEEPEST: usize = 200;

/// A text with the path of its file.
#[derive(Clone, Debug)]
pub struct Text {
    /// The path, for messages; files that the text uses are sought from its folder.
    pub path: PathBuf,
    /// The text.
    pub text: String,
}

/// A table of a text with other points: those of a file, or rows of numbers in the units of the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// A file as `table .. = "FILE"` takes it: two columns, or with a row of second arguments.
    File(PathBuf),
    /// Rows of the same length: pairs, or a row of the second arguments and rows of a first one with its values.
    Rows(Vec<Vec<f64>>),
}

/// Other points that a text cannot have.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NoTable {
    /// There is no such table.
    #[error("there is no table `{name}`{}", listed(known))]
    Unknown {
        /// The name.
        name: String,
        /// The names of those that there are in the text itself.
        known: Vec<String>,
    },
    /// A number that is none.
    #[error("the table `{name}` has {value} in row {row}; give numbers that are finite")]
    NotFinite {
        /// The name.
        name: String,
        /// Its row, from 1 on.
        row: usize,
        /// The value.
        value: String,
    },
}

fn listed(known: &[String]) -> String {
    let names: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
    if names.is_empty() {
        "; the text has none of its own".to_owned()
    } else {
        format!("; there are {}", names.join(", "))
    }
}

impl Points {
    /// As they stand in a text.
    fn written(&self, name: &str) -> Result<String, NoTable> {
        let rows = match self {
            // The path may have any letter.
            Self::File(path) => return Ok(format!("{:?}", path.display().to_string())),
            Self::Rows(rows) => rows,
        };
        let not_finite = |(row, values): (usize, &Vec<f64>)| {
            let value = values.iter().find(|value| !value.is_finite())?;
            Some(NoTable::NotFinite { name: name.to_owned(), row: row + 1, value: value.to_string() })
        };
        match rows.iter().enumerate().find_map(not_finite) {
            Some(fault) => Err(fault),
            None => Ok(format!("{rows:?}")),
        }
    }
}

impl Text {
    /// The same where the table of this name has other points, as many as it may be. A table of a file that the text
    /// uses stays as it is.
    ///
    /// # Errors
    /// [`NoTable`].
    pub fn with_table(self, name: &str, points: &Points) -> Result<Self, NoTable> {
        let written = points.written(name)?;
        let unknown = |known| NoTable::Unknown { name: name.to_owned(), known };
        Ok(Self { text: with_points(&self.text, name, &written).map_err(unknown)?, ..self })
    }

    /// Whether brackets are in brackets more often than a reader follows.
    #[must_use]
    pub fn is_deep(&self) -> bool {
        let mut depth = 0_usize;
        self.text.chars().any(|c| {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth > DEEPEST
        })
    }
}

/// What is wanted of a text.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Where one scene alone is wanted beside the one that stands for the graph, its name on the command line.
    pub scene: Option<String>,
    /// Of what descriptions tell the operations: of all programs, unless only what runs is to be made.
    pub counted: Counted,
    /// The most statements of a graph with its repetitions and parts written out; none: 20000.
    pub most: Option<usize>,
}

impl Wanted {
    /// The same, as the compiler asks for it, handed to `load`.
    pub fn told<T>(&self, load: impl FnOnce(bg_loaded::Wanted<'_>) -> T) -> T {
        let Self { scene, counted, most } = self;
        let is_wanted = |name: &str| scene.as_ref().is_none_or(|scene| in_small_letters(name) == *scene);
        load(bg_loaded::Wanted { scene: &is_wanted, counted: *counted, most: *most })
    }
}

/// The graphs of a text that uses no files, on the stack of the caller.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn graphs_alone(text: &Text, wanted: &Wanted) -> Result<Vec<Graph>, Vec<Fault>> {
    wanted.told(|wanted| load_wanted(&text.text, wanted))
}
