//! A text and its graphs.
//!
//! In: a text in the language of `bond_graph!`. Out: its graphs, or its faults; files are opened by who has them.

use std::path::PathBuf;

use bg_loaded::{Counted, Fault, Graph, load_wanted};
use bg_workbench::scenes::in_small_letters;

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

impl Text {
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
    /// Where one scene alone is wanted beside the one that stands for the graph, its name on the command line; only
    /// what runs it is made.
    pub scene: Option<String>,
    /// The most statements of a graph with its repetitions and parts written out; none: 20000.
    pub most: Option<usize>,
}

impl Wanted {
    /// The same, as the compiler asks for it, handed to `load`.
    pub fn told<T>(&self, load: impl FnOnce(bg_loaded::Wanted<'_>) -> T) -> T {
        let Self { scene, most } = self;
        let counted = if scene.is_some() { Counted::Made } else { Counted::All };
        let is_wanted = |name: &str| scene.as_ref().is_none_or(|scene| in_small_letters(name) == *scene);
        load(bg_loaded::Wanted { scene: &is_wanted, counted, most: *most })
    }
}

/// The graphs of a text that uses no files, on the stack of the caller.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn graphs_alone(text: &Text, wanted: &Wanted) -> Result<Vec<Graph>, Vec<Fault>> {
    wanted.told(|wanted| load_wanted(&text.text, wanted))
}
