//! The static description of a generated model.
//!
//! In: a [`Compiled`], operation counts. Out: a `Description` literal.

use proc_macro2::TokenStream;
use quote::quote;

use super::drawing::drawing;
use crate::graph::causality::{CausalGraph, End};
use crate::graph::{BondGraph, NodeKind};
use crate::pipeline::Compiled;
use crate::program::Counts;
use crate::source::mechanism::{self, Part};
use crate::system::equations::{Origin, Output, StateEquations};

/// The `Description` literal; `PARAMETERS` is the table of the parameters.
pub(super) fn description(model: &Compiled, costs: &[(&str, Counts)]) -> TokenStream {
    let (causal, equations) = (&model.derived.causal, &model.equations);
    let graph = &causal.graph;
    let (name, doc, expanded) = (&graph.name.text, &graph.docs, model.derived.expanded.to_string());
    let reduction = model.reduction.as_ref().map(ToString::to_string).unwrap_or_default();
    let (inputs, states, outputs) = (inputs(graph), states(graph, equations), outputs(equations));
    let parts = mechanism::parts(&model.source);
    let (switches, elements, bonds) = (switches(equations), elements(graph, &parts), bonds(causal));
    let parts =
        parts.iter().map(|Part { word, name }| quote!(::bg_model::description::PartInfo { word: #word, name: #name }));
    let (lines, counts, drawing) = (&equations.texts, operations(costs), drawing(model));
    quote! {
        ::bg_model::description::Description {
            name: #name, doc: #doc, graph: #expanded, reduction: #reduction, parameters: PARAMETERS,
            inputs: &[#(#inputs,)*], states: &[#(#states,)*], outputs: &[#(#outputs,)*],
            switches: &[#(#switches,)*], parts: &[#(#parts,)*], elements: &[#(#elements,)*], bonds: &[#(#bonds,)*],
            equations: &[#(#lines,)*], operations: &[#(#counts,)*], drawing: #drawing,
        }
    }
}

fn inputs(graph: &BondGraph) -> impl Iterator<Item = TokenStream> {
    graph.inputs.iter().map(|input| {
        let (name, unit, doc) = (&input.name.text, &input.unit, &input.docs);
        quote!(::bg_model::description::InputInfo { name: #name, unit: #unit, doc: #doc })
    })
}

fn states(graph: &BondGraph, equations: &StateEquations) -> impl Iterator<Item = TokenStream> {
    equations.states.iter().map(|state| {
        let element = element_of(graph, state.origin);
        let (name, unit, kind) = (&state.name, &state.unit, state_kind(state.origin));
        quote! {
            ::bg_model::description::StateInfo {
                name: #name, unit: #unit, kind: #kind, element: #element,
            }
        }
    })
}

fn outputs(equations: &StateEquations) -> impl Iterator<Item = TokenStream> {
    equations.outputs.iter().map(|output| {
        let Output { name, of, observes, unit, .. } = output;
        quote!(::bg_model::description::OutputInfo { name: #name, of: #of, observes: #observes, unit: #unit })
    })
}

fn switches(equations: &StateEquations) -> impl Iterator<Item = TokenStream> {
    equations.switches.iter().map(|switch| {
        let element = &switch.element;
        let (name, guard) = (switch.name(), equations.shown(&equations.pool, switch.guard));
        quote!(::bg_model::description::SwitchInfo { name: #name, element: #element, guard: #guard })
    })
}

fn elements(graph: &BondGraph, parts: &[Part]) -> impl Iterator<Item = TokenStream> {
    graph.nodes.iter().map(|node| {
        let part = mechanism::part_of(parts, &node.name.text).map_or("", |part| &parts[part].name);
        let (kind, name) = (node.kind.symbol(), &node.name.text);
        let law = if let NodeKind::Element(element) = &node.kind { element.text.as_str() } else { "" };
        quote!(::bg_model::description::ElementInfo { kind: #kind, name: #name, law: #law, part: #part })
    })
}

fn operations(costs: &[(&str, Counts)]) -> impl Iterator<Item = TokenStream> {
    costs.iter().map(|(name, counts)| {
        let Counts { additions, multiplications, divisions, functions, choices } = counts;
        quote! {
            (#name, ::bg_model::description::OperationCount {
                additions: #additions, multiplications: #multiplications, divisions: #divisions,
                functions: #functions, choices: #choices,
            })
        }
    })
}

/// The name of the element or junction that a state belongs to; none of an integral or of an angle that counts turns.
pub(super) fn element_of(graph: &BondGraph, origin: Origin) -> &str {
    let node = match origin {
        Origin::Momentum(node, _) | Origin::Displacement(node, _) | Origin::Way(node) => node,
        Origin::Position(track, _) | Origin::Orientation(track, ..) | Origin::Angle(track) => {
            graph.tracks[track].junction
        }
        Origin::Turn(_) | Origin::Integral(_) => return "",
    };
    &graph.node(node).name.text
}

fn state_kind(origin: Origin) -> TokenStream {
    let kind = match origin {
        Origin::Momentum(_, component) => quote!(Momentum(#component)),
        Origin::Displacement(_, component) => quote!(Displacement(#component)),
        Origin::Position(_, axis) => quote!(Position(#axis)),
        Origin::Orientation(_, row, column) => quote!(Orientation(#row, #column)),
        Origin::Angle(_) => quote!(Angle),
        Origin::Turn(_) | Origin::Way(_) => quote!(Way),
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
