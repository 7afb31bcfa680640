//! A text with the files that it uses, as data: what a machine without these files makes its models of.
//!
//! In: a file and what opens others, or JSON. Out: JSON, or the graphs of the text.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bg_compiler::source::syntax::files::{Open, Opened, gather};
use serde::{Deserialize, Serialize};

use crate::blueprint::Blueprint;
use crate::text::{Counted, Fault, Graph, Wanted, load_file, on_a_large_stack};

/// A file of a bundle.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct BundledFile {
    /// Its path from the folder of the text.
    path: PathBuf,
    /// Which file it is: that of the first path that leads to it.
    file: usize,
    /// What stands in it.
    text: String,
}

/// A text with the files that it uses.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bundle {
    /// The text itself, then the files that it uses.
    parts: Vec<BundledFile>,
}

impl Bundle {
    /// The text of the file at `path` with all files that it uses, each opened by `open`. Paths are written from the
    /// folder of the text.
    #[must_use]
    pub fn gathered(path: &Path, first: Opened, open: Open<'_>) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        let name = PathBuf::from(path.file_name().unwrap_or_default());
        let known = RefCell::new(vec![first.file.clone()]);
        let parts = RefCell::new(vec![BundledFile { path: name.clone(), file: 0, text: first.text.clone() }]);
        let recorded = |path: &Path| {
            let opened = open(&folder.join(path))?;
            let mut known = known.borrow_mut();
            let file = known.iter().position(|file| *file == opened.file).unwrap_or_else(|| {
                known.push(opened.file.clone());
                known.len() - 1
            });
            parts.borrow_mut().push(BundledFile { path: path.to_owned(), file, text: opened.text.clone() });
            Ok(opened)
        };
        drop(gather(&name, first, &recorded));
        Self { parts: parts.into_inner() }
    }

    /// The name of the text's file, without its ending; empty of a text of no file.
    #[must_use]
    pub fn name(&self) -> String {
        let stem = self.parts.first().and_then(|part| part.path.file_stem());
        stem.map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// The graphs of the text.
    ///
    /// # Errors
    /// As [`load`](crate::load).
    pub fn graphs(&self, wanted: Wanted<'_>) -> Result<Vec<Graph>, Vec<Fault>> {
        let opened = |part: &BundledFile| Opened { file: part.file.to_string().into(), text: part.text.clone() };
        let open = |path: &Path| {
            let part = self.parts.iter().skip(1).find(|part| part.path == path);
            part.map(opened).ok_or_else(|| format!("there is no {}", path.display()))
        };
        let Some(first) = self.parts.first() else { return Ok(Vec::new()) };
        load_file(&first.path, opened(first), &open, wanted)
    }
}

/// A model of a text, as data: what a unit has in its resources.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Chosen {
    /// The text.
    pub text: Bundle,
    /// The name of the graph.
    pub graph: String,
    /// The name of the model: that of the graph, or of a scene of it.
    pub model: String,
    /// The most statements of a graph with its repetitions and parts written out; none: 20000.
    pub most: Option<usize>,
}

impl Chosen {
    /// The name of the file in which a unit has it.
    pub const FILE: &str = "model.json";

    /// What the model is made of.
    ///
    /// # Errors
    /// A sentence: the text has faults, or no such model.
    ///
    /// # Panics
    /// The machine has no memory for a thread.
    pub fn blueprint(&self) -> Result<Arc<Blueprint>, String> {
        on_a_large_stack(|| self.compiled())
    }

    fn compiled(&self) -> Result<Arc<Blueprint>, String> {
        let wanted = Wanted { scene: &|name| name == self.model, counted: Counted::Made, most: self.most };
        let graphs = self.text.graphs(wanted).map_err(|faults| {
            let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
            faults.join("; ")
        })?;
        let graph = graphs.into_iter().find(|graph| graph.name == self.graph);
        let model = graph.and_then(|graph| graph.models.into_iter().find(|of| of.description.name == self.model));
        let blueprint = model.and_then(|model| model.blueprint);
        blueprint.ok_or_else(|| format!("the text has no model `{}` of a graph `{}`", self.model, self.graph))
    }
}
