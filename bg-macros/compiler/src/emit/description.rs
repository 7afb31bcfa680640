//! The static description of a generated model.
//!
//! In: its [`crate::tables`]. Out: a `Description` literal.

use proc_macro2::TokenStream;
use quote::quote;

use super::drawing::drawing;
use crate::program::Counts;
use crate::tables::{Bond, Description, Element, Input, Named, Output, State, StateKind, Switch};

/// The `Description` literal; `PARAMETERS` is the table of the parameters.
pub(super) fn description(of: &Description) -> TokenStream {
    let Description { name, doc, graph, reduction, equations, .. } = of;
    let (inputs, states) = (of.inputs.iter().map(input), of.states.iter().map(state));
    let (outputs, switches) = (of.outputs.iter().map(output), of.switches.iter().map(switch));
    let (parts, elements) = (of.parts.iter().map(part), of.elements.iter().map(element));
    let (bonds, counts) = (of.bonds.iter().map(bond), of.operations.iter().map(operations));
    let drawing = drawing(&of.drawing);
    quote! {
        ::bg_model::description::Description {
            name: #name, doc: #doc, graph: #graph, reduction: #reduction, parameters: PARAMETERS,
            inputs: &[#(#inputs,)*], states: &[#(#states,)*], outputs: &[#(#outputs,)*],
            switches: &[#(#switches,)*], parts: &[#(#parts,)*], elements: &[#(#elements,)*], bonds: &[#(#bonds,)*],
            equations: &[#(#equations,)*], operations: &[#(#counts,)*], drawing: #drawing,
        }
    }
}

fn input(Input { name, unit, doc }: &Input) -> TokenStream {
    quote!(::bg_model::description::InputInfo { name: #name, unit: #unit, doc: #doc })
}

fn state(State { name, unit, kind, element }: &State) -> TokenStream {
    let kind = match kind {
        StateKind::Momentum(component) => quote!(Momentum(#component)),
        StateKind::Displacement(component) => quote!(Displacement(#component)),
        StateKind::Position(axis) => quote!(Position(#axis)),
        StateKind::Orientation(row, column) => quote!(Orientation(#row, #column)),
        StateKind::Angle => quote!(Angle),
        StateKind::Way => quote!(Way),
        StateKind::Integral => quote!(Integral),
    };
    quote! {
        ::bg_model::description::StateInfo {
            name: #name, unit: #unit, kind: ::bg_model::description::StateKind::#kind, element: #element,
        }
    }
}

fn output(Output { name, of, observes, unit }: &Output) -> TokenStream {
    quote!(::bg_model::description::OutputInfo { name: #name, of: #of, observes: #observes, unit: #unit })
}

fn switch(Switch { name, element, guard }: &Switch) -> TokenStream {
    quote!(::bg_model::description::SwitchInfo { name: #name, element: #element, guard: #guard })
}

fn part(Named { word, name }: &Named) -> TokenStream {
    quote!(::bg_model::description::PartInfo { word: #word, name: #name })
}

fn element(Element { kind, name, law, part }: &Element) -> TokenStream {
    quote!(::bg_model::description::ElementInfo { kind: #kind, name: #name, law: #law, part: #part })
}

fn operations((name, counts): &(String, Counts)) -> TokenStream {
    let Counts { additions, multiplications, divisions, functions, choices } = counts;
    quote! {
        (#name, ::bg_model::description::OperationCount {
            additions: #additions, multiplications: #multiplications, divisions: #divisions,
            functions: #functions, choices: #choices,
        })
    }
}

fn bond(Bond { from, to, cardinality, stroke_at_end, effort, flow }: &Bond) -> TokenStream {
    let stroke = if *stroke_at_end { quote!(To) } else { quote!(From) };
    quote! {
        ::bg_model::description::BondInfo {
            from: #from, to: #to, cardinality: #cardinality, stroke: ::bg_model::description::BondEnd::#stroke,
            effort: #effort, flow: #flow,
        }
    }
}
