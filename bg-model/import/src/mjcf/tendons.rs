//! `tendon`: fixed ones, whose length is a sum of joints' values, each times a coefficient.
//!
//! A spring, a damper, dry friction and limits act along it. One that has none of these is only what actuators and
//! equalities name. A spatial tendon goes over sites and shapes, which is no such sum: it is left out. Source: MuJoCo's
//! XML reference, `tendon/fixed`; checked against MuJoCo 4.0.

use super::defaults::Element;
use super::{Reader, ends_of_range};
use crate::ImportError;
use crate::robot::{Law, Length, Spring, Tendon};
use crate::xml::Node;

/// Those of a file.
///
/// # Errors
/// Values that cannot be, joints that are not there.
pub fn read(reader: &mut Reader, root: &Node) -> Result<(), ImportError> {
    for node in root.children("tendon").flat_map(Node::all_children) {
        let given = node.attribute("name").map(str::to_owned);
        let name = given.clone().unwrap_or_else(|| format!("tendon{}", reader.robot.tendons.len() + 1));
        let length = if node.name == "fixed" {
            let element = reader.scopes.element(node, None)?;
            let tendon = tendon(reader, &element, &name)?;
            let length = tendon.length.clone();
            if tendon.acts() {
                reader.robot.tendons.push(tendon);
            }
            Some(length)
        } else {
            let what = "is left out: its length is no sum of joints' angles and travels";
            let shown = given.as_ref().map(|name| format!(" `{name}`")).unwrap_or_default();
            reader.robot.notes.push(format!("{}: the {} tendon{shown} {what}.", node.place, node.name));
            node.mark_deep();
            None
        };
        if let Some(name) = given
            && reader.tendons.insert(name.clone(), length).is_some()
        {
            return Err(ImportError::Twice { place: node.place.clone(), what: "tendon", name });
        }
    }
    Ok(())
}

fn tendon(reader: &mut Reader, element: &Element, name: &str) -> Result<Tendon, ImportError> {
    let node = element.node;
    let length = length(reader, node)?;
    let (stiffness, damping) = (Law(element.up_to("stiffness")?), Law(element.up_to("damping")?));
    let friction = element.not_negative("frictionloss")?;
    let [least, most] = match element.text("springlength").map(|text| node.list("springlength", text)).transpose()? {
        None => [0.0; 2],
        Some(given) => match given[..] {
            [-1.0] => [0.0; 2],
            [rest] => [rest - length.constant; 2],
            [least, most] if least <= most => [least - length.constant, most - length.constant],
            _ => {
                let text = element.text("springlength").unwrap_or_default();
                return Err(node.bad("springlength", text, "one length, or two with the smaller one first"));
            }
        },
    };
    let mut slack = most - least;
    if slack > 0.0 && !stiffness.is_linear() {
        let what = "the spring is loose at one length alone, since its stiffness is no number";
        reader.robot.notes.push(format!("{}: tendon `{name}`: {what}.", node.place));
        slack = 0.0;
    }
    let spring =
        Some(Spring { law: stiffness, rest: least }).filter(|_| reader.settings.springs && !stiffness.is_zero());
    let limits = limits(reader, element)?.map(|(least, most)| (least - length.constant, most - length.constant));
    Ok(Tendon {
        name: name.to_owned(),
        spring,
        slack,
        damping: if reader.settings.dampers { damping } else { Law::default() },
        friction: if reader.settings.friction { friction } else { 0.0 },
        limits: limits.filter(|_| reader.settings.limits),
        length,
    })
}

fn length(reader: &Reader, node: &Node) -> Result<Length, ImportError> {
    let mut parts: Vec<(usize, f64)> = Vec::new();
    for part in node.children("joint") {
        let name = part.needed("joint")?;
        let joint = reader.joint_of(part, name)?;
        let each = part.number("coef")?.ok_or_else(|| part.missing("coef"))?;
        if !reader.robot.joints[joint].is_scalar() {
            return Err(part.bad("joint", name, "a hinge or a slide"));
        }
        if parts.iter().any(|(known, _)| *known == joint) {
            return Err(ImportError::Twice {
                place: part.place.clone(),
                what: "part with joint",
                name: name.to_owned(),
            });
        }
        parts.push((joint, each));
    }
    if parts.is_empty() {
        return Err(node.missing("joint"));
    }
    Ok(reader.length(parts.into_iter().filter(|(_, each)| *each != 0.0)))
}

fn limits(reader: &Reader, element: &Element) -> Result<Option<(f64, f64)>, ImportError> {
    let is_limited = element.truth("limited")?.unwrap_or(reader.scopes.of(element.node).compiler.automatic_limits);
    let Some(text) = element.text("range").filter(|_| is_limited) else { return Ok(None) };
    let [least, most] = ends_of_range(element.node, text)?;
    Ok((least < most && (least.is_finite() || most.is_finite())).then_some((least, most)))
}
