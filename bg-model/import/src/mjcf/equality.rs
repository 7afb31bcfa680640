//! `equality`: what closes loops, and joints that follow others.
//!
//! `connect` and `weld` hold what they find in the file's pose; the anchor of `connect` is in the first body's frame,
//! that of `weld` in the second's. `joint` makes joint1 a polynomial of joint2, both counted from the file's pose.

use super::Reader;
use crate::ImportError;
use crate::robot::{Coupling, Kind, Loop, Pose};
use crate::xml::Node;

/// Those of a file.
///
/// # Errors
/// Names that nothing has.
pub fn read(reader: &mut Reader, root: &Node) -> Result<(), ImportError> {
    for node in root.children("equality").flat_map(Node::all_children) {
        let is_active = node.word("active", &["true", "false"])? != Some("false");
        if !(is_active && reader.settings.equalities) {
            node.mark_deep();
            continue;
        }
        let kind = node.name.as_str();
        match kind {
            "connect" | "weld" if node.peek("body1").is_some() => closed(reader, node, kind == "weld")?,
            "joint" if node.peek("joint2").is_some() => coupled(reader, node)?,
            _ => {
                let name = node.attribute("name").map(|name| format!(" `{name}`")).unwrap_or_default();
                reader.robot.notes.push(format!("The equality{name} of the kind `{kind}` is left out."));
                node.mark_deep();
            }
        }
    }
    while let Some((index, what)) = crate::couple::impossible(&reader.robot.couplings, &reader.robot.joints) {
        reader.robot.couplings.remove(index);
        reader.robot.notes.push(format!("An equality is left out: {what}."));
    }
    Ok(())
}

fn closed(reader: &mut Reader, node: &Node, weld: bool) -> Result<(), ImportError> {
    let (first, second) = (node.needed("body1")?, node.attribute("body2").unwrap_or("world"));
    let find = |body: &str| {
        let unknown = || ImportError::Unknown { place: node.place.clone(), what: "body", name: body.to_owned() };
        reader.bodies.get(body).copied().ok_or_else(unknown)
    };
    let (one, other) = (find(first)?, find(second)?);
    let anchor = Pose::at(node.vector("anchor")?.unwrap_or_default());
    let across = |from: usize, to: usize| reader.places[to].inverse().then(&reader.places[from]);
    let ends =
        if weld { (across(other, one).then(&anchor), anchor) } else { (anchor, across(one, other).then(&anchor)) };
    let name = node.attribute("name").map_or_else(|| format!("{first}_{second}"), str::to_owned);
    if let Some(text) = node.attribute("relpose") {
        let [.., w, x, y, z] = node.array::<7>("relpose", text)?;
        if [w, x, y, z] != [0.0; 4] {
            reader.robot.notes.push(format!("Weld `{name}` holds the start pose, not its relpose."));
        }
    }
    let kind = if weld { Kind::Fixed } else { Kind::Spherical };
    reader.robot.loops.push(Loop { name, kind, ends: [(one, ends.0), (other, ends.1)] });
    Ok(())
}

fn coupled(reader: &mut Reader, node: &Node) -> Result<(), ImportError> {
    node.mark("name");
    let find = |attribute: &'static str| {
        let name = node.needed(attribute)?;
        let joint = reader.joint_of(node, name)?;
        let is_scalar = reader.robot.joints[joint].is_scalar();
        if is_scalar { Ok(joint) } else { Err(node.bad(attribute, name, "a hinge or a slide")) }
    };
    let (follower, leader) = (find("joint1")?, find("joint2")?);
    let mut polynomial = [0.0, 1.0, 0.0, 0.0, 0.0];
    if let Some(text) = node.attribute("polycoef") {
        let given = node.list("polycoef", text)?;
        if given.is_empty() || given.len() > 5 {
            return Err(node.bad("polycoef", text, "1 to 5 numbers"));
        }
        polynomial[..given.len()].copy_from_slice(&given);
    }
    reader.robot.couplings.push(Coupling { follower, leader, polynomial });
    Ok(())
}
