//! A robot to a Rust file with one `bond_graph!`, as a person would write it.
//!
//! In: a robot whose links all have masses. Out: a head comment, parameters, inputs, bodies with their start poses and
//! joints in the order of the tree, outputs. A joint about an axis of its frame has that axis; one against it goes from
//! the child to the parent; for any other one the points at both ends are turned, so that x or z is the axis.

mod acts;
mod frames;
mod law;

use std::fmt::Write;

use nalgebra::Vector3;

use crate::Options;
use crate::names::{Names, shown, type_name};
use crate::number::{inverse_rotation, is_identity, matrix, number, rotation, vector};
use crate::robot::{Actuator, Coupling, Inertia, Joint, JointKind, Link, Loop, Pose, Robot, Tendon};
use frames::{Frames, frames};

/// Columns of a comment.
const WIDTH: usize = 110;

/// What compliant joints have, since no file says it: N/m, N s/m, N m/rad, N m s/rad.
const COMPLIANCE: [(&str, &str, &str); 4] = [
    ("stiffness", "N/m", "1e6"),
    ("damping", "N*s/m", "100"),
    ("tilt stiffness", "N*m/rad", "1e4"),
    ("tilt damping", "N*m*s/rad", "1"),
];

/// Writes the file.
#[must_use]
pub fn write(robot: &Robot, file: &str, options: Options) -> String {
    let mut names = Names::default();
    let body = |(k, link): (usize, &Link)| {
        if k == 0 { "ground".to_owned() } else { names.take(&link.name, "body", &["place", "turned", "drag", "brake"]) }
    };
    let bodies: Vec<String> = robot.links.iter().enumerate().map(body).collect();
    let joints: Vec<JointNames> = robot.joints.iter().map(|joint| JointNames::new(joint, &mut names)).collect();
    let control = |actuator: &Actuator| {
        let drives: Vec<String> = (1..=actuator.length.parts.len()).map(|k| format!("drive{k}")).collect();
        let made = ["control", "effort", "drive"].into_iter().chain(drives.iter().map(String::as_str));
        names.take(&actuator.name, "control", &made.collect::<Vec<_>>())
    };
    let controls: Vec<String> = robot.actuators.iter().map(control).collect();
    let tendon = |tendon: &Tendon| {
        let ratios: Vec<String> = (1..=tendon.length.parts.len()).map(|k| format!("ratio{k}")).collect();
        let made = ["sum", "pull", "start", "bearing", "friction", "spring", "stop"].into_iter();
        names.take(&tendon.name, "tendon", &made.chain(ratios.iter().map(String::as_str)).collect::<Vec<_>>())
    };
    let tendons: Vec<String> = robot.tendons.iter().map(tendon).collect();
    let loops: Vec<String> = robot.loops.iter().map(|closed| names.take(&closed.name, "loop", &[])).collect();
    let lift = |(k, link): (usize, &Link)| {
        link.lifts.iter().map(|_| names.take(&format!("{}_lifted", bodies[k]), "mass", &[])).collect()
    };
    let lifts = robot.links.iter().enumerate().map(lift).collect();
    let drag = |(k, link): (usize, &Link)| {
        let made = ["axes", "velocity", "spin", "force", "torque"];
        link.drags.iter().map(|_| names.take(&format!("{}_fluid", bodies[k]), "drag", &made)).collect()
    };
    let drags = robot.links.iter().enumerate().map(drag).collect();
    let mut points = vec![Vec::new(); robot.links.len()];
    for (k, joint) in robot.joints.iter().enumerate().filter(|(_, joint)| joint.kind != JointKind::Free) {
        points[joint.parent].push((k, true));
        points[joint.child].push((k, false));
    }
    let mut writer = Writer {
        robot,
        options,
        bodies,
        joints,
        loops,
        tendons,
        controls,
        lifts,
        drags,
        points,
        starts: vec![Start::default()],
        leaders: Vec::new(),
    };
    writer.leaders = vec![None; robot.joints.len()];
    for (k, coupling) in robot.couplings.iter().enumerate() {
        writer.leaders[coupling.follower] = Some(k);
    }
    for (joint, names) in robot.joints.iter().zip(&writer.joints) {
        let start = writer.start(joint, names);
        writer.starts.push(start);
    }
    writer.file(file)
}

/// What stands for a joint.
struct JointNames {
    /// The joint, and the points that it joins.
    joint: String,
    /// The parameter for its start.
    start: String,
    /// The input that drives it.
    effort: String,
}

impl JointNames {
    fn new(joint: &Joint, names: &mut Names) -> Self {
        let effort = if joint.kind == JointKind::Prismatic { "force" } else { "torque" };
        let made =
            ["start", effort, "bearing", "friction", "spring", "rotor", "stop", "motor", "follows", "ratio", "tie"];
        let made = if joint.is_scalar() { &made[..] } else { &["bearing", "twist", "moment"] };
        let name = names.take(&joint.name, "joint", made);
        Self { start: format!("{name}_start"), effort: format!("{name}_{effort}"), joint: name }
    }
}

/// Where a body starts: the terms of its origin's place, the factors of its orientation; none for zero and one.
#[derive(Default)]
struct Start {
    place: Vec<String>,
    turned: Vec<String>,
}

struct Writer<'r> {
    robot: &'r Robot,
    options: Options,
    /// For each link.
    bodies: Vec<String>,
    /// For each joint; the k-th one carries link k + 1.
    joints: Vec<JointNames>,
    /// For each loop.
    loops: Vec<String>,
    /// For each tendon.
    tendons: Vec<String>,
    /// For each actuator its input.
    controls: Vec<String>,
    /// For each link those of its masses without a weight.
    lifts: Vec<Vec<String>>,
    /// For each link what a fluid does to it.
    drags: Vec<Vec<String>>,
    /// For each link the joints that have a point of it, and whether it is their parent.
    points: Vec<Vec<(usize, bool)>>,
    /// For each link.
    starts: Vec<Start>,
    /// For each joint the coupling by which it follows.
    leaders: Vec<Option<usize>>,
}

impl Writer<'_> {
    fn file(&self, file: &str) -> String {
        let graph = type_name(&self.robot.name);
        let mut sections = vec![self.parameters(), self.inputs(), self.surroundings()];
        for (k, joint) in self.robot.joints.iter().enumerate() {
            sections.push(self.body(joint) + &self.joint(joint, &self.joints[k]));
        }
        sections.extend(self.robot.couplings.iter().map(|coupling| self.coupling(coupling)));
        let tendons = self.robot.tendons.iter().zip(&self.tendons);
        sections.extend(tendons.map(|(tendon, name)| self.tendon(tendon, name)));
        let actuators = self.robot.actuators.iter().zip(&self.controls);
        sections.push(actuators.map(|(actuator, name)| self.actuator(actuator, name)).collect());
        sections.extend(self.robot.loops.iter().zip(&self.loops).map(|(closed, name)| self.closed(closed, name)));
        sections.push(self.observed());
        sections.push(self.scene(&graph));
        let body: Vec<String> =
            sections.iter().filter(|section| !section.is_empty()).map(|section| indented(&indented(section))).collect();
        format!(
            "{}\nuse bg_model::bond_graph;\n\nbond_graph! {{\n    /// The robot `{}` of `{}`.\n    pub graph {graph} \
            {{\n{}    }}\n}}\n",
            self.head(file),
            shown(&self.robot.name),
            shown(file),
            body.join("\n")
        )
    }

    /// Where it is from and what is other than there.
    fn head(&self, file: &str) -> String {
        let mut text = String::new();
        let Robot { name, format, .. } = self.robot;
        comment(&mut text, "", &format!("The robot `{name}`, made by bg-import from `{file}` ({format}). SI units."));
        for (link, body) in self.robot.links.iter().zip(&self.bodies).filter(|(link, _)| !link.merged.is_empty()) {
            let merged: Vec<String> = link.merged.iter().map(|name| format!("`{name}`")).collect();
            comment(&mut text, "", &format!("In `{body}`: {}.", merged.join(", ")));
        }
        for note in self.robot.notes.iter().chain(&self.robot.remarks) {
            comment(&mut text, "- ", note);
        }
        text
    }

    fn parameters(&self) -> String {
        let mut text = String::new();
        for (joint, names) in self.scalar() {
            let (what, unit) = coordinate(joint);
            let (name, start) = (&names.joint, number(joint.start));
            if self.coupling_of(joint).is_none() {
                line(&mut text, &format!("/// {what} of `{name}` at the start."));
                line(&mut text, &format!("param {}: {unit} = {start};", names.start));
            }
        }
        let has_welds = self.robot.loops.iter().any(|closed| closed.kind != JointKind::Spherical);
        let used = [
            (self.options.compliant, "joint", "joints", true),
            (!self.robot.loops.is_empty(), "loop", "joints that close loops", has_welds),
        ];
        for (_, whose, words, tilt) in used.into_iter().filter(|(is_used, ..)| *is_used) {
            for (what, unit, value) in compliance(tilt) {
                line(&mut text, &format!("/// The {what} of {words}, chosen by the importer."));
                line(&mut text, &format!("param {whose}_{}: {unit} = {value}, at least 0;", what.replace(' ', "_")));
            }
        }
        text
    }

    fn inputs(&self) -> String {
        let mut text = String::new();
        for (actuator, name) in self.robot.actuators.iter().zip(&self.controls) {
            let on = actuator.length.parts.iter().map(|part| format!("`{}`", self.joints[part.0].joint));
            line(&mut text, &format!("/// Controls {}.", on.collect::<Vec<_>>().join(", ")));
            line(&mut text, &format!("input {name}: 1;"));
        }
        for (joint, names) in self.scalar().filter(|_| self.has_drives()) {
            let (word, unit) = effort(joint);
            line(&mut text, &format!("/// Drives `{}`: a {word}.", names.joint));
            line(&mut text, &format!("input {}: {unit};", names.effort));
        }
        text
    }

    fn surroundings(&self) -> String {
        let mut text = String::new();
        if self.robot.gravity != Vector3::zeros() {
            line(&mut text, &format!("gravity {};", vector(&self.robot.gravity, 0.0)));
        }
        let points = self.points(0);
        if !points.is_empty() {
            line(&mut text, &format!("ground {{\n{}}}", indented(&points)));
        }
        text
    }

    /// The points of a link: those of the joints that it carries, of its own joint, of loops.
    fn points(&self, link: usize) -> String {
        let mut text = String::new();
        let mut point = |name: &str, pose: &Pose| {
            if is_point(pose) {
                let turned = rotation(&pose.turned).map(|turned| format!(" turned {turned}")).unwrap_or_default();
                line(&mut text, &format!("point {name} = {}{turned};", vector(&pose.place, 1e-3)));
            }
        };
        for &(k, is_parent) in &self.points[link] {
            let frames = frames(&self.robot.joints[k]);
            point(&self.joints[k].joint, if is_parent { &frames.in_parent } else { &frames.in_child });
        }
        for (name, (_, place)) in self.lifts[link].iter().zip(&self.robot.links[link].lifts) {
            point(name, &Pose::at(*place));
        }
        for (name, drag) in self.drags[link].iter().zip(&self.robot.links[link].drags) {
            point(name, &Pose::at(drag.place));
        }
        for (closed, name) in self.robot.loops.iter().zip(&self.loops) {
            closed.ends.iter().filter(|end| end.0 == link).for_each(|end| point(name, &end.1));
        }
        text
    }

    /// The body that a joint carries, with its start.
    fn body(&self, joint: &Joint) -> String {
        let (link, name) = (&self.robot.links[joint.child], &self.bodies[joint.child]);
        let Start { place, turned } = &self.starts[joint.child];
        let mut inner = masses(link);
        inner += &self.points(joint.child);
        let (has_place, has_turned) = (!place.is_empty(), !turned.is_empty());
        let starts =
            [(has_place, format!("start at {name}_place;")), (has_turned, format!("start turned {name}_turned;"))];
        let starts: Vec<String> = starts.into_iter().filter(|(has, _)| *has).map(|(_, start)| start).collect();
        if !starts.is_empty() {
            line(&mut inner, &starts.join(" "));
        }
        let mut text = String::new();
        if has_turned {
            line(&mut text, &format!("let {name}_turned: 1 = {};", turned.join(" * ")));
        }
        if has_place {
            line(&mut text, &format!("let {name}_place: m = {};", place.join(" + ").replace("+ -", "- ")));
        }
        line(&mut text, &format!("body {name} {{\n{}}}", indented(&inner)));
        if self.robot.gravity != Vector3::zeros() {
            for (lift, (mass, place)) in self.lifts[joint.child].iter().zip(&link.lifts) {
                let at = self.end(joint.child, lift, &Pose::at(*place));
                let up = vector(&(-self.robot.gravity * *mass), 0.0);
                line(&mut text, &format!("drive {lift} on {at} force = {up};"));
            }
        }
        for (drag, name) in link.drags.iter().zip(&self.drags[joint.child]) {
            text += &self.drag_by_fluid(&self.bodies[joint.child], name, drag);
        }
        text
    }

    /// Where the body of a joint starts; its parent's start is known.
    fn start(&self, joint: &Joint, names: &JointNames) -> Start {
        let Frames { letter, reversed, in_parent, in_child } = frames(joint);
        let start = if reversed { format!("-{}", names.start) } else { names.start.clone() };
        let parent = self.turned(joint.parent);
        let carried: Vec<String> = parent.iter().cloned().chain(rotation(&in_parent.turned)).collect();
        let turned: Vec<String> = if joint.kind == JointKind::Revolute {
            let spin = format!("rotation_{letter}({start})");
            carried.iter().cloned().chain([spin]).chain(inverse_rotation(&in_child.turned)).collect()
        } else {
            parent.iter().cloned().chain(rotation(&(in_parent.turned * in_child.turned.transpose()))).collect()
        };
        let product = |factors: &[String], vector: String| [factors, &[vector]].concat().join(" * ");
        let mut place: Vec<String> = self.placed(joint.parent).into_iter().collect();
        if in_parent.place != Vector3::zeros() {
            place.push(product(parent.as_slice(), vector(&in_parent.place, 1e-3)));
        }
        if joint.kind == JointKind::Prismatic {
            let along = ["x", "y", "z"].map(|axis| if axis == letter { start.as_str() } else { "0" }).join(", ");
            place.push(product(&carried, format!("[{along}]")));
        }
        if in_child.place != Vector3::zeros() {
            place.push(if turned.is_empty() {
                vector(&-in_child.place, 1e-3)
            } else {
                format!("-{}_turned * {}", self.bodies[joint.child], vector(&in_child.place, 1e-3))
            });
        }
        Start { place, turned }
    }

    /// The name of a link's orientation at the start; none where it is not turned.
    fn turned(&self, link: usize) -> Option<String> {
        (!self.starts[link].turned.is_empty()).then(|| format!("{}_turned", self.bodies[link]))
    }

    /// The name of a link's place at the start; none where it is the ground's origin.
    fn placed(&self, link: usize) -> Option<String> {
        (!self.starts[link].place.is_empty()).then(|| format!("{}_place", self.bodies[link]))
    }

    /// A joint with what acts on it.
    fn joint(&self, joint: &Joint, names: &JointNames) -> String {
        let name = &names.joint;
        let Frames { letter, reversed, in_parent, in_child } = frames(joint);
        let kind = match joint.kind {
            JointKind::Free => return self.drag(joint),
            JointKind::Fixed => "fixed".to_owned(),
            JointKind::Revolute => format!("revolute {letter}"),
            JointKind::Prismatic => format!("prismatic {letter}"),
            JointKind::Cylindrical => format!("cylindrical {letter}"),
            JointKind::Universal => "universal x y".to_owned(),
            JointKind::Spherical => "spherical".to_owned(),
        };
        let (parent, child) = (self.end(joint.parent, name, &in_parent), self.end(joint.child, name, &in_child));
        let (first, second) = if reversed { (child, parent) } else { (parent, child) };
        let clauses = if self.options.compliant {
            clauses("joint", joint.kind != JointKind::Spherical)
        } else {
            "rigid;".to_owned()
        };
        let mut text = String::new();
        line(&mut text, &format!("joint {name}: {kind} ({first} -> {second}) {{ {clauses} }}"));
        if joint.is_scalar() {
            self.actors(&mut text, joint, names);
        } else if !joint.damping.is_zero() {
            text += &self.ball_bearing(joint, name);
        }
        text
    }

    /// Whether each joint has an input of its own.
    fn has_drives(&self) -> bool {
        self.options.drives && self.robot.actuators.is_empty()
    }

    /// The coupling by which a joint follows.
    fn coupling_of(&self, joint: &Joint) -> Option<&Coupling> {
        self.leaders[joint.child - 1].map(|k| &self.robot.couplings[k])
    }

    /// A joint that closes a loop.
    fn closed(&self, closed: &Loop, name: &str) -> String {
        let kind = match closed.kind {
            JointKind::Spherical => "spherical",
            JointKind::Revolute => "revolute z",
            JointKind::Prismatic => "prismatic z",
            _ => "fixed",
        };
        let [first, second] = closed.ends.each_ref().map(|(link, pose)| self.end(*link, name, pose));
        let clauses = clauses("loop", closed.kind != JointKind::Spherical);
        format!("joint {name}: {kind} ({first} -> {second}) {{ {clauses} }}\n")
    }

    fn end(&self, link: usize, point: &str, pose: &Pose) -> String {
        let body = &self.bodies[link];
        if is_point(pose) { format!("{body}.{point}") } else { body.clone() }
    }

    fn observed(&self) -> String {
        let mut inner = String::new();
        for (joint, names) in self.scalar() {
            let (name, unit) = (&names.joint, coordinate(joint).1);
            line(&mut inner, &format!("{name}: {unit} = {name}.{};", coordinate_word(joint)));
        }
        for joint in self.robot.joints.iter().filter(|joint| joint.kind == JointKind::Free) {
            let body = &self.bodies[joint.child];
            line(&mut inner, &format!("{body}_position: m = {body}.origin.position;"));
        }
        let potential = self.potential();
        let sum = if potential.is_empty() { "" } else { " + potential" };
        line(&mut inner, &format!("energy: J = stored_energy{sum};"));
        format!("{potential}observe {{\n{}}}\n", indented(&inner))
    }

    /// Minus the work of the weights.
    fn potential(&self) -> String {
        let gravity = self.robot.gravity;
        if gravity == Vector3::zeros() {
            return String::new();
        }
        let terms = |of: &str| {
            let weight = |(k, body): (usize, &String)| {
                let mut term = format!("{body}.mass * {body}.position{of}");
                for (lift, (mass, place)) in self.lifts[k].iter().zip(&self.robot.links[k].lifts) {
                    let point = if is_point(&Pose::at(*place)) { lift } else { "origin" };
                    let _ = write!(term, " - {} * {body}.{point}.position{of}", number(*mass));
                }
                term
            };
            self.bodies.iter().enumerate().skip(1).map(weight).collect::<Vec<_>>().join("\n    + ")
        };
        let along =
            ["x", "y", "z"].into_iter().zip(gravity.iter()).filter(|(_, part)| **part != 0.0).collect::<Vec<_>>();
        match along[..] {
            [(axis, part)] => {
                format!("let potential: J = {} * (\n    {}\n);\n", number(-part), terms(&format!(".{axis}")))
            }
            _ => format!("let potential: J = -dot(\n    {},\n    {}\n);\n", vector(&gravity, 0.0), terms("")),
        }
    }

    /// Of rigid joints the model itself, of compliant ones the same with rigid ones.
    fn scene(&self, graph: &str) -> String {
        if !self.options.compliant {
            let is_jointed = self.robot.joints.iter().any(|joint| joint.kind != JointKind::Free);
            let scene = || format!("scenes only;\n/// In the coordinates of its joints.\nscene {graph} {{}}\n");
            return is_jointed.then(scene).unwrap_or_default();
        }
        let joints = if self.robot.loops.is_empty() {
            "joints;".to_owned()
        } else {
            let held = self.robot.joints.iter().zip(&self.joints).filter(|(joint, _)| joint.kind != JointKind::Free);
            format!("{{ {} }}", held.map(|(_, names)| names.joint.as_str()).collect::<Vec<_>>().join(", "))
        };
        format!("/// The same on rigid joints.\nscene {graph}Rigid {{\n    rigid {joints}\n}}\n")
    }

    /// The joints that have an angle or a travel.
    fn scalar(&self) -> impl Iterator<Item = (&Joint, &JointNames)> {
        self.robot.joints.iter().zip(&self.joints).filter(|(joint, _)| joint.is_scalar())
    }
}

/// Mass, centre and moments.
fn masses(link: &Link) -> String {
    let Some(Inertia { mass, center, tensor }) = &link.inertia else { return String::new() };
    let mut text = format!("mass {};\n", number(*mass));
    if *center != Vector3::zeros() {
        line(&mut text, &format!("center {};", vector(center, 1e-3)));
    }
    let moments = tensor.diagonal();
    let is_principal = (tensor - nalgebra::Matrix3::from_diagonal(&moments)).amax() <= 1e-12 * tensor.amax();
    let inertia = if is_principal { vector(&moments, 0.0) } else { matrix(tensor) };
    line(&mut text, &format!("inertia {inertia};"));
    text
}

/// What a joint has that gives way.
fn compliance(holds_rotation: bool) -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    COMPLIANCE.into_iter().filter(move |(what, ..)| holds_rotation || !what.starts_with("tilt"))
}

/// The same as clauses.
fn clauses(whose: &str, holds_rotation: bool) -> String {
    let clause = |what: &str| format!("{what} {whose}_{};", what.replace(' ', "_"));
    compliance(holds_rotation).map(|(what, ..)| clause(what)).collect::<Vec<_>>().join(" ")
}

fn is_point(pose: &Pose) -> bool {
    pose.place.amax() > 1e-18 || !is_identity(&pose.turned)
}

fn coordinate(joint: &Joint) -> (&'static str, &'static str) {
    if joint.kind == JointKind::Prismatic { ("Travel", "m") } else { ("Angle", "rad") }
}

/// What its angle or travel is called.
fn coordinate_word(joint: &Joint) -> &'static str {
    if joint.kind == JointKind::Prismatic { "travel" } else { "angle" }
}

/// The junction of its free axis.
fn axis(joint: &Joint) -> &'static str {
    if joint.kind == JointKind::Prismatic { "slide" } else { "spin" }
}

fn effort(joint: &Joint) -> (&'static str, &'static str) {
    if joint.kind == JointKind::Prismatic { ("force", "N") } else { ("torque", "N*m") }
}

fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// Comment lines, broken at words; all after the first are indented as far as `mark` is long.
fn comment(text: &mut String, mark: &str, words: &str) {
    let mut row = format!("// {mark}");
    let indent = format!("// {}", " ".repeat(mark.len()));
    for word in shown(words).split(' ') {
        if row.len() + word.len() > WIDTH {
            line(text, row.trim_end());
            row.clone_from(&indent);
        }
        let _ = write!(row, "{word} ");
    }
    line(text, row.trim_end());
}

/// Lines two steps into the graph, or one step into a block.
fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}
