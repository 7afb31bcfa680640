//! `equality`: what closes loops, and joints that follow others.
//!
//! `connect` and `weld` hold what they find in the file's pose; the anchor of `connect` is in the first body's frame,
//! that of `weld` in the second's. `joint` makes joint1 a polynomial of joint2, both counted from the file's pose, and
//! `tendon` the length of tendon1 one of that of tendon2: where these are lengths of two joints, the one follows the
//! other.

use std::collections::BTreeMap;

use super::Reader;
use super::defaults::Element;
use crate::ImportError;
use crate::robot::{Coupling, JointKind, Length, Loop, Pose};
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
            "tendon" => tied(reader, node)?,
            _ => left_out(reader, node, ""),
        }
    }
    while let Some((index, what)) = crate::couple::impossible(&reader.robot.couplings, &reader.robot.joints) {
        reader.robot.couplings.remove(index);
        reader.robot.notes.push(format!("An equality is left out: {what}."));
    }
    Ok(())
}

fn left_out(reader: &mut Reader, node: &Node, why: &str) {
    let name = node.attribute("name").map(|name| format!(" `{name}`")).unwrap_or_default();
    reader.robot.notes.push(format!("The equality{name} of the kind `{}` is left out{why}.", node.name));
    node.mark_deep();
}

/// Two tendons, or one that keeps its length.
fn tied(reader: &mut Reader, node: &Node) -> Result<(), ImportError> {
    let find = |name: &str| {
        let unknown = || ImportError::Unknown { place: node.place.clone(), what: "tendon", name: name.to_owned() };
        reader.tendons.get(name).cloned().ok_or_else(unknown)
    };
    // What classes say of tendons is not of this one.
    let element = Element::plain(node);
    let own = find(node.needed("tendon1")?)?;
    let other = element.text("tendon2").map_or_else(|| Ok(Some(Length::default())), find)?;
    let (Some(own), Some(other)) = (own, other) else {
        left_out(reader, node, ": its tendon is no sum of joints");
        return Ok(());
    };
    node.mark("name");
    match ratio(&own, &other, polynomial(&element)?) {
        Some(coupling) => reader.robot.couplings.push(coupling),
        None => left_out(reader, node, ": two joints can follow each other here, and it ties other numbers of them"),
    }
    Ok(())
}

/// What `own = polynomial(other)` says of two joints; none where it is of one or of more.
fn ratio(own: &Length, other: &Length, polynomial: [f64; 5]) -> Option<Coupling> {
    if let ([(follower, each)], [(leader, factor)]) = (&own.parts[..], &other.parts[..])
        && follower != leader
    {
        let mut power = 1.0 / each;
        let scaled = polynomial.map(|coefficient| {
            let term = coefficient * power;
            power *= factor;
            term
        });
        return Some(Coupling { follower: *follower, leader: *leader, polynomial: scaled });
    }
    let [constant, first, curved @ ..] = polynomial;
    if curved != [0.0; 3] && !other.parts.is_empty() {
        return None;
    }
    let mut weights: BTreeMap<usize, f64> = own.parts.iter().copied().collect();
    for (joint, each) in &other.parts {
        *weights.entry(*joint).or_default() -= first * each;
    }
    weights.retain(|_, weight| *weight != 0.0);
    let [(&follower, each), (&leader, factor)] = weights.iter().collect::<Vec<_>>()[..] else { return None };
    Some(Coupling { follower, leader, polynomial: [constant / each, -factor / each, 0.0, 0.0, 0.0] })
}

/// Its coefficients, constant first.
fn polynomial(element: &Element) -> Result<[f64; 5], ImportError> {
    if element.text("polycoef").is_none() {
        return Ok([0.0, 1.0, 0.0, 0.0, 0.0]);
    }
    let mut polynomial = element.up_to::<5>("polycoef")?;
    let given = element.text("polycoef").unwrap_or_default().split_whitespace().count();
    if given == 1 {
        polynomial[1] = 1.0;
    }
    Ok(polynomial)
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
    let kind = if weld { JointKind::Fixed } else { JointKind::Spherical };
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
    let polynomial = polynomial(&Element::plain(node))?;
    reader.robot.couplings.push(Coupling { follower, leader, polynomial });
    Ok(())
}
