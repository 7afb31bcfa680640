//! A graph as one text, and back: how it is handed from one macro to another.
//!
//! In: a [`Graph`]. Out: a text of one line for each row of its tables, fields divided by tabs; or the graph of such
//! a text.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use crate::graph::{Bond, End, Graph, Node, Part};

/// A text that is no graph, with the number of the line that is wrong, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unreadable(pub usize);

impl Display for Unreadable {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "this is no graph: line {} is wrong", self.0)
    }
}

impl std::error::Error for Unreadable {}

impl Display for Graph {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "graph\t{}", field(&self.name))?;
        for Part { word, name } in &self.parts {
            writeln!(f, "part\t{}\t{}", field(word), field(name))?;
        }
        for Node { kind, name, law, states, part } in &self.nodes {
            let part = part.map_or_else(String::new, |part| part.to_string());
            write!(f, "node\t{part}\t{}\t{}\t{}", field(kind), field(name), field(law))?;
            for state in states {
                write!(f, "\t{}", field(state))?;
            }
            writeln!(f)?;
        }
        for Bond { from, to, cardinality, stroke, effort, flow } in &self.bonds {
            let stroke = if *stroke == End::From { "from" } else { "to" };
            writeln!(f, "bond\t{from}\t{to}\t{cardinality}\t{stroke}\t{}\t{}", field(effort), field(flow))?;
        }
        Ok(())
    }
}

/// `text` without what divides fields and lines.
fn field(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

impl FromStr for Graph {
    type Err = Unreadable;

    fn from_str(text: &str) -> Result<Self, Unreadable> {
        let mut graph = Self::default();
        for (index, line) in text.lines().enumerate() {
            row(&mut graph, line).ok_or(Unreadable(index + 1))?;
        }
        let end = text.lines().count();
        let is_node = |node: usize| node < graph.nodes.len();
        let parts = graph.nodes.iter().filter_map(|node| node.part).all(|part| part < graph.parts.len());
        let ends = graph.bonds.iter().all(|bond| is_node(bond.from) && is_node(bond.to) && bond.from != bond.to);
        if parts && ends { Ok(graph) } else { Err(Unreadable(end)) }
    }
}

/// Adds one line to the graph; none where it is wrong.
fn row(graph: &mut Graph, line: &str) -> Option<()> {
    let fields: Vec<&str> = line.split('\t').collect();
    match fields[..] {
        ["graph", name] => name.clone_into(&mut graph.name),
        ["part", word, name] => graph.parts.push(Part { word: word.into(), name: name.into() }),
        ["node", part, kind, name, law, ref states @ ..] => graph.nodes.push(Node {
            kind: kind.into(),
            name: name.into(),
            law: law.into(),
            states: states.iter().map(|&state| state.to_owned()).collect(),
            part: if part.is_empty() { None } else { Some(part.parse().ok()?) },
        }),
        ["bond", from, to, cardinality, stroke, effort, flow] => graph.bonds.push(Bond {
            from: from.parse().ok()?,
            to: to.parse().ok()?,
            cardinality: cardinality.parse().ok()?,
            stroke: match stroke {
                "from" => End::From,
                "to" => End::To,
                _ => return None,
            },
            effort: effort.into(),
            flow: flow.into(),
        }),
        _ => return None,
    }
    Some(())
}
