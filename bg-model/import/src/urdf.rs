//! URDF to a robot.
//!
//! A joint's `origin` is the child's frame in the parent, turned by roll, pitch, yaw about the fixed axes x, y, z; its
//! axis is given in the child's frame; an `inertial` has a frame of its own. Source: wiki.ros.org/urdf/XML.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::robot::{Coupling, Inertia, Joint, JointKind, Law, Link, Loop, Pose, Robot, with_z};
use crate::unread::{Rule, harmless, told, unless};
use crate::xml::{Node, unread};
use crate::{ImportError, Options};

/// What of a URDF may be left unused.
const RULES: [Rule; 14] = [
    harmless("visual", "", "seen only"),
    harmless("material", "", "seen only"),
    harmless("sensor", "", "it measures"),
    harmless("safety_controller", "", "bounds of a controller"),
    harmless("calibration", "", "where a sensor counts from"),
    harmless("robot", "name", "a name"),
    harmless("robot", "version", "of the format"),
    harmless("inertial", "name", "a name"),
    unless("limit", "effort", 0.0, "what drives a joint may give any effort; with --actuators it is limited"),
    unless("limit", "velocity", 0.0, "speeds are not limited"),
    told("mujoco", "", "what it changes for MuJoCo is not done"),
    told("constraint", "", "the loop that it closes is open"),
    told("limit", "*", "the joint is not limited by it"),
    told("mimic", "", "the joint moves on its own"),
];

/// Reads a robot. Its root link is the ground, or moves freely above it.
///
/// # Errors
/// What is no URDF, or has values that cannot be.
pub fn read(text: &str, options: Options) -> Result<Robot, ImportError> {
    let root = &Node::parse(text, None)?;
    if root.name != "robot" {
        let action = "give a URDF, or use `mjcf` for MuJoCo's XML";
        return Err(ImportError::WrongRoot { found: root.name.clone(), wanted: "robot", action });
    }
    if let Some(node) = root.descendants().into_iter().find(|node| node.name.starts_with("xacro:")) {
        let action = "run `xacro FILE` first and give its result".to_owned();
        return Err(ImportError::NotExpanded { place: node.place.clone(), element: node.name.clone(), action });
    }
    let mut reader = Reader { options, ..Reader::default() };
    reader.links(root)?;
    reader.joints(root)?;
    reader.mimics()?;
    reader.loops(root)?;
    reader.left_out(root);
    reader.notes.extend(crate::unread::notes(&unread(root), &RULES));
    reader.robot(root)
}

#[derive(Default)]
struct Reader<'n> {
    options: Options,
    links: Vec<Link>,
    index: BTreeMap<String, usize>,
    joints: Vec<Joint>,
    /// The element of each joint that mimics another one.
    mimics: Vec<(usize, &'n Node)>,
    couplings: Vec<Coupling>,
    loops: Vec<Loop>,
    notes: Vec<String>,
    remarks: Vec<String>,
}

impl<'n> Reader<'n> {
    fn links(&mut self, root: &'n Node) -> Result<(), ImportError> {
        for node in root.children("link") {
            let name = node.needed("name")?;
            let inertia = node.child("inertial").map(inertial).transpose()?.flatten();
            self.links.push(Link { inertia, ..Link::new(name) });
            if self.index.insert(name.to_owned(), self.links.len() - 1).is_some() {
                return Err(ImportError::Twice { place: node.place.clone(), what: "link", name: name.to_owned() });
            }
        }
        if self.links.is_empty() { Err(root.missing("link")) } else { Ok(()) }
    }

    fn joints(&mut self, root: &'n Node) -> Result<(), ImportError> {
        let mut names = BTreeSet::new();
        for node in root.children("joint") {
            let name = node.needed("name")?;
            if !names.insert(name) {
                return Err(ImportError::Twice { place: node.place.clone(), what: "joint", name: name.to_owned() });
            }
            self.joint(node, name)?;
        }
        Ok(())
    }

    fn joint(&mut self, node: &'n Node, name: &str) -> Result<(), ImportError> {
        let ends = (self.end(node, "parent")?, self.end(node, "child")?);
        let origin = origin(node)?;
        let word = node.needed("type")?;
        // What is about an axis is about nothing here.
        let about_axis: &[&str] = match word {
            "fixed" => &["axis", "limit", "safety_controller", "dynamics", "mimic"],
            "floating" => &["axis", "limit", "safety_controller"],
            _ => &[],
        };
        node.children.iter().filter(|child| about_axis.contains(&child.name.as_str())).for_each(Node::mark_deep);
        let kind = match word {
            "revolute" | "continuous" => JointKind::Revolute,
            "prismatic" => JointKind::Prismatic,
            "fixed" => JointKind::Fixed,
            "floating" => JointKind::Free,
            "planar" => return self.planar(name, ends, origin, &axis(node)?),
            other => {
                let wanted = "revolute, continuous, prismatic, fixed, floating or planar";
                return Err(node.bad("type", other, wanted));
            }
        };
        let mut joint = Joint::new(name, kind, ends, origin);
        if joint.is_scalar() {
            joint.axis = axis(node)?;
            if let Some(dynamics) = node.child("dynamics") {
                joint.damping = Law([dynamics.not_negative("damping")?, 0.0, 0.0]);
                joint.friction = dynamics.not_negative("friction")?;
            }
            if let Some(limit) = node.child("limit") {
                self.limits(limit, word, &mut joint)?;
            }
            self.rotor(node, &mut joint)?;
            self.mimics.extend(node.child("mimic").map(|mimic| (self.joints.len(), mimic)));
        }
        self.joints.push(joint);
        Ok(())
    }

    fn limits(&mut self, limit: &Node, kind: &str, joint: &mut Joint) -> Result<(), ImportError> {
        if self.options.actuators {
            joint.effort = limit.number("effort")?.filter(|effort| *effort > 0.0);
        }
        if kind == "continuous" {
            limit.mark("lower");
            limit.mark("upper");
            return Ok(());
        }
        let (least, most) = (end_of_range(limit, "lower")?, end_of_range(limit, "upper")?);
        let is_limited = least.is_finite() || most.is_finite();
        joint.limits = (least < most && is_limited).then_some((least, most));
        if least >= most {
            self.notes.push(format!("The limits of joint `{}` leave it no room: here it has no limits.", joint.name));
        }
        Ok(())
    }

    /// What Drake reads of a joint's motor.
    fn rotor(&mut self, node: &Node, joint: &mut Joint) -> Result<(), ImportError> {
        let value = |name: &'static str| node.child(name).map(|child| child.number("value")).transpose();
        let Some(rotor) = value("drake:rotor_inertia")?.flatten() else { return Ok(()) };
        let ratio = value("drake:gear_ratio")?.flatten().unwrap_or(1.0);
        joint.armature = rotor * ratio * ratio;
        self.notes.push(format!(
            "Joint `{}` has the inertia {} of its motor, drake:rotor_inertia times the square of drake:gear_ratio: \
             other programs than Drake leave it out.",
            joint.name,
            crate::number::number(joint.armature)
        ));
        Ok(())
    }

    /// Joints that follow others: multiplier times their angle, and an offset.
    fn mimics(&mut self) -> Result<(), ImportError> {
        let index: BTreeMap<&str, usize> =
            self.joints.iter().enumerate().map(|(index, joint)| (joint.name.as_str(), index)).collect();
        for &(follower, mimic) in &self.mimics {
            let other = mimic.needed("joint")?;
            let ratio = mimic.number("multiplier")?.unwrap_or(1.0);
            let offset = mimic.number("offset")?.unwrap_or(0.0);
            let Some(&leader) = index.get(other).filter(|&&leader| self.joints[leader].is_scalar()) else {
                let (place, name) = (&mimic.place, &self.joints[follower].name);
                let why = if index.contains_key(other) { "which has no angle or travel" } else { "which is not there" };
                self.notes
                    .push(format!("{place}: joint `{name}` does not mimic `{other}`, {why}: it moves on its own."));
                continue;
            };
            self.couplings.push(Coupling { follower, leader, polynomial: [offset, ratio, 0.0, 0.0, 0.0] });
        }
        let Some((index, what)) = crate::couple::impossible(&self.couplings, &self.joints) else { return Ok(()) };
        let follower = self.couplings[index].follower;
        let node = self.mimics.iter().find(|(joint, _)| *joint == follower).map(|(_, node)| &node.place);
        Err(ImportError::Wrong { place: node.cloned().unwrap_or(crate::xml::FilePlace { file: None, line: 1 }), what })
    }

    /// `loop_joint`: two links, a frame in each.
    fn loops(&mut self, root: &'n Node) -> Result<(), ImportError> {
        for node in root.children("loop_joint") {
            let name = node.needed("name")?;
            let kind = match node.needed("type")? {
                "fixed" => JointKind::Fixed,
                "revolute" | "continuous" => JointKind::Revolute,
                "prismatic" => JointKind::Prismatic,
                "spherical" | "ball" => JointKind::Spherical,
                other => {
                    return Err(node.bad("type", other, "fixed, revolute, continuous, prismatic, spherical or ball"));
                }
            };
            let end = |which: &'static str| {
                let end = node.needed_child(which)?;
                Ok::<_, ImportError>((self.link(end)?, frame(end)?))
            };
            let (first, second) = (end("link1")?, end("link2")?);
            let axes = if matches!(kind, JointKind::Revolute | JointKind::Prismatic) {
                with_z(&axis(node)?)
            } else {
                Matrix3::identity()
            };
            let ends = [first, second].map(|(link, pose)| (link, pose.with_axes(&axes)));
            self.loops.push(Loop { name: name.to_owned(), kind, ends });
        }
        Ok(())
    }

    /// Two translations across the axis and the rotation about it, with links between that have no mass.
    fn planar(
        &mut self,
        name: &str,
        (parent, child): (usize, usize),
        origin: Pose,
        axis: &Vector3<f64>,
    ) -> Result<(), ImportError> {
        let across = Vector3::ith(axis.iamin(), 1.0).cross(axis).normalize();
        let steps = [
            ("x", JointKind::Prismatic, across),
            ("y", JointKind::Prismatic, axis.cross(&across)),
            ("turn", JointKind::Revolute, *axis),
        ];
        let (mut from, mut frame) = (parent, origin);
        for (step, kind, axis) in steps {
            let step_name = format!("{name}_{step}");
            let to = if step == "turn" { child } else { self.between(&step_name) };
            self.joints.push(Joint { axis, ..Joint::new(&step_name, kind, (from, to), frame) });
            (from, frame) = (to, Pose::identity());
        }
        Ok(())
    }

    fn between(&mut self, joint: &str) -> usize {
        self.links.push(Link::new(&format!("{joint}_carrier")));
        self.links.len() - 1
    }

    fn end(&self, node: &Node, which: &'static str) -> Result<usize, ImportError> {
        self.link(node.needed_child(which)?)
    }

    /// The link that an element names.
    fn link(&self, node: &Node) -> Result<usize, ImportError> {
        let name = node.needed("link")?;
        let unknown = || ImportError::Unknown { place: node.place.clone(), what: "link", name: name.to_owned() };
        self.index.get(name).copied().ok_or_else(unknown)
    }

    fn left_out(&mut self, root: &Node) {
        for (element, what) in [("transmission", "transmissions"), ("gazebo", "settings for Gazebo")] {
            if root.children(element).inspect(|node| node.mark_deep()).count() > 0 {
                self.notes.push(format!("The {what} are left out."));
            }
        }
        let shapes = root.children("link").flat_map(|link| link.children("collision")).inspect(|node| node.mark_deep());
        if shapes.count() > 0 && self.options.contacts {
            self.notes.push(NO_CONTACT.to_owned());
        }
    }

    /// The links in the order of the tree, the ground first.
    fn robot(mut self, root: &Node) -> Result<Robot, ImportError> {
        let mut carried_by = BTreeMap::new();
        for joint in &self.joints {
            if carried_by.insert(joint.child, joint).is_some() {
                let name = &self.links[joint.child].name;
                return Err(ImportError::NoTree(format!("two joints carry link `{name}`")));
            }
        }
        let roots: Vec<usize> = (0..self.links.len()).filter(|link| !carried_by.contains_key(link)).collect();
        let [base] = roots[..] else {
            let names: Vec<String> = roots.iter().map(|&link| format!("`{}`", self.links[link].name)).collect();
            let found = if names.is_empty() {
                "no link is the root".to_owned()
            } else {
                format!("{} are roots", names.join(" and "))
            };
            return Err(ImportError::NoTree(found));
        };
        self.links.push(Link::new("ground"));
        let ground = self.links.len() - 1;
        let (kind, name) = if self.options.free_base { (JointKind::Free, "base") } else { (JointKind::Fixed, "base") };
        self.joints.push(Joint::new(name, kind, (ground, base), Pose::identity()));
        if !self.options.free_base
            && let Some(inertia) = &self.links[base].inertia
        {
            let (name, mass) = (&self.links[base].name, crate::number::number(inertia.mass));
            self.remarks.push(format!("Link `{name}` ({mass} kg) is part of the ground; with --free-base it moves."));
        }
        let name = root.attribute("name").unwrap_or("robot");
        let mut robot = Robot {
            links: self.links,
            joints: self.joints,
            loops: self.loops,
            couplings: self.couplings,
            notes: self.notes,
            remarks: self.remarks,
            ..Robot::new(name, "URDF")
        };
        crate::merge::in_order_of_the_tree(&mut robot, ground).map_err(ImportError::NoTree)?;
        Ok(robot)
    }
}

/// Said once of all shapes.
const NO_CONTACT: &str = "Shapes touch nothing: there is no contact (--no-contacts says that you know it).";

/// A joint's axis, in its frame.
fn axis(node: &Node) -> Result<Vector3<f64>, ImportError> {
    let axis = node.child("axis").map(|axis| axis.vector("xyz")).transpose()?.flatten().unwrap_or(Vector3::x());
    let text = || format!("{} {} {}", axis.x, axis.y, axis.z);
    let size = axis.amax();
    if size > 1e-12 { Ok((axis / size).normalize()) } else { Err(node.bad("axis", &text(), "a direction, not zero")) }
}

/// An `origin`; none is the same frame.
fn origin(node: &Node) -> Result<Pose, ImportError> {
    node.child("origin").map_or_else(|| Ok(Pose::identity()), frame)
}

/// A frame: `xyz` in m, `rpy` in rad about the fixed axes.
fn frame(node: &Node) -> Result<Pose, ImportError> {
    let place = node.vector("xyz")?.unwrap_or_default();
    let turned = node.vector("rpy")?.unwrap_or_default();
    // nalgebra's order is roll, pitch, yaw: Rz Ry Rx.
    Ok(Pose { place, turned: Rotation3::from_euler_angles(turned.x, turned.y, turned.z).into_inner() })
}

/// An end of a joint's range, which may be infinite; 0 when left out.
fn end_of_range(node: &Node, name: &str) -> Result<f64, ImportError> {
    let Some(text) = node.attribute(name) else { return Ok(0.0) };
    let value = text.trim().parse().ok().filter(|value: &f64| !value.is_nan());
    value.ok_or_else(|| node.bad(name, text, "a number"))
}

/// Mass and moments in the link's frame; none where there are neither.
fn inertial(node: &Node) -> Result<Option<Inertia>, ImportError> {
    let mass = node.needed_child("mass")?.not_negative("value")?;
    let frame = origin(node)?;
    let inertia = if mass > 0.0 { Some(node.needed_child("inertia")?) } else { node.child("inertia") };
    let mut values = [0.0; 6];
    for (value, name) in values.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]) {
        *value = inertia.map(|inertia| inertia.number(name)).transpose()?.flatten().unwrap_or(0.0);
    }
    let [xx, yy, zz, xy, xz, yz] = values;
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let is_something = mass > 0.0 || tensor != Matrix3::zeros();
    Ok(is_something.then(|| Inertia { mass, center: Vector3::zeros(), tensor }.seen_from(&frame)))
}
