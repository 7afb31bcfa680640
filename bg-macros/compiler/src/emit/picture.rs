//! The picture of a model's graph in its documentation.
//!
//! In: a [`Compiled`]; later, while documentation is built, the text that became of it. Out: the graph as a string
//! literal, of which the macro `picture!` makes HTML. A build without documentation leaves the literal unread.

use bg_picture::{Bond, End, Graph, Level, Node, Part};
use proc_macro2::TokenStream;
use quote::quote;

use crate::graph::{self, NodeKind};
use crate::pipeline::Compiled;
use crate::source::mechanism;
use crate::tables::element_of;

/// A graph of more nodes than these is drawn in words: bodies and joints.
const LARGE: usize = 24;

/// Colours of the picture from those of rustdoc's themes.
const COLOURS: &str = "\
--bond-graph-paper:transparent;--bond-graph-ink:var(--main-color);--bond-graph-line:var(--border-color);\
--bond-graph-frame:var(--code-block-background-color);\
--bond-graph-faint:color-mix(in srgb,var(--main-color) 70%,var(--main-background-color));\
--bond-graph-bond:color-mix(in srgb,var(--main-color) 85%,var(--main-background-color));\
--bond-graph-node:color-mix(in srgb,var(--main-color) 12%,var(--main-background-color));\
--bond-graph-storage:color-mix(in srgb,#3b82d6 28%,var(--main-background-color));\
--bond-graph-resistor:color-mix(in srgb,#c9a227 26%,var(--main-background-color));\
--bond-graph-multiplier:color-mix(in srgb,#f08c1a 55%,var(--main-background-color));\
--bond-graph-derivative:color-mix(in srgb,#e04848 55%,var(--main-background-color))";

/// The graph of a model as one text.
pub(super) fn text(model: &Compiled) -> String {
    let causal = &model.derived.causal;
    let graph = &causal.graph;
    let parts = mechanism::parts(&model.source);
    let nodes = graph.nodes.iter().map(|node| {
        let name = &node.name.text;
        let states = model.equations.states.iter().filter(|state| element_of(graph, state.origin) == name);
        Node {
            kind: node.kind.symbol().to_owned(),
            name: name.clone(),
            law: if let NodeKind::Element(element) = &node.kind { element.text.clone() } else { String::new() },
            states: states.map(|state| bg_picture::quantity(&state.name, &state.unit)).collect(),
            part: mechanism::part_of(&parts, name),
        }
    });
    let bonds = graph.bonds.iter().zip(&causal.strokes).map(|(bond, stroke)| Bond {
        from: bond.from.0,
        to: bond.to.0,
        cardinality: bond.cardinality,
        stroke: match stroke {
            graph::End::From => End::From,
            graph::End::To => End::To,
        },
        effort: bond.effort_unit(),
        flow: bond.flow_unit(),
    });
    let (nodes, bonds) = (nodes.collect(), bonds.collect());
    let parts = parts.into_iter().map(|mechanism::Part { word, name }| Part { word, name }).collect();
    Graph { name: graph.name.text.clone(), parts, nodes, bonds }.to_string()
}

/// HTML for a documentation comment, as a string literal, of the string literal that a model's documentation has.
#[must_use]
pub fn picture(tokens: TokenStream) -> TokenStream {
    let text = syn::parse2::<syn::LitStr>(tokens).map(|literal| literal.value());
    let graph = text.ok().and_then(|text| text.parse::<Graph>().ok());
    let html = graph.map_or_else(String::new, |graph| html(&graph));
    quote!(#html)
}

fn html(graph: &Graph) -> String {
    let level = if graph.nodes.len() > LARGE { Level::Words } else { Level::Full };
    let svg = bg_picture::svg(graph, level);
    format!("# Bond graph\n\n<div style=\"overflow-x:auto;{COLOURS}\">\n{svg}</div>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The generated code of a graph.
    fn generated(source: &str) -> String {
        crate::compile(source.parse().expect("tokens")).to_string()
    }

    #[test]
    fn the_documentation_has_the_graph_and_draws_it() {
        let code = generated(
            "pub graph Loop { Se source = 1; 1 circuit: electrical; I coil = 2; R wire = 3;
             source -> circuit -> coil; circuit -> wire; observe { circuit.flow } }",
        );
        let start = code.find(":: picture !").expect("a picture");
        assert!(code[..start].trim_end().ends_with(":: bg_model :: __private"), "{}", &code[..start]);
        // Without the empty line Markdown takes the next title for a part of the HTML.
        assert!(code[start..].contains("\"))] # [doc = \"\"] # [doc = \"# Outputs"), "{}", &code[start..]);
        let literal = code[start..].split('"').nth(1).expect("a literal");
        let graph: Graph = literal.replace("\\n", "\n").replace("\\t", "\t").parse().expect("a graph");
        assert_eq!((graph.nodes.len(), graph.bonds.len()), (4, 3));
        assert_eq!(graph.nodes[2].states, ["coil.p Wb"]);
        let html = picture(format!("\"{literal}\"").parse().expect("tokens")).to_string();
        assert!(html.contains("<svg ") && html.contains("source"), "{html}");
    }

    #[test]
    fn html_has_no_blank_line_after_which_markdown_would_read_it_as_text() {
        let html = html(&Graph { nodes: vec![Node { law: "a\n\nb".into(), ..Node::default() }], ..Graph::default() });
        let (_, div) = html.split_once("<div").expect("a division");
        assert!(!div.contains("\n\n") && html.starts_with("# Bond graph\n\n<div"), "{html}");
    }
}
