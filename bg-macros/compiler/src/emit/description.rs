//! The static description and the documentation of a generated model.
//!
//! In: graph, strokes, equations, operation counts. Out: a `Description` literal, a doc text.

use proc_macro2::TokenStream;
use quote::quote;

use crate::graph::NodeKind;
use crate::graph::causality::{CausalGraph, End};
use crate::program::Counts;
use crate::program::elimination::Elimination;
use crate::system::equations::{Origin, StateEquations};
use crate::system::jacobian::Jacobian;

/// The generated type's documentation: the user's, then the states, the operations and the Jacobian's pattern. `costs` are
/// the functions with their operations.
pub(super) fn documentation(
    docs: &str,
    equations: &StateEquations,
    (jacobian, elimination): (&Jacobian, &Elimination),
    costs: &[(&str, Counts)],
) -> String {
    let mut doc = String::from(docs);
    doc.push_str("\n\n# States\n\n| index | name | unit | storage | causality |\n|---|---|---|---|---|\n");
    for (index, state) in equations.states.iter().enumerate() {
        doc.push_str(&format!(
            "| {index} | `{}` | {} | {} | integral |\n",
            state.name,
            state.unit,
            state.origin.kind().storage()
        ));
    }
    doc.push_str("\n# Operations\n\n| function | additions | multiplications | divisions | functions | choices |\n");
    doc.push_str("|---|---|---|---|---|---|\n");
    for (name, counts) in costs {
        let Counts { additions, multiplications, divisions, functions, choices } = counts;
        doc.push_str(&format!(
            "| {name} | {additions} | {multiplications} | {divisions} | {functions} | {choices} |\n"
        ));
    }
    doc.push_str(&format!(
        "\nThe Jacobian has {} entries that are not identically zero; its elimination fills {} more places.\n",
        jacobian.entries.len(),
        elimination.fill
    ));
    doc
}

/// Texts of a description that earlier stages made.
pub(super) struct Texts<'a> {
    /// The graph in bond-graph words.
    pub(super) expanded: &'a str,
    /// What a scene left out and why; empty for a literal model.
    pub(super) reduction: &'a str,
}

/// The `Description` literal; `PARAMETERS` is the parameter struct's table.
pub(super) fn description(
    texts: &Texts<'_>,
    causal: &CausalGraph,
    equations: &StateEquations,
    costs: &[(&str, Counts)],
) -> TokenStream {
    let graph = &causal.graph;
    let Texts { expanded, reduction } = texts;
    let (name, doc) = (&graph.name.text, &graph.docs);
    let inputs = graph.inputs.iter().map(|input| {
        let (name, unit, doc) = (&input.name.text, &input.unit, &input.docs);
        quote!(::bg_model::description::InputInfo { name: #name, unit: #unit, doc: #doc })
    });
    let states = equations.states.iter().map(|state| {
        let (name, unit, kind) = (&state.name, &state.unit, state_kind(state.origin));
        quote! {
            ::bg_model::description::StateInfo { name: #name, unit: #unit, kind: #kind, causality: "integral" }
        }
    });
    let outputs = equations.outputs.iter().map(|output| {
        let (name, unit) = (&output.name, &output.unit);
        quote!(::bg_model::description::OutputInfo { name: #name, unit: #unit })
    });
    let switches = equations.switches.iter().map(|switch| {
        let (element, condition) = (&switch.element, &switch.condition);
        let (name, guard) =
            (format!("`if {condition}` of `{element}`"), equations.shown(&equations.pool, switch.guard));
        quote!(::bg_model::description::SwitchInfo { name: #name, element: #element, guard: #guard })
    });
    let elements = graph.nodes.iter().map(|node| {
        let (kind, name) = (node.kind.symbol(), &node.name.text);
        let law = if let NodeKind::Element(element) = &node.kind { element.text.as_str() } else { "" };
        quote!(::bg_model::description::ElementInfo { kind: #kind, name: #name, law: #law })
    });
    let bonds = bonds(causal);
    let lines = &equations.texts;
    let counts = costs.iter().map(|(name, counts)| {
        let Counts { additions, multiplications, divisions, functions, choices } = counts;
        quote! {
            (#name, ::bg_model::description::OperationCount {
                additions: #additions, multiplications: #multiplications, divisions: #divisions,
                functions: #functions, choices: #choices,
            })
        }
    });
    quote! {
        ::bg_model::description::Description {
            name: #name, doc: #doc, graph: #expanded, reduction: #reduction, parameters: PARAMETERS,
            inputs: &[#(#inputs,)*], states: &[#(#states,)*], outputs: &[#(#outputs,)*],
            switches: &[#(#switches,)*], elements: &[#(#elements,)*], bonds: &[#(#bonds,)*],
            equations: &[#(#lines,)*], operations: &[#(#counts,)*],
        }
    }
}

fn state_kind(origin: Origin) -> TokenStream {
    let kind = match origin {
        Origin::Momentum(_, component) => quote!(Momentum(#component)),
        Origin::Displacement(_, component) => quote!(Displacement(#component)),
        Origin::Position(_, axis) => quote!(Position(#axis)),
        Origin::Orientation(_, row, column) => quote!(Orientation(#row, #column)),
        Origin::Angle(_) => quote!(Angle),
        Origin::Integral(_) => quote!(Integral),
    };
    quote!(::bg_model::description::StateKind::#kind)
}

fn bonds(causal: &CausalGraph) -> impl Iterator<Item = TokenStream> {
    let graph = &causal.graph;
    graph.bonds.iter().zip(&causal.strokes).map(|(bond, stroke)| {
        let (from, to) = (&graph.node(bond.from).name.text, &graph.node(bond.to).name.text);
        let cardinality = bond.cardinality;
        let stroke = match stroke {
            End::From => quote!(From),
            End::To => quote!(To),
        };
        let (effort, flow) = (bond.effort_unit(), bond.flow_unit());
        quote! {
            ::bg_model::description::BondInfo {
                from: #from, to: #to, cardinality: #cardinality, stroke: ::bg_model::description::BondEnd::#stroke,
                effort: #effort, flow: #flow,
            }
        }
    })
}
