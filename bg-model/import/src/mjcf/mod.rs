//! MJCF to a robot: bodies, joints, inertias, and what closes loops.
//!
//! Bodies are nested; a body's `pos` and orientation are its frame in the parent, a joint's `pos` and `axis` are in the body's
//! frame. Of several joints of a body the first is the outermost; between two stands a link without mass. Where a body has no
//! `inertial`, its shapes give its mass. Source: MuJoCo's XML reference.

mod defaults;
mod orientation;

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};
use roxmltree::{Document, Node};

use crate::ImportError;
use crate::geometry::Shape;
use crate::robot::{Inertia, Joint, Kind, Link, Loop, Pose, Robot};
use crate::xml::{array, child, children, line, list, needed};
use defaults::{Defaults, Element};
use orientation::Angles;

/// Reads a robot.
///
/// # Errors
/// What is no MJCF, or has values that cannot be.
pub fn read(text: &str) -> Result<Robot, ImportError> {
    let document = Document::parse(text)?;
    let root = document.root_element();
    if !root.has_tag_name("mujoco") {
        let action = "give an MJCF file, or use `urdf` for a URDF";
        return Err(ImportError::WrongRoot { found: root.tag_name().name().to_owned(), wanted: "mujoco", action });
    }
    let expanded =
        |node: &Node| ["include", "frame", "replicate", "attach"].iter().any(|name| node.has_tag_name(*name));
    if let Some(node) = root.descendants().find(expanded) {
        let (element, action) =
            (node.tag_name().name().to_owned(), "save the model with MuJoCo (mj_saveLastXML), which writes it out");
        return Err(ImportError::NotExpanded { line: line(node), element, action });
    }
    let mut reader = Reader::new(root)?;
    let world = crate::xml::needed_child(root, "worldbody")?;
    for body in children(world, "body") {
        reader.body(body, 0, None)?;
    }
    reader.loops(root)?;
    reader.left_out(root);
    for node in children(root, "compiler") {
        if let Some(total) = crate::xml::number(node, "settotalmass")?.filter(|total| *total > 0.0) {
            reader.scale(total);
        }
    }
    Ok(reader.robot)
}

struct Reader<'a, 'i> {
    defaults: Defaults<'a, 'i>,
    angles: Angles,
    /// `inertiafromgeom="true"`: what is said of inertias is not used.
    only_shapes: bool,
    /// `autolimits`: a range alone is a limit.
    automatic_limits: bool,
    bodies: BTreeMap<String, usize>,
    /// The frame of each body in the ground, with all joints at 0.
    places: Vec<Pose>,
    robot: Robot,
}

impl<'a, 'i> Reader<'a, 'i> {
    fn new(root: Node<'a, 'i>) -> Result<Self, ImportError> {
        let compiler = children(root, "compiler").collect::<Vec<_>>();
        let setting = |name: &str| compiler.iter().filter_map(|node| node.attribute(name)).next_back();
        let gravity = child(root, "option").map(|option| crate::xml::vector(option, "gravity")).transpose()?.flatten();
        let mut notes = Vec::new();
        for (name, plain) in [("coordinate", "local"), ("balanceinertia", "false")] {
            if let Some(value) = setting(name).filter(|value| *value != plain) {
                notes.push(format!("The compiler's setting {name}=\"{value}\" is not used."));
            }
        }
        Ok(Self {
            defaults: Defaults::new(root),
            angles: Angles::new(setting("angle") != Some("radian"), setting("eulerseq").unwrap_or("xyz")),
            only_shapes: setting("inertiafromgeom") == Some("true"),
            automatic_limits: setting("autolimits") != Some("false"),
            bodies: BTreeMap::from([("world".to_owned(), 0)]),
            places: vec![Pose::identity()],
            robot: Robot {
                name: root.attribute("model").unwrap_or("robot").to_owned(),
                format: "MJCF",
                gravity: gravity.unwrap_or(Vector3::new(0.0, 0.0, -9.81)),
                links: vec![Link { name: "ground".to_owned(), inertia: None, merged: Vec::new() }],
                joints: Vec::new(),
                loops: Vec::new(),
                notes,
            },
        })
    }

    /// A body, its joints and what it carries; `class` is the one that a body above it gave.
    fn body(&mut self, node: Node<'a, 'i>, parent: usize, class: Option<&'a str>) -> Result<(), ImportError> {
        let class = node.attribute("childclass").or(class);
        let pose = self.angles.pose(&Element::plain(node))?;
        let inertia = self.inertia(node, class)?;
        let joints: Vec<Node> =
            node.children().filter(|child| child.has_tag_name("joint") || child.has_tag_name("freejoint")).collect();
        let count = self.robot.links.len();
        let name = node.attribute("name").map_or_else(|| format!("body{count}"), str::to_owned);
        let absolute = self.places[parent].then(&pose);
        let (mut from, mut frame) = (parent, pose);
        for (k, joint) in joints.iter().enumerate() {
            let to = if k + 1 == joints.len() { name.clone() } else { format!("{name}_carrier{}", k + 1) };
            let to = self.link(to, absolute);
            let element = self.defaults.element(*joint, class);
            self.joint(&element, &format!("{name}_joint{}", k + 1), (from, to), frame)?;
            (from, frame) = (to, Pose::identity());
        }
        if joints.is_empty() {
            from = self.link(name.clone(), absolute);
            self.robot.joints.push(Joint::new(&format!("{name}_mount"), Kind::Fixed, (parent, from), pose));
        }
        self.robot.links[from].inertia = inertia;
        if self.bodies.insert(name.clone(), from).is_some() {
            return Err(ImportError::Twice { line: line(node), what: "body", name });
        }
        for inner in children(node, "body") {
            self.body(inner, from, class)?;
        }
        Ok(())
    }

    fn link(&mut self, name: String, place: Pose) -> usize {
        self.robot.links.push(Link { name, inertia: None, merged: Vec::new() });
        self.places.push(place);
        self.robot.links.len() - 1
    }

    /// A joint at a frame of the parent that is the child's frame.
    fn joint(
        &mut self,
        element: &Element,
        unnamed: &str,
        ends: (usize, usize),
        frame: Pose,
    ) -> Result<(), ImportError> {
        let name = element.node.attribute("name").unwrap_or(unnamed);
        let kind =
            if element.node.has_tag_name("freejoint") { "free" } else { element.text("type").unwrap_or("hinge") };
        let kind = match kind {
            "free" => Kind::Free,
            "ball" => Kind::Spherical,
            "slide" => Kind::Prismatic,
            "hinge" => Kind::Revolute,
            other => return Err(crate::xml::bad(element.node, "type", other, "free, ball, slide or hinge")),
        };
        let anchor = Pose::at(element.vector("pos")?.filter(|_| kind != Kind::Free).unwrap_or_default());
        let mut joint = Joint { in_child: anchor, ..Joint::new(name, kind, ends, frame.then(&anchor)) };
        if joint.is_scalar() {
            let axis = element.vector("axis")?.unwrap_or(Vector3::z());
            let bad = || {
                crate::xml::bad(
                    element.node,
                    "axis",
                    &format!("{} {} {}", axis.x, axis.y, axis.z),
                    "a direction, not zero",
                )
            };
            joint.axis = axis.try_normalize(1e-12).ok_or_else(bad)?;
            let unit = if kind == Kind::Revolute { self.angles.unit } else { 1.0 };
            let reference = element.number("ref")?.unwrap_or(0.0) * unit;
            joint.damping = element.number("damping")?.unwrap_or(0.0);
            joint.friction = element.number("frictionloss")?.unwrap_or(0.0);
            joint.armature = element.number("armature")?.unwrap_or(0.0);
            let rest = element.number("springref")?.unwrap_or(0.0) * unit - reference;
            joint.spring =
                element.number("stiffness")?.filter(|stiffness| *stiffness != 0.0).map(|stiffness| (stiffness, rest));
            joint.limits = self.limits(element, unit, reference)?;
            if reference != 0.0 {
                let shift = crate::number::number(reference);
                self.robot
                    .notes
                    .push(format!("Joint `{name}` counts from its start: MuJoCo's value is larger by {shift}."));
            }
        } else if kind == Kind::Spherical {
            let settings = ["damping", "stiffness", "armature", "range", "frictionloss"];
            let is_set = |name: &&str| element.text(name).is_some_and(|value| value.trim().parse() != Ok(0.0));
            let lost: Vec<&str> = settings.into_iter().filter(is_set).collect();
            if !lost.is_empty() {
                self.robot.notes.push(format!("Ball joint `{name}` is without its {}.", lost.join(", ")));
            }
        }
        self.robot.joints.push(joint);
        Ok(())
    }

    fn limits(&self, element: &Element, unit: f64, reference: f64) -> Result<Option<(f64, f64)>, ImportError> {
        let is_limited = match element.text("limited") {
            Some("true") => true,
            Some("false") => false,
            _ => self.automatic_limits,
        };
        let Some(text) = element.text("range").filter(|_| is_limited) else { return Ok(None) };
        let [least, most] = array::<2>(element.node, "range", text)?;
        Ok((least < most).then_some((least * unit - reference, most * unit - reference)))
    }

    /// Of `inertial`, else of the shapes; none where there is neither.
    fn inertia(&mut self, body: Node<'a, 'i>, class: Option<&'a str>) -> Result<Option<Inertia>, ImportError> {
        if let Some(node) = child(body, "inertial").filter(|_| !self.only_shapes) {
            return self.given(node);
        }
        let mut sum: Option<Inertia> = None;
        for node in children(body, "geom") {
            let element = self.defaults.element(node, class);
            if let Some(inertia) = self.shape(&element)? {
                sum = Some(sum.map_or(inertia, |sum| sum.with(&inertia)));
            }
        }
        Ok(sum)
    }

    fn given(&self, node: Node<'a, 'i>) -> Result<Option<Inertia>, ImportError> {
        let [mass] = array::<1>(node, "mass", needed(node, "mass")?)?;
        let tensor = if let Some(text) = node.attribute("fullinertia") {
            let [xx, yy, zz, xy, xz, yz] = array::<6>(node, "fullinertia", text)?;
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        } else {
            Matrix3::from_diagonal(&Vector3::from(array::<3>(node, "diaginertia", needed(node, "diaginertia")?)?))
        };
        let frame = self.angles.pose(&Element::plain(node))?;
        Ok((mass > 0.0).then(|| Inertia { mass, center: Vector3::zeros(), tensor }.seen_from(&frame)))
    }

    fn shape(&mut self, element: &Element) -> Result<Option<Inertia>, ImportError> {
        let node = element.node;
        let sizes = element.text("size").map(|text| list(node, "size", text)).transpose()?.unwrap_or_default();
        let size = |k: usize| sizes.get(k).copied().unwrap_or(0.0);
        let ends = element.text("fromto").map(|text| array::<6>(node, "fromto", text)).transpose()?;
        let mut frame = self.angles.pose(element)?;
        let mut half = size(1);
        let mut sides = Vector3::new(size(0), size(1), size(2));
        if let Some([a, b, c, d, e, f]) = ends {
            let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
            half = (to - from).norm() / 2.0;
            sides = Vector3::new(size(0), size(0), half);
            frame = Pose { turned: orientation::with_z(&(from - to)), place: (from + to) / 2.0 };
        }
        let shape = match element.text("type").unwrap_or("sphere") {
            "sphere" => Shape::Ellipsoid(Vector3::repeat(size(0))),
            "ellipsoid" => Shape::Ellipsoid(sides),
            "box" => Shape::Cuboid(sides),
            "cylinder" => Shape::Cylinder(size(0), half),
            "capsule" => Shape::Capsule(size(0), half),
            "plane" | "hfield" => return Ok(None),
            other => {
                let name = node.attribute("name").map(|name| format!(" `{name}`")).unwrap_or_default();
                self.robot.notes.push(format!("Shape{name} is a {other}: its mass is not known and left out."));
                return Ok(None);
            }
        };
        let inertia = shape.inertia(element.number("mass")?, element.number("density")?.unwrap_or(1000.0));
        Ok(inertia.map(|inertia| inertia.seen_from(&frame)))
    }

    /// `connect` and `weld` of `equality`.
    fn loops(&mut self, root: Node<'a, 'i>) -> Result<(), ImportError> {
        for node in children(root, "equality").flat_map(|list| list.children()).filter(Node::is_element) {
            let (kind, name) = (node.tag_name().name(), node.attribute("name"));
            if !["connect", "weld"].contains(&kind) || node.attribute("body1").is_none() {
                let name = name.map(|name| format!(" `{name}`")).unwrap_or_default();
                self.robot.notes.push(format!("The equality{name} of the kind `{kind}` is left out."));
                continue;
            }
            let (first, second) = (needed(node, "body1")?, node.attribute("body2").unwrap_or("world"));
            let find = |body: &str| {
                let unknown = || ImportError::Unknown { line: line(node), what: "body", name: body.to_owned() };
                self.bodies.get(body).copied().ok_or_else(unknown)
            };
            let (one, other) = (find(first)?, find(second)?);
            let weld = kind == "weld";
            // The anchor of `connect` is in the first body's frame, that of `weld` in the second's.
            let anchor = Pose::at(crate::xml::vector(node, "anchor")?.unwrap_or_default());
            let across = |from: usize, to: usize| self.places[to].inverse().then(&self.places[from]);
            let ends = if weld {
                (across(other, one).then(&anchor), anchor)
            } else {
                (anchor, across(one, other).then(&anchor))
            };
            let name = name.map_or_else(|| format!("{first}_{second}"), str::to_owned);
            if node.attribute("relpose").is_some() {
                self.robot.notes.push(format!("Weld `{name}` holds the start pose, not its relpose."));
            }
            self.robot.loops.push(Loop { name, holds_rotation: weld, ends: [(one, ends.0), (other, ends.1)] });
        }
        Ok(())
    }

    /// Scales masses and moments so that the masses' sum is the one given.
    fn scale(&mut self, total: f64) {
        let sum: f64 = self.robot.links.iter().filter_map(|link| link.inertia).map(|inertia| inertia.mass).sum();
        for inertia in self.robot.links.iter_mut().filter_map(|link| link.inertia.as_mut()) {
            inertia.mass *= total / sum;
            inertia.tensor *= total / sum;
        }
    }

    fn left_out(&mut self, root: Node) {
        for (element, what) in [
            ("actuator", "The actuators are left out; each joint has an input of its own."),
            ("tendon", "The tendons are left out."),
            ("contact", "Contacts between bodies are left out."),
            ("sensor", "The sensors are left out."),
            ("keyframe", "The keyframes are left out."),
        ] {
            if children(root, element).any(|list| list.children().any(|node| node.is_element())) {
                self.robot.notes.push(what.to_owned());
            }
        }
        if element_count(root, "geom") > 0 {
            self.robot.notes.push("Shapes touch nothing: there is no contact with the floor.".to_owned());
        }
    }
}

fn element_count(root: Node, name: &str) -> usize {
    root.descendants().filter(|node| node.has_tag_name(name)).count()
}
