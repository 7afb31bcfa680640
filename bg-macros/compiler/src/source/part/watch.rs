//! What a part or a graph observes.
//!
//! In: the entries of `observe`, all statements of the level. Out: named expressions; `all of NAME` is what there is to
//! see of it: of a part its outputs, of a body its pose and momenta, of a joint its force and motion.

use std::collections::BTreeSet;

use proc_macro2::Span;

use super::PartFault;
use super::flat::{Flat, is_at};
use super::names::Names;
use crate::fault::{Fault, Faults, near_miss};
use crate::source::ast::{
    ElementKind, Expression, ExpressionKind, Item, Joint, JointKind, JunctionKind, Name, Observation, Watch,
};

/// What is at hand: the statements of the level and what the names mean.
pub(super) struct Seen<'a> {
    pub flat: &'a Flat,
    /// The names of the uses of parts, also of such as are not there.
    pub uses: &'a BTreeSet<String>,
    pub names: &'a mut Names,
    pub faults: &'a mut Faults,
}

impl Seen<'_> {
    /// The entries with every `all of` written out.
    pub fn observations(&mut self, watched: &[Watch]) -> Vec<Observation> {
        let each = watched.iter().map(|watch| match watch {
            Watch::Value(observation) => vec![self.observation(observation.clone())],
            Watch::All(name) => self.all(name),
        });
        each.flatten().collect()
    }

    /// An output. The name of a part's output alone stands for it with its unit.
    fn observation(&mut self, mut observation: Observation) -> Observation {
        if let ExpressionKind::Name(name) = &observation.value.kind {
            let path = self.names.path(&name.text);
            if let Some(output) = self.names.output(&path) {
                let output = watched_at(output, observation.value.span);
                return Observation {
                    name: observation.name.or(output.name),
                    unit: observation.unit.or(output.unit),
                    value: output.value,
                };
            }
        }
        self.names.value(&mut observation.value, None, self.faults);
        observation
    }

    fn all(&mut self, name: &Name) -> Vec<Observation> {
        let path = self.names.path(&name.text);
        let found = self.all_of(&path, name.span);
        if found.is_empty()
            && let Some(fault) = self.nothing(&path)
        {
            self.faults.push(Fault::new(name.span, &fault));
        }
        found
    }

    /// Of a part, of a thing, or of each element of an array.
    fn all_of(&self, path: &str, span: Span) -> Vec<Observation> {
        let outputs = &self.flat.outputs;
        let is_inside = |output: &&Observation| {
            output.name.as_ref().is_some_and(|name| name.text != path && is_at(&name.text, path))
        };
        let mut found: Vec<_> = outputs.iter().filter(is_inside).map(|output| watched_at(output, span)).collect();
        if found.is_empty() {
            found.extend(self.flat.items.iter().flat_map(|item| of_item(item, path, span)));
        }
        if found.is_empty() {
            found.extend(self.names.elements_of(path).flat_map(|element| self.all_of(&element, span)));
        }
        found
    }

    /// Why there is nothing to watch; none where that follows from another fault: there is no such part.
    fn nothing(&self, path: &str) -> Option<PartFault> {
        let used = self.flat.uses.iter().find(|used| used.path == path);
        if let Some(used) = used {
            return Some(PartFault::WatchesNothing { part: used.shown() });
        }
        if self.uses.contains(path) {
            return None;
        }
        let near = near_miss(path, self.names.declared().filter(|known| *known != path)).map(str::to_owned);
        Some(PartFault::NothingToWatch { name: path.to_owned(), near })
    }
}

/// An output of a part whose name is mentioned at `span`.
fn watched_at(output: &Observation, span: Span) -> Observation {
    let name = output.name.as_ref().map(|name| Name { span, ..name.clone() });
    Observation { name, ..output.clone() }
}

/// What there is to see of an item of this path.
fn of_item(item: &Item, path: &str, span: Span) -> Vec<Observation> {
    let (name, seen): (&Name, Vec<&str>) = match item {
        Item::Body(body) => (&body.name, vec!["position", "orientation", "momentum", "angular_momentum"]),
        Item::Joint(joint) => (&joint.name, of_joint(joint)),
        Item::Spring(spring) => (&spring.name, vec!["force", "distance"]),
        Item::Contact(contact) => (&contact.name, vec!["force", "gap", "speed"]),
        Item::ShapeContact(contact) => (&contact.name, vec!["force", "gap", "pressed"]),
        Item::Drive(drive) => (&drive.name, vec!["power"]),
        Item::Element(element) => (&element.name, of_element(element.kind)),
        Item::Junction(junction) => {
            (&junction.name, vec![if junction.kind == JunctionKind::One { "flow" } else { "effort" }])
        }
        _ => return Vec::new(),
    };
    let seen = if name.text == path { seen } else { Vec::new() };
    seen.into_iter().map(|what| observation(&format!("{path}.{what}"), span)).collect()
}

fn of_joint(joint: &Joint) -> Vec<&'static str> {
    let moment = (joint.kind != JointKind::Spherical).then_some("moment");
    let spin = joint.kind.spin().map(|_| ["angle", "speed"]);
    let slide = joint.kind.slide().map(|_| "travel");
    let motion = spin.into_iter().flatten().chain(slide);
    ["force"].into_iter().chain(moment).chain(["gap"]).chain(motion).collect()
}

fn of_element(kind: ElementKind) -> Vec<&'static str> {
    match kind {
        ElementKind::I => vec!["p", "flow"],
        ElementKind::C => vec!["q", "effort"],
        _ => vec!["effort", "flow"],
    }
}

fn observation(path: &str, span: Span) -> Observation {
    Observation {
        name: None,
        unit: None,
        value: Expression { kind: ExpressionKind::Name(Name::new(path, span)), span },
    }
}
