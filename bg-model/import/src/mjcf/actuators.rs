//! `actuator`: motors, position and velocity servos on joints, and general ones of the same kind.
//!
//! The force is gain u + b0 + b1 l + b2 l' of the control u and the length l = gear q, within the range of forces; the
//! joint gets gear times it. A motor has the gain 1; `position` the gain kp and b1 = -kp, b2 = -kv; `velocity` the gain
//! kv and b2 = -kv. Source: MuJoCo's XML reference, `actuator`, and its chapter on computation.

use super::Reader;
use super::defaults::Element;
use crate::ImportError;
use crate::robot::Actuator;
use crate::xml::Node;

/// Those of a file; of the others a note.
///
/// # Errors
/// Values that cannot be.
pub fn read(reader: &mut Reader, root: &Node) -> Result<(), ImportError> {
    for node in root.children("actuator").flat_map(Node::all_children) {
        let element = reader.scopes.element(node, None)?;
        let known = node.attribute("name").map(str::to_owned);
        match actuator(reader, &element)? {
            Ok((joint, mut actuator)) => {
                let joint_name = &reader.robot.joints[joint].name;
                actuator.name = known.unwrap_or_else(|| format!("{joint_name}_{}", node.name));
                reader.robot.actuators.push(actuator);
            }
            Err(why) => {
                let name = known.map(|name| format!(" `{name}`")).unwrap_or_default();
                reader.robot.notes.push(format!("{}: the actuator{name} is left out: {why}.", node.place));
                node.mark_deep();
            }
        }
    }
    Ok(())
}

/// An actuator with its joint, or why it is left out.
fn actuator(reader: &Reader, element: &Element) -> Result<Result<(usize, Actuator), &'static str>, ImportError> {
    let node = element.node;
    let first = |name: &str, other: f64| {
        let list = element.text(name).map(|text| node.list(name, text)).transpose()?;
        Ok::<_, ImportError>(list.and_then(|list| list.first().copied()).unwrap_or(other))
    };
    let (gain, bias) = match node.name.as_str() {
        "motor" => (1.0, [0.0; 3]),
        "position" => {
            if element.text("timeconst").is_some() || element.text("dampratio").is_some() {
                return Ok(Err("its timeconst or dampratio is not done"));
            }
            let (kp, kv) = (first("kp", 1.0)?, first("kv", 0.0)?);
            (kp, [0.0, -kp, -kv])
        }
        "velocity" => {
            let kv = first("kv", 1.0)?;
            (kv, [0.0, 0.0, -kv])
        }
        "general" => {
            if element.text("dyntype").is_some_and(|kind| kind != "none") {
                return Ok(Err("it has a state of its own"));
            }
            if element.text("gaintype").is_some_and(|kind| kind != "fixed") {
                return Ok(Err("its gain is not fixed"));
            }
            let affine = match element.text("biastype") {
                None | Some("none") => false,
                Some("affine") => true,
                Some(_) => return Ok(Err("its bias is not affine")),
            };
            let terms = element.text("biasprm").map(|text| node.list("biasprm", text)).transpose()?.unwrap_or_default();
            let term = |k: usize| terms.get(k).copied().filter(|_| affine).unwrap_or(0.0);
            element.node.mark("dynprm");
            (first("gainprm", 1.0)?, [term(0), term(1), term(2)])
        }
        _ => return Ok(Err("only motor, position, velocity and general are read")),
    };
    let Some(joint) = element.text("joint") else { return Ok(Err("it does not act on a joint")) };
    let unknown = || ImportError::Unknown { place: node.place.clone(), what: "joint", name: joint.to_owned() };
    let joint = reader.joints.get(joint).copied().ok_or_else(unknown)?;
    if !reader.robot.joints[joint].is_scalar() {
        return Ok(Err("its joint is no hinge and no slide"));
    }
    let range = |limited: &str, name: &str| {
        let is_limited = element.truth(limited)?;
        let Some(text) =
            element.text(name).filter(|_| is_limited.unwrap_or(reader.scopes.of(node).compiler.automatic_limits))
        else {
            return Ok(None);
        };
        let [least, most] = node.array::<2>(name, text)?;
        if least < most {
            Ok(Some((least, most)))
        } else {
            Err(node.bad(name, text, "two numbers, the smaller one first"))
        }
    };
    let control = range("ctrllimited", "ctrlrange")?;
    let force = range("forcelimited", "forcerange")?;
    let shift = reader.references.get(&joint).copied().unwrap_or(0.0);
    let gear = first("gear", 1.0)?;
    Ok(Ok((joint, Actuator { name: String::new(), joint, gear, gain, bias, control, force, shift })))
}
