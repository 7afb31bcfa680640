//! URDF to a robot.
//!
//! A joint's `origin` is the child's frame in the parent, turned by roll, pitch, yaw about the fixed axes x, y, z; its axis is
//! given in the child's frame; an `inertial` has a frame of its own. Source: wiki.ros.org/urdf/XML.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Rotation3, Vector3};
use roxmltree::{Document, Node};

use crate::ImportError;
use crate::robot::{Inertia, Joint, Kind, Link, Pose, Robot};
use crate::xml::{child, children, line, needed, needed_child, number, vector};

/// Reads a robot. Its root link is the ground, or moves freely above it.
///
/// # Errors
/// What is no URDF, or has values that cannot be.
pub fn read(text: &str, free_base: bool) -> Result<Robot, ImportError> {
    let document = Document::parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("robot") {
        let action = "give a URDF, or use `mjcf` for MuJoCo's XML";
        return Err(ImportError::WrongRoot { found: root.tag_name().name().to_owned(), wanted: "robot", action });
    }
    let macros = |node: &Node| node.tag_name().namespace().is_some_and(|space| space.contains("xacro"));
    if let Some(node) = root.descendants().find(macros) {
        let (element, action) =
            (format!("xacro:{}", node.tag_name().name()), "run `xacro FILE` first and give its result");
        return Err(ImportError::NotExpanded { line: line(node), element, action });
    }
    let mut reader = Reader::default();
    reader.links(root)?;
    reader.joints(root)?;
    reader.left_out(root);
    reader.robot(root, free_base)
}

#[derive(Default)]
struct Reader {
    links: Vec<Link>,
    index: BTreeMap<String, usize>,
    joints: Vec<Joint>,
    notes: Vec<String>,
}

impl Reader {
    fn links(&mut self, root: Node) -> Result<(), ImportError> {
        for node in children(root, "link") {
            let name = needed(node, "name")?;
            let inertia = child(node, "inertial").map(inertial).transpose()?.flatten();
            self.links.push(Link { name: name.to_owned(), inertia, merged: Vec::new() });
            if self.index.insert(name.to_owned(), self.links.len() - 1).is_some() {
                return Err(ImportError::Twice { line: line(node), what: "link", name: name.to_owned() });
            }
        }
        if self.links.is_empty() { Err(crate::xml::missing(root, "link")) } else { Ok(()) }
    }

    fn joints(&mut self, root: Node) -> Result<(), ImportError> {
        let mut names = BTreeSet::new();
        for node in children(root, "joint") {
            let name = needed(node, "name")?;
            if !names.insert(name) {
                return Err(ImportError::Twice { line: line(node), what: "joint", name: name.to_owned() });
            }
            self.joint(node, name)?;
        }
        Ok(())
    }

    fn joint(&mut self, node: Node, name: &str) -> Result<(), ImportError> {
        let ends = (self.end(node, "parent")?, self.end(node, "child")?);
        let origin = origin(node)?;
        let axis = child(node, "axis").map(|axis| vector(axis, "xyz")).transpose()?.flatten().unwrap_or(Vector3::x());
        let unit = |axis: Vector3<f64>| {
            let text = || format!("{} {} {}", axis.x, axis.y, axis.z);
            axis.try_normalize(1e-12).ok_or_else(|| crate::xml::bad(node, "axis", &text(), "a direction, not zero"))
        };
        let kind = match needed(node, "type")? {
            "revolute" | "continuous" => Kind::Revolute,
            "prismatic" => Kind::Prismatic,
            "fixed" => Kind::Fixed,
            "floating" => Kind::Free,
            "planar" => return self.planar(name, ends, origin, &unit(axis)?),
            other => {
                let wanted = "revolute, continuous, prismatic, fixed, floating or planar";
                return Err(crate::xml::bad(node, "type", other, wanted));
            }
        };
        let mut joint = Joint::new(name, kind, ends, origin);
        if joint.is_scalar() {
            joint.axis = unit(axis)?;
            if let Some(dynamics) = child(node, "dynamics") {
                joint.damping = not_negative(dynamics, "damping")?;
                joint.friction = not_negative(dynamics, "friction")?;
            }
            if let Some(limit) = child(node, "limit").filter(|_| node.attribute("type") != Some("continuous")) {
                let ends = (number(limit, "lower")?.unwrap_or(0.0), number(limit, "upper")?.unwrap_or(0.0));
                joint.limits = (ends.0 < ends.1).then_some(ends);
                if joint.limits.is_none() {
                    self.notes.push(format!("The limits of joint `{name}` leave it no room: it has none here."));
                }
            }
        }
        if let Some(mimic) = child(node, "mimic") {
            let other = mimic.attribute("joint").unwrap_or("another joint");
            self.notes.push(format!("Joint `{name}` does not mimic `{other}`: it moves on its own."));
        }
        self.joints.push(joint);
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
            ("x", Kind::Prismatic, across),
            ("y", Kind::Prismatic, axis.cross(&across)),
            ("turn", Kind::Revolute, *axis),
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
        self.links.push(Link { name: format!("{joint}_carrier"), inertia: None, merged: Vec::new() });
        self.links.len() - 1
    }

    fn end(&self, node: Node, which: &'static str) -> Result<usize, ImportError> {
        let end = needed_child(node, which)?;
        let name = needed(end, "link")?;
        let unknown = || ImportError::Unknown { line: line(end), what: "link", name: name.to_owned() };
        self.index.get(name).copied().ok_or_else(unknown)
    }

    fn left_out(&mut self, root: Node) {
        for (element, what) in [("transmission", "transmissions"), ("gazebo", "settings for Gazebo")] {
            if children(root, element).next().is_some() {
                self.notes.push(format!("The {what} are left out."));
            }
        }
    }

    /// The links in the order of the tree, the ground first.
    fn robot(mut self, root: Node, free_base: bool) -> Result<Robot, ImportError> {
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
        let ground = Link { name: "ground".to_owned(), inertia: None, merged: Vec::new() };
        self.links.push(ground);
        let ground = self.links.len() - 1;
        let (kind, name) = if free_base { (Kind::Free, "base") } else { (Kind::Fixed, "base") };
        self.joints.push(Joint::new(name, kind, (ground, base), Pose::identity()));
        if !free_base && let Some(inertia) = &self.links[base].inertia {
            let (name, mass) = (&self.links[base].name, crate::number::number(inertia.mass));
            self.notes.push(format!("Link `{name}` ({mass} kg) is part of the ground; with --free-base it moves."));
        }
        let mut robot = Robot {
            name: root.attribute("name").unwrap_or("robot").to_owned(),
            format: "URDF",
            gravity: Vector3::new(0.0, 0.0, -9.81),
            links: self.links,
            joints: self.joints,
            loops: Vec::new(),
            notes: self.notes,
        };
        crate::merge::in_order_of_the_tree(&mut robot, ground).map_err(ImportError::NoTree)?;
        Ok(robot)
    }
}

/// An `origin`: `xyz` in m, `rpy` in rad about the fixed axes.
fn origin(node: Node) -> Result<Pose, ImportError> {
    let Some(origin) = child(node, "origin") else { return Ok(Pose::identity()) };
    let place = vector(origin, "xyz")?.unwrap_or_default();
    let turned = vector(origin, "rpy")?.unwrap_or_default();
    // nalgebra's order is roll, pitch, yaw: Rz Ry Rx.
    Ok(Pose { place, turned: Rotation3::from_euler_angles(turned.x, turned.y, turned.z).into_inner() })
}

/// Mass and moments in the link's frame; none where there is no mass.
fn inertial(node: Node) -> Result<Option<Inertia>, ImportError> {
    let mass = not_negative(needed_child(node, "mass")?, "value")?;
    if mass == 0.0 {
        return Ok(None);
    }
    let inertia = needed_child(node, "inertia")?;
    let mut values = [0.0; 6];
    for (value, name) in values.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]) {
        *value = number(inertia, name)?.unwrap_or(0.0);
    }
    let [xx, yy, zz, xy, xz, yz] = values;
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    Ok(Some(Inertia { mass, center: Vector3::zeros(), tensor }.seen_from(&origin(node)?)))
}

/// A number that is not negative; 0 when left out.
fn not_negative(node: Node, name: &str) -> Result<f64, ImportError> {
    let value = number(node, name)?.unwrap_or(0.0);
    if value < 0.0 { Err(crate::xml::bad(node, name, &value.to_string(), "0 or more")) } else { Ok(value) }
}
