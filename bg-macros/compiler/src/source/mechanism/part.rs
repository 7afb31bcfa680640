//! Which mechanism words a graph has, and which one a node stands for.
//!
//! In: an `ast::Graph` with its mechanism words. Out: a [`Part`] for each, in the order of the source, the ground
//! first.

use crate::source::ast::{Graph, Item};
use crate::source::words::GROUND;

/// A mechanism word that expands to nodes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// What it is: `ground`, `body`, a joint's kind with its axes, `spring`, `contact`, `drive`,
    /// `friction`, `stop`, `orifice`.
    pub word: String,
    /// Its name, with which its nodes' names begin.
    pub name: String,
}

/// The parts of a graph.
#[must_use]
pub fn parts(graph: &Graph) -> Vec<Part> {
    let has_bodies = graph.items.iter().any(|item| matches!(item, Item::Body(_)));
    let ground = has_bodies.then(|| Part { word: GROUND.to_owned(), name: GROUND.to_owned() });
    ground.into_iter().chain(graph.items.iter().filter_map(part)).collect()
}

/// The part that a node of this name belongs to, as an index.
#[must_use]
pub fn part_of(parts: &[Part], node: &str) -> Option<usize> {
    let is_of = |name: &str| node.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    let named = parts.iter().enumerate().filter(|(_, part)| is_of(&part.name));
    named.max_by_key(|(_, part)| part.name.len()).map(|(index, _)| index)
}

fn part(item: &Item) -> Option<Part> {
    let (word, name) = match item {
        Item::Body(body) => ("body".to_owned(), &body.name),
        Item::Joint(joint) => (joint.kind.to_string(), &joint.name),
        Item::Spring(spring) => ("spring".to_owned(), &spring.name),
        Item::Drive(drive) => ("drive".to_owned(), &drive.name),
        Item::Contact(contact) => ("contact".to_owned(), &contact.name),
        Item::ShapeContact(contact) => ("contact".to_owned(), &contact.name),
        Item::Friction(friction) => ("friction".to_owned(), &friction.name),
        Item::Stop(stop) => ("stop".to_owned(), &stop.name),
        Item::Orifice(orifice) => ("orifice".to_owned(), &orifice.name),
        _ => return None,
    };
    Some(Part { word, name: name.text.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph;
    use crate::source::{mechanism, syntax};

    #[test]
    fn every_node_of_a_mechanism_word_has_its_part_and_no_other_has() {
        let text = "graph G {
            ground { point O = [0, 0, 0]; }
            body rod { mass 1; inertia [1, 1, 1]; }
            joint pin: revolute z (ground.O -> rod) { stiffness 1; tilt stiffness 1; }
            drive motor on pin speed = 1 { stiffness 1; }
            Se battery = 1; 1 circuit: electrical; R winding = 1; battery -> circuit -> winding;
        }";
        let source = syntax::parse(text.parse().expect("tokens")).expect("syntax").graphs.remove(0);
        let parts = parts(&source);
        let words: Vec<_> = parts.iter().map(|part| format!("{} {}", part.word, part.name)).collect();
        assert_eq!(words, ["ground ground", "body rod", "revolute z pin", "drive motor"]);
        let graph = graph::resolve(&mechanism::expand(&source).expect("words")).expect("names and units");
        for node in &graph.nodes {
            let name = node.name.text.as_str();
            let is_plain = ["battery", "circuit", "winding"].contains(&name);
            assert_eq!(part_of(&parts, name).is_none(), is_plain, "{name}");
        }
    }
}
