//! Which elements of `tendon`, `equality` and `actuator` name which things of the tree, and how they follow where
//! those get other names: copies of a `replicate` have endings, what is attached has a prefix.
//!
//! Elements with a name from inside of a `replicate` are there once for each copy. An equality that names something
//! outside as well is left out. Source: MuJoCo's XML reference, `replicate` and `attach`; checked against MuJoCo 4.0.

use std::collections::BTreeSet;

use super::contents::endings;
use crate::ImportError;
use crate::xml::Node;

/// Sections whose elements name things of the tree; those of tendons before those that name tendons.
pub const SECTIONS: [&str; 3] = ["tendon", "equality", "actuator"];

/// What kind of thing has a name, and the name.
pub type Name = (&'static str, String);

/// What kind of thing an attribute of a section names.
fn kind(attribute: &str) -> Option<&'static str> {
    Some(match attribute {
        "joint" | "joint1" | "joint2" | "jointinparent" => "joint",
        "body" | "body1" | "body2" => "body",
        "site" | "site1" | "site2" | "refsite" | "cranksite" | "slidersite" | "sidesite" => "site",
        "geom" => "geom",
        "tendon" | "tendon1" | "tendon2" => "tendon",
        _ => return None,
    })
}

/// What has a name inside of an element of the tree, its copies too, and the element itself.
///
/// # Errors
/// A `replicate` that does not say how many copies there are.
pub fn named(node: &Node) -> Result<BTreeSet<Name>, ImportError> {
    let mut names = named_inside(node)?;
    if node.name == "replicate" {
        let endings = endings(node)?;
        let copies = |(kind, name): Name| endings.iter().map(move |ending| (kind, format!("{name}{ending}")));
        return Ok(names.into_iter().flat_map(copies).collect());
    }
    let kind = match node.name.as_str() {
        "joint" | "freejoint" => "joint",
        "body" => "body",
        "site" => "site",
        "geom" => "geom",
        _ => return Ok(names),
    };
    names.extend(node.peek("name").map(|name| (kind, name.to_owned())));
    Ok(names)
}

fn named_inside(node: &Node) -> Result<BTreeSet<Name>, ImportError> {
    let mut names = BTreeSet::new();
    for child in &node.children {
        names.extend(named(child)?);
    }
    Ok(names)
}

/// What an element of a section, and those inside of it, name; the world is always there.
pub fn references(node: &Node) -> Vec<Name> {
    let own = node.attributes().filter_map(|(attribute, name)| Some((kind(attribute)?, name.to_owned())));
    let own = own.filter(|name| *name != ("body", "world".to_owned()));
    own.chain(node.children.iter().flat_map(references)).collect()
}

/// An element of a section with another name for itself and for those of the names that it uses.
pub fn renamed(node: &Node, names: &BTreeSet<Name>, change: &dyn Fn(&str) -> String) -> Node {
    let mut renamed = node.clone();
    rename(&mut renamed, names, change);
    if let Some(name) = node.peek("name") {
        renamed.set("name", change(name));
    }
    renamed
}

fn rename(node: &mut Node, names: &BTreeSet<Name>, change: &dyn Fn(&str) -> String) {
    let is_used = |(attribute, name): &(&str, &str)| {
        kind(attribute).is_some_and(|kind| names.contains(&(kind, (*name).to_owned())))
    };
    let changed: Vec<(String, String)> =
        node.attributes().filter(is_used).map(|(attribute, name)| (attribute.to_owned(), change(name))).collect();
    changed.into_iter().for_each(|(attribute, name)| node.set(&attribute, name));
    node.children.iter_mut().for_each(|child| rename(child, names, change));
}

/// Lets the elements of sections follow the copies of what they name; gives a note for each that cannot.
///
/// # Errors
/// A `replicate` that does not say how many copies there are.
pub fn follow_copies(root: &mut Node) -> Result<Vec<String>, ImportError> {
    let mut copied = Vec::new();
    for world in root.children.iter().filter(|node| node.name == "worldbody") {
        collect(world, &mut copied)?;
    }
    let mut notes = Vec::new();
    for (mut names, endings) in copied {
        for kind in SECTIONS {
            for section in root.children.iter_mut().filter(|node| node.name == kind) {
                for node in std::mem::take(&mut section.children) {
                    let used = references(&node);
                    let inside = used.iter().filter(|name| names.contains(name)).count();
                    if inside == 0 {
                        section.children.push(node);
                    } else if kind == "equality" && inside < used.len() {
                        let what = "names copies and something that is none: it is left out, as by MuJoCo";
                        notes.push(format!("{}: <{}> of <equality> {what}.", node.place, node.name));
                    } else {
                        let copy = |ending: &String| renamed(&node, &names, &|name| format!("{name}{ending}"));
                        section.children.extend(endings.iter().map(copy));
                        if kind == "tendon" {
                            names.extend(node.peek("name").map(|name| ("tendon", name.to_owned())));
                        }
                    }
                }
            }
        }
    }
    Ok(notes)
}

/// The names inside of each `replicate` and the endings of its copies, inner ones first.
fn collect(node: &Node, copied: &mut Vec<(BTreeSet<Name>, Vec<String>)>) -> Result<(), ImportError> {
    for child in &node.children {
        collect(child, copied)?;
    }
    if node.name == "replicate" {
        copied.push((named_inside(node)?, endings(node)?));
    }
    Ok(())
}
