//! What every part must be: its ports bonded, its parameters used, its statements meaningful by themselves.
//!
//! In: a level that is written out; a part that no graph uses. Out: faults; the part as a graph.

use proc_macro2::Span;

use super::PartFault;
use super::flat::Flat;
use super::level::Level;
use crate::fault::{Fault, Faults};
use crate::source::ast::{Element, ElementKind, Expression, ExpressionKind, Graph, Item, Name, Part};
use crate::source::drawing::Drawing;

/// Every port of a part inside has a bond on this level, or is a port of this level.
pub(super) fn ports(level: &mut Level) {
    for (of, ports) in std::mem::take(&mut level.with_ports) {
        let (passed, own): (Vec<Name>, _) =
            ports.into_iter().partition(|port| level.flat.aliases.iter().any(|(_, of)| *of == port.text));
        level.flat.ports.extend(passed);
        let is_free = |port: &&Name| !level.bonded.contains(&port.text);
        let free: Vec<String> = own.iter().filter(is_free).map(|port| last(&port.text).to_owned()).collect();
        if !free.is_empty() {
            let fault = PartFault::PortWithoutBond { of: of.text.clone(), ports: free };
            level.faults.push(Fault::new(of.span, &fault));
        }
    }
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// A fault for each parameter and input of a level that nothing in it uses: a value given to it would change nothing.
/// `of` is what the level is of, such as "part `Leg`".
pub(super) fn open(level: &Level, of: &str) -> Faults {
    let unused = level.open.iter().filter(|(_, name)| !level.names.uses(&name.text));
    let fault = |(word, name): &(&'static str, Name)| {
        Fault::new(name.span, &PartFault::Unused { of: of.to_owned(), word, name: name.text.clone() })
    };
    unused.map(fault).collect()
}

/// A part as a graph of its own, with a source at each of its ports.
pub(super) fn alone(part: &Part, flat: Flat) -> Graph {
    let ports: Vec<Item> = flat.items.iter().filter_map(|item| probe(item, &flat.ports)).collect();
    let chains = flat
        .ports
        .iter()
        .map(|port| Item::Chain(vec![Name::new(format!("{}.probe", port.text), port.span), port.clone()]));
    let items = flat.items.iter().cloned().chain(ports).chain(chains).collect();
    let (docs, visibility, name) = (part.docs.clone(), part.visibility.clone(), part.name.clone());
    Graph { docs, visibility, name, items, drawing: Drawing::default() }
}

/// A source for a junction that is one of the ports.
fn probe(item: &Item, ports: &[Name]) -> Option<Item> {
    let Item::Junction(junction) = item else { return None };
    let port = ports.iter().find(|port| port.text == junction.name.text)?;
    let name = Name::new(format!("{}.probe", port.text), port.span);
    Some(Item::Element(Element::new(ElementKind::Se, name, zero(junction.cardinality, port.span))))
}

fn zero(cardinality: usize, span: Span) -> Expression {
    let zero = Expression { kind: ExpressionKind::Number(0.0), span };
    if cardinality == 1 { zero } else { Expression { kind: ExpressionKind::Vector(vec![zero; cardinality]), span } }
}
