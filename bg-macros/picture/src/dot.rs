//! The graph in the language of Graphviz.
//!
//! In: a [`Graph`], a [`Level`]. Out: DOT text: parts are clusters, a causal stroke is `tee`, a half arrow `rnormal`, a
//! multibond a double line. Graphviz places the nodes.

use std::fmt::Write;

use crate::graph::{End, Graph, Level};
use crate::marks::Mark;
use crate::sheet::{Link, Of, Sheet};

/// The picture of `graph` as DOT.
#[must_use]
pub fn dot(graph: &Graph, level: Level) -> String {
    let sheet = Sheet::new(graph, level);
    let mut out = format!(
        "digraph {} {{\n  rankdir=LR;\n  fontname=\"Helvetica\";\n  node [shape=plaintext, fontname=\"Helvetica\", \
        fontsize=11];\n  \
         edge [fontname=\"Helvetica\", fontsize=9];\n",
        quoted(&graph.name)
    );
    for (number, group) in sheet.groups.iter().enumerate() {
        let part = group.part.map(|part| &graph.parts[part]);
        let indent = if part.is_some() { "    " } else { "  " };
        if let Some(part) = part {
            let label = quoted(&part.title());
            let _ = writeln!(out, "  subgraph cluster_{number} {{\n    label={label};\n    style=rounded;");
        }
        for &block in &group.blocks {
            let _ = writeln!(out, "{indent}n{block} [{}];", node(graph, &sheet, block));
        }
        if part.is_some() {
            out.push_str("  }\n");
        }
    }
    for link in &sheet.links {
        let _ = writeln!(out, "  n{} -> n{} [{}];", link.from, link.to, edge(graph, &sheet, link));
    }
    out.push_str("}\n");
    out
}

fn node(graph: &Graph, sheet: &Sheet, block: usize) -> String {
    let block = &sheet.blocks[block];
    let mut attributes = format!("label={}", quoted(&format!("{}\n{}", block.head, block.name)));
    if let Of::Node(node) = block.of
        && !graph.nodes[node].law.is_empty()
    {
        attributes += &format!(", tooltip={}", quoted(&graph.nodes[node].law));
    }
    let colour = match block.mark {
        Mark::None if matches!(block.of, Of::Part(_)) => return attributes + ", shape=box, style=rounded",
        Mark::None => return attributes,
        Mark::Multiplier => "#f9c98a",
        Mark::Derivative => "#f5b5b5",
    };
    format!("{attributes}, style=filled, shape=box, color=\"{colour}\"")
}

fn edge(graph: &Graph, sheet: &Sheet, link: &Link) -> String {
    let arrow = if link.has_arrow { "rnormal" } else { "" };
    let [tail, head] = [End::From, End::To].map(|end| if link.stroke == Some(end) { "tee" } else { "" });
    let or_none = |text: String| if text.is_empty() { "none".to_owned() } else { text };
    let (head, tail) = (or_none(format!("{head}{arrow}")), or_none(tail.to_owned()));
    let bonds: Vec<_> = link.bonds.iter().map(|&bond| &graph.bonds[bond]).collect();
    let units = bonds.iter().map(|bond| format!("{}, {}", bond.effort, bond.flow)).collect::<Vec<_>>().join("; ");
    let double = if link.is_thick(graph, sheet) { ", color=\"black:invis:black\"" } else { "" };
    format!("dir=both, arrowhead={head}, arrowtail={tail}, tooltip={}{double}", quoted(&units))
}

/// A string of DOT.
fn quoted(text: &str) -> String {
    let escaped = text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
    format!("\"{escaped}\"")
}
