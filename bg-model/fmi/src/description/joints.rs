//! The ends of joints as terminals: the force and the moment that a joint hands on, and how its ends move.
//!
//! In: a model's variables. Out: for each joint a terminal with one for each end inside it. Method: the point at which
//! a joint holds a body is the one whose arm the law of the joint's transformer has; a joint without one holds the
//! centre of mass.

use bg_model::description::PartInfo;

use super::terminals::{Terminal, Variables, distinct};

/// The first words of parts that are joints.
const JOINTS: [&str; 6] = ["revolute", "prismatic", "spherical", "cylindrical", "universal", "fixed"];

/// An end of a joint, as its bonds and transformers call it.
struct End {
    /// What its terminal is called.
    name: &'static str,
    /// The transformer from the force to the body's moment.
    transformer: &'static str,
}

const FIRST: End = End { name: "first", transformer: "arm_a" };
const SECOND: End = End { name: "second", transformer: "arm_b" };

impl Variables {
    /// A joint, if it is one, whose force and moment are outputs, and the motion of an end of it.
    pub(super) fn joint(&self, part: &PartInfo) -> Option<Terminal> {
        let word = part.word.split(' ').next()?;
        if !JOINTS.contains(&word) {
            return None;
        }
        let inside: Vec<Terminal> = [FIRST, SECOND].into_iter().filter_map(|end| self.end(part.name, &end)).collect();
        (!inside.is_empty()).then(|| Terminal {
            name: part.name.to_owned(),
            rule: "bus",
            kind: "_bg-fmi_joint".to_owned(),
            description: format!("The ends of a {word} joint; power goes from the first to the second"),
            members: Vec::new(),
            inside,
        })
    }

    fn end(&self, joint: &str, end: &End) -> Option<Terminal> {
        let body = self.body(joint, end)?;
        let point = self.point(joint, end, body)?;
        let seen = |quantity: String, what: &str| distinct(self.observed(&quantity, what));
        let all = |members: Vec<_>| (members.len() == 3).then_some(members);
        let mut members = all(seen(format!("{joint}.force"), "force"))?;
        members.extend(all(seen(format!("{point}.velocity"), "velocity"))?);
        if self.node(&format!("{joint}.angular")).is_some() {
            members.extend(all(seen(format!("{joint}.moment"), "moment"))?);
            members.extend(all(seen(format!("{body}.angular_velocity"), "angular_velocity"))?);
        }
        Some(Terminal {
            name: end.name.to_owned(),
            rule: "bus",
            kind: "_bg-fmi_end".to_owned(),
            description: format!(
                "Efforts and flows of {joint} at {point}, inertial axes: force times velocity and moment times angular \
                 velocity are the power through this end"
            ),
            members,
            inside: Vec::new(),
        })
    }

    /// The body that the joint holds by this end; none where it is the ground, which does not move.
    fn body(&self, joint: &str, end: &End) -> Option<&'static str> {
        let linear = format!("{joint}.linear");
        let held = self.description.bonds.iter().find_map(|bond| {
            let [this, other] = if end.name == FIRST.name { [bond.to, bond.from] } else { [bond.from, bond.to] };
            other.strip_suffix(".translation").filter(|_| this == linear)
        })?;
        self.description.parts.iter().find(|part| part.word == "body" && part.name == held).map(|part| part.name)
    }

    /// The point of the body where the joint is, as outputs call it.
    fn point(&self, joint: &str, end: &End, body: &'static str) -> Option<&'static str> {
        let Some(arm) = self.node(&format!("{joint}.{}", end.transformer)) else { return Some(body) };
        let points = self.description.outputs.iter().filter_map(|output| output.observes.split_once(".velocity"));
        points.map(|(point, _)| point).find(|point| {
            let laws = [format!("(w) = cross(w, {point}.arm)"), format!("(f) = cross({point}.arm, f)")];
            laws.iter().any(|law| law == arm.law)
        })
    }
}
