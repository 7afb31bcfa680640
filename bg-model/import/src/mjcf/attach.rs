//! `attach`: a body, a frame or all of another model, in a body of this one.
//!
//! In: a model's tree. Out: the tree with copies of other models' parts where their `attach` stood. All names in a copy
//! have the prefix. Tendons, equalities and actuators that name nothing but what is attached come along. A copy has
//! the classes, meshes and `compiler` of its model, not those around it; what a body's frame is inside of is left
//! behind. Source: MuJoCo's XML reference, `attach`; checked against MuJoCo 4.0.

use super::defaults::MAIN;
use super::expand::{Expanded, needed_folder};
use super::references::{SECTIONS, named, references, renamed};
use crate::xml::Node;
use crate::{Folder, ImportError};

/// What stays in an attached model's own tree: what it says of its elements.
pub const STAY: [&str; 5] = ["compiler", "option", "default", "asset", "extension"];

/// The models that a file names: name and index.
type Known = Vec<(String, usize)>;

/// Puts what other models have in the place of each `attach` of a model.
///
/// # Errors
/// A model, a body or a frame that is not there; a file that cannot be read.
pub fn attach(expanded: &mut Expanded, root: &mut Node, folder: Folder) -> Result<(), ImportError> {
    let has_any = |node: &Node| node.name == "worldbody" && node.descendants().iter().any(|node| node.name == "attach");
    if !root.children.iter().any(has_any) {
        return Ok(());
    }
    let mut known = Known::new();
    for asset in root.children.iter().filter(|node| node.name == "asset") {
        for node in asset.children.iter().filter(|node| node.name == "model") {
            let index = expanded.file(node, node.needed("file")?, needed_folder(node, folder, "attached")?)?;
            let own = expanded.models[index].root.peek("model");
            let name = node.peek("name").or(own).unwrap_or_default().to_owned();
            known.push((name, index));
        }
    }
    let mut sections = Vec::new();
    for world in root.children.iter_mut().filter(|node| node.name == "worldbody") {
        inside(expanded, world, &known, &mut sections)?;
    }
    root.children.extend(sections);
    Ok(())
}

fn inside(expanded: &Expanded, around: &mut Node, known: &Known, sections: &mut Vec<Node>) -> Result<(), ImportError> {
    for child in &mut around.children {
        if child.name == "attach" {
            *child = attached(expanded, child, known, sections)?;
        } else {
            inside(expanded, child, known, sections)?;
        }
    }
    Ok(())
}

/// What stands for an `attach`; the sections that come along are added to others.
fn attached(expanded: &Expanded, node: &Node, known: &Known, sections: &mut Vec<Node>) -> Result<Node, ImportError> {
    let prefix = node.needed("prefix")?;
    let Some(model) = node.peek("model") else {
        let action =
            "save the model with MuJoCo (mj_saveLastXML), which writes out what is attached to itself".to_owned();
        return Err(ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action });
    };
    let unknown = |what, name: &str| ImportError::Unknown { place: node.place.clone(), what, name: name.to_owned() };
    let (_, index) = known.iter().find(|(name, _)| name == model).ok_or_else(|| unknown("model", model))?;
    let other = &expanded.models[*index].root;
    let worlds = || other.children.iter().filter(|node| node.name == "worldbody");
    let whole = |name: &str| {
        let mut whole = other.beside(name);
        whole.children = worlds().flat_map(|world| world.children.iter().cloned()).collect();
        whole
    };
    let mut copy = match (node.peek("body"), node.peek("frame")) {
        (Some("world"), _) => {
            let mut body = whole("body");
            body.set("name", "world".to_owned());
            body
        }
        (Some(name), _) => {
            worlds().find_map(|world| found(world, None, "body", name)).ok_or_else(|| unknown("body", name))?
        }
        (None, Some(name)) => {
            worlds().find_map(|world| found(world, None, "frame", name)).ok_or_else(|| unknown("frame", name))?
        }
        (None, None) => whole("frame"),
    };
    if copy.peek("childclass").is_none() {
        copy.set("childclass", MAIN.to_owned());
    }
    let mut names = named(&copy)?;
    let change = |name: &str| format!("{prefix}{name}");
    for kind in SECTIONS {
        for section in other.children.iter().filter(|node| node.name == kind) {
            let mut along = section.beside(kind);
            for element in &section.children {
                if references(element).iter().all(|name| names.contains(name)) {
                    along.children.push(renamed(element, &names, &change));
                    if kind == "tendon" {
                        names.extend(element.peek("name").map(|name| ("tendon", name.to_owned())));
                    }
                }
            }
            sections.push(along);
        }
    }
    rename_all(&mut copy, &change);
    Ok(copy)
}

/// A copy of a body or frame of this name, with the class that those around it give it.
fn found(around: &Node, class: Option<&str>, kind: &str, name: &str) -> Option<Node> {
    let class = around.peek("childclass").or(class);
    around.children.iter().find_map(|child| {
        if child.name == kind && child.peek("name") == Some(name) {
            let mut copy = child.clone();
            if let (None, Some(class)) = (copy.peek("childclass"), class) {
                copy.set("childclass", class.to_owned());
            }
            return Some(copy);
        }
        found(child, class, kind, name)
    })
}

fn rename_all(node: &mut Node, change: &dyn Fn(&str) -> String) {
    if let Some(name) = node.peek("name").map(change) {
        node.set("name", name);
    }
    node.children.iter_mut().for_each(|child| rename_all(child, change));
}
