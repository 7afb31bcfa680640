//! `include`: what other files hold, in its place.
//!
//! In: a tree and the folder of its file. Out: the tree with the children of each included file's root where its
//! `include` stood. Each file at most once, as MuJoCo has it; paths count from the folder of the first file.

use std::collections::BTreeSet;
use std::rc::Rc;

use crate::xml::Node;
use crate::{Folder, ImportError};

/// Puts included files in.
///
/// # Errors
/// A file that is not there, is no XML, or is included twice.
pub fn include(root: &mut Node, folder: Folder) -> Result<(), ImportError> {
    inside(root, folder, &mut BTreeSet::new())
}

fn inside(node: &mut Node, folder: Folder, known: &mut BTreeSet<String>) -> Result<(), ImportError> {
    let mut children = Vec::new();
    for mut child in std::mem::take(&mut node.children) {
        if child.name == "include" {
            children.extend(included(&child, folder, known)?);
        } else {
            inside(&mut child, folder, known)?;
            children.push(child);
        }
    }
    node.children = children;
    Ok(())
}

fn included(node: &Node, folder: Folder, known: &mut BTreeSet<String>) -> Result<Vec<Node>, ImportError> {
    let file = node.needed("file")?;
    let Some(folder) = folder else {
        let action = "import the file from its folder, where the included one is".to_owned();
        return Err(ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action });
    };
    if !known.insert(file.to_owned()) {
        return Err(ImportError::Twice { place: node.place.clone(), what: "include of", name: file.to_owned() });
    }
    let not_there = |fault: std::io::Error| {
        let action = format!("its file `{file}` cannot be read ({fault}): check the path");
        ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action }
    };
    let bytes = std::fs::read(folder.join(file)).map_err(not_there)?;
    let text = crate::encoding::text(&bytes)?;
    let label: Rc<str> = file.into();
    let mut root = Node::parse(&text, Some(&label))?;
    inside(&mut root, Some(folder), known)?;
    Ok(root.children)
}
