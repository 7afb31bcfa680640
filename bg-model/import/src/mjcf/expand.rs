//! What other files hold, in its place: `include` and `attach`; and what follows the copies of a `replicate`.
//!
//! In: a tree and the folder of its file. Out: the tree with the children of each included file's root where its
//! `include` stood, and with the parts of other models where their `attach` stood; of each attached model what it says
//! of its own elements. Each file is included at most once, as MuJoCo has it; paths count from the folder of the first
//! file of a model.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::{attach, references};
use crate::xml::Node;
use crate::{Folder, ImportError};

/// A model, with what it attaches in place.
pub struct Model {
    /// Its root.
    pub root: Node,
    /// The folder of its file.
    pub folder: Option<PathBuf>,
}

impl Model {
    /// Of a model that is attached: what counts in the first file only is not used, the rest is not looked at there.
    pub fn mark_what_does_not_count(&self) {
        for option in self.root.children("option") {
            option.children("flag").for_each(drop);
        }
        self.root.children("asset").flat_map(Node::all_children).for_each(Node::mark_deep);
    }
}

/// All models of a file.
pub struct Expanded {
    /// The file's own first, then those that it attaches.
    pub models: Vec<Model>,
    /// What is left out, a sentence each.
    pub notes: Vec<String>,
    /// The files that are being read.
    open: Vec<PathBuf>,
}

impl Expanded {
    /// The root of the file's own model, and the others.
    pub fn split(&self) -> (&Node, &[Model]) {
        (&self.models[0].root, &self.models[1..])
    }

    /// Reads a file of a model.
    ///
    /// # Errors
    /// It cannot be read, is no MJCF, or attaches itself.
    pub fn file(&mut self, node: &Node, file: &str, folder: &Path) -> Result<usize, ImportError> {
        let path = folder.join(file);
        let root = parsed(node, file, folder)?;
        if self.open.contains(&path) {
            let action = format!("`{file}` attaches itself: leave one of the two out");
            return Err(ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action });
        }
        self.open.push(path.clone());
        let index = self.model(root, path.parent())?;
        self.open.pop();
        Ok(index)
    }

    fn model(&mut self, mut root: Node, folder: Folder) -> Result<usize, ImportError> {
        let index = self.models.len();
        include(&mut root, folder, &mut BTreeSet::new())?;
        root.set_model(index);
        self.models.push(Model { root: root.beside("mujoco"), folder: folder.map(Path::to_owned) });
        attach::attach(self, &mut root, folder)?;
        self.notes.extend(references::follow_copies(&mut root)?);
        self.models[index].root = root;
        Ok(index)
    }
}

/// Puts other files in.
///
/// # Errors
/// A file that is not there, is no XML, or is included twice; what is attached and not there.
pub fn expand(root: Node, folder: Folder) -> Result<Expanded, ImportError> {
    let mut expanded = Expanded { models: Vec::new(), notes: Vec::new(), open: Vec::new() };
    expanded.model(root, folder)?;
    // Of an attached model all that moves is where it was attached.
    for model in &mut expanded.models[1..] {
        model.root.children.retain(|node| attach::STAY.contains(&node.name.as_str()));
    }
    Ok(expanded)
}

fn include(node: &mut Node, folder: Folder, known: &mut BTreeSet<String>) -> Result<(), ImportError> {
    let mut children = Vec::new();
    for mut child in std::mem::take(&mut node.children) {
        if child.name == "include" {
            children.extend(included(&child, folder, known)?);
        } else {
            include(&mut child, folder, known)?;
            children.push(child);
        }
    }
    node.children = children;
    Ok(())
}

fn included(node: &Node, folder: Folder, known: &mut BTreeSet<String>) -> Result<Vec<Node>, ImportError> {
    let file = node.needed("file")?;
    let folder = needed_folder(node, folder, "included")?;
    if !known.insert(file.to_owned()) {
        return Err(ImportError::Twice { place: node.place.clone(), what: "include of", name: file.to_owned() });
    }
    let mut root = parsed(node, file, folder)?;
    include(&mut root, Some(folder), known)?;
    Ok(root.children)
}

/// The folder from which an element's paths count.
///
/// # Errors
/// There is a text alone.
pub fn needed_folder<'f>(node: &Node, folder: Folder<'f>, what: &str) -> Result<&'f Path, ImportError> {
    folder.ok_or_else(|| {
        let action = format!("import the file from its folder, where the {what} one is");
        ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action }
    })
}

/// The root of a file that an element names.
fn parsed(node: &Node, file: &str, folder: &Path) -> Result<Node, ImportError> {
    let not_there = |fault: std::io::Error| {
        let action = format!("its file `{file}` cannot be read ({fault}): check the path");
        ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action }
    };
    let bytes = std::fs::read(folder.join(file)).map_err(not_there)?;
    let label: Rc<str> = file.into();
    Node::parse(&crate::encoding::text(&bytes)?, Some(&label))
}
