//! `actuator`: what drives joints by a control, and what it brings along.
//!
//! The force is gain u + bias of the control u, within the range of forces; both are affine in the length l = gear q
//! and in its speed. A joint gets gear times the force; of a fixed tendon each joint that times its coefficient. A
//! motor has the gain 1; `position` the gain kp and the bias -kp l - kv l'; `velocity` the gain kv and the bias -kv l';
//! a `damper` the gain -kv l'. A damping ratio is one of kp and the inertia that moves. What has a state of its own is
//! left out: the language has states of elements only, whose energy would count. Damping and armature are there
//! whether something is controlled or not. Source: MuJoCo's XML reference, `actuator`, and its chapter on computation;
//! checked against MuJoCo 4.0.

use std::cell::OnceCell;

use super::Reader;
use super::defaults::Element;
use super::moved::Moved;
use crate::ImportError;
use crate::robot::{Actuator, Length};
use crate::xml::Node;

/// What is read of an actuator, or why that is left out; or what is wrong with it.
type Read<T> = Result<Result<T, &'static str>, ImportError>;

/// Constant, for each unit of length, for each unit of its speed.
type Affine = [f64; 3];

/// Why one is left out.
const STATE: &str = "it has a state of its own";

/// Those of a file; of the others a note.
///
/// # Errors
/// Values that cannot be.
pub fn read(reader: &mut Reader, root: &Node) -> Result<(), ImportError> {
    let moved = OnceCell::new();
    for node in root.children("actuator").flat_map(Node::all_children) {
        let element = reader.scopes.element(node, None)?;
        let group = element.number("group")?.unwrap_or(0.0);
        if reader.settings.idle_groups.contains(&group) {
            node.mark_deep();
            continue;
        }
        match actuator(reader, &element, &moved)? {
            Ok(actuator) => reader.robot.actuators.push(actuator),
            Err(why) => {
                let name = node.attribute("name").map(|name| format!(" `{name}`")).unwrap_or_default();
                reader.robot.notes.push(format!("{}: the actuator{name} is left out: {why}.", node.place));
                node.mark_deep();
            }
        }
    }
    Ok(())
}

/// Damping and armature that actuators give their joints.
///
/// # Errors
/// Values that cannot be.
pub fn load_joints(reader: &mut Reader, root: &Node) -> Result<(), ImportError> {
    for node in root.children("actuator").flat_map(Node::all_children) {
        let element = reader.scopes.element(node, None)?;
        let (damping, armature) = (element.up_to::<3>("damping")?, element.not_negative("armature")?);
        if damping == [0.0; 3] && armature == 0.0 {
            continue;
        }
        let gear = gear(&element)?;
        let named = element.text("joint").or(element.text("jointinparent"));
        let index = named.map(|name| reader.joint_of(node, name)).transpose()?;
        let joints = &mut reader.robot.joints;
        let Some(joint) = index.map(|index| &mut joints[index]).filter(|joint| joint.is_scalar()) else {
            let what = "its damping and armature are left out: it acts on no hinge and no slide";
            reader.robot.notes.push(format!("{}: <{}>: {what}.", node.place, node.name));
            continue;
        };
        joint.armature += armature * gear * gear;
        if reader.settings.dampers {
            joint.damping.0.iter_mut().zip(damping).for_each(|(sum, own)| *sum += own * gear * gear);
        }
    }
    Ok(())
}

fn gear(element: &Element) -> Result<f64, ImportError> {
    first(element, "gear", 1.0)
}

/// The first number of an attribute.
fn first(element: &Element, name: &str, other: f64) -> Result<f64, ImportError> {
    let list = element.text(name).map(|text| element.node.list(name, text)).transpose()?;
    Ok(list.and_then(|list| list.first().copied()).unwrap_or(other))
}

/// The first three numbers of an attribute; those that are left out are 0.
fn three(element: &Element, name: &str) -> Result<Option<Affine>, ImportError> {
    let Some(text) = element.text(name) else { return Ok(None) };
    let list = element.node.list(name, text)?;
    Ok(Some([0, 1, 2].map(|k| list.get(k).copied().unwrap_or(0.0))))
}

/// An actuator, or why it is left out.
fn actuator(reader: &Reader, element: &Element, moved: &OnceCell<Moved>) -> Read<Actuator> {
    let node = element.node;
    let (gain, mut bias) = match law(element)? {
        Ok(law) => law,
        Err(why) => return Ok(Err(why)),
    };
    let (length, on) = match length(reader, element)? {
        Ok(length) => length,
        Err(why) => return Ok(Err(why)),
    };
    let length = length.times(gear(element)?);
    // A positive damping of a servo is a ratio.
    if gain[1..] == [0.0; 2] && bias[1] == -gain[0] && bias[2] > 0.0 {
        bias[2] *= -2.0 * (gain[0] * moved.get_or_init(|| Moved::new(reader)).along(&length)).sqrt();
    }
    let mut control = range(reader, element, "ctrllimited", "ctrlrange")?;
    if let ("position", inherited @ 1e-300..) = (node.name.as_str(), first(element, "inheritrange", 0.0)?) {
        let Some(range) = inherited_range(reader, &length, inherited) else {
            return Err(node.bad("inheritrange", &inherited.to_string(), "left out where its joint has no range"));
        };
        control = Some(range);
    }
    if node.name == "damper" && control.is_none_or(|(least, _)| least < 0.0) {
        return Err(node.bad("ctrlrange", element.text("ctrlrange").unwrap_or_default(), "a range from 0 or above"));
    }
    let control = control.filter(|_| reader.settings.clamps);
    let force = range(reader, element, "forcelimited", "forcerange")?;
    let name = node.attribute("name").map_or_else(|| format!("{on}_{}", node.name), str::to_owned);
    Ok(Ok(Actuator { name, length, gain, bias, control, force }))
}

/// Gain and bias, or why it is left out.
fn law(element: &Element) -> Read<(Affine, Affine)> {
    let node = element.node;
    Ok(Ok(match node.name.as_str() {
        "motor" => ([1.0, 0.0, 0.0], [0.0; 3]),
        "position" => {
            if first(element, "timeconst", 0.0)? != 0.0 {
                return Ok(Err(STATE));
            }
            let (kp, kv, ratio) =
                (first(element, "kp", 1.0)?, first(element, "kv", 0.0)?, first(element, "dampratio", 0.0)?);
            if kv != 0.0 && ratio != 0.0 {
                return Err(node.bad("dampratio", &ratio.to_string(), "left out where there is a `kv`"));
            }
            if ratio < 0.0 {
                return Err(node.bad("dampratio", &ratio.to_string(), "0 or more"));
            }
            ([kp, 0.0, 0.0], [0.0, -kp, if ratio > 0.0 { ratio } else { -kv }])
        }
        "velocity" => {
            let kv = first(element, "kv", 1.0)?;
            ([kv, 0.0, 0.0], [0.0, 0.0, -kv])
        }
        "damper" => ([0.0, 0.0, -first(element, "kv", 1.0)?], [0.0; 3]),
        "general" => {
            if element.text("dyntype").is_some_and(|kind| kind != "none") {
                return Ok(Err(STATE));
            }
            element.node.mark("dynprm");
            let gain = three(element, "gainprm")?.unwrap_or([1.0, 0.0, 0.0]);
            let gain = match element.text("gaintype") {
                None | Some("fixed") => [gain[0], 0.0, 0.0],
                Some("affine") => gain,
                Some(_) => return Ok(Err("its gain is neither fixed nor affine")),
            };
            let bias = three(element, "biasprm")?.unwrap_or_default();
            match element.text("biastype") {
                None | Some("none") => (gain, [0.0; 3]),
                Some("affine") => (gain, bias),
                Some(_) => return Ok(Err("its bias is not affine")),
            }
        }
        "intvelocity" | "cylinder" => return Ok(Err(STATE)),
        "muscle" => return Ok(Err("a muscle has a state of its own and a force by curves of its length and speed")),
        "adhesion" => return Ok(Err("it sticks to what shapes touch, and shapes touch nothing")),
        "pid" | "dcmotor" => {
            return Ok(Err("it is a controller or a motor with states of its own: write it in the graph"));
        }
        _ => return Ok(Err("it is of a kind that is not read")),
    }))
}

/// Along which length it pulls, before the gear, and what that is called; or why it is left out.
fn length<'e>(reader: &Reader, element: &Element<'e>) -> Read<(Length, &'e str)> {
    let node = element.node;
    if let Some(name) = element.text("tendon") {
        let unknown = || ImportError::Unknown { place: node.place.clone(), what: "tendon", name: name.to_owned() };
        let known = reader.tendons.get(name).ok_or_else(unknown)?;
        return Ok(known.clone().map(|length| (length, name)).ok_or("its tendon is no sum of joints"));
    }
    let Some(name) = element.text("joint").or(element.text("jointinparent")) else {
        return Ok(Err("it acts on no joint and no tendon"));
    };
    let joint = reader.joint_of(node, name)?;
    if !reader.robot.joints[joint].is_scalar() {
        return Ok(Err("its joint is no hinge and no slide"));
    }
    Ok(Ok((reader.length([(joint, 1.0)]), name)))
}

/// The range of a control that is a multiple of the range of the joint that it drives, whatever the gear.
fn inherited_range(reader: &Reader, length: &Length, times: f64) -> Option<(f64, f64)> {
    let [(joint, gear)] = length.parts[..] else { return None };
    let (least, most) = reader.ranges.get(&joint).copied()?;
    let (middle, half) = ((least + most) / 2.0 + length.constant / gear, times * (most - least) / 2.0);
    Some((middle - half, middle + half))
}

fn range(reader: &Reader, element: &Element, limited: &str, name: &str) -> Result<Option<(f64, f64)>, ImportError> {
    let node = element.node;
    let is_limited = element.truth(limited)?.unwrap_or(reader.scopes.of(node).compiler.automatic_limits);
    let Some(text) = element.text(name).filter(|_| is_limited) else {
        return Ok(None);
    };
    let [least, most] = node.array::<2>(name, text)?;
    if least < most { Ok(Some((least, most))) } else { Err(node.bad(name, text, "two numbers, the smaller one first")) }
}
