//! The compiler behind `bond_graph!`: tokens of a multibond graph to tokens of flat Rust.
//!
//! Its stages are pure functions between named types, in this order:
//!
//! | function | from -> to | what no longer occurs after it |
//! |---|---|---|
//! | [`syntax::parse`] | tokens -> [`ast::Source`] | tokens |
//! | [`scene::check_names`] | [`ast::Source`] -> the same | two models of one name |
//! | [`scene::variants`] | [`ast::Graph`] -> the literal graph and one for each scene | scenes |
//! | [`mechanism::expand`] | [`ast::Graph`] -> [`ast::Graph`] | bodies, joints, springs, drives, contacts |
//! | [`graph::resolve`] | [`ast::Graph`] -> [`graph::BondGraph`] | names, missing ports, unknown cardinalities and units |
//! | [`causality::assign`] | -> [`causality::CausalGraph`] | a bond without a stroke |
//! | [`equations::derive`] | -> [`equations::StateEquations`] | bonds, ports, junctions: scalars only from here |
//! | [`reduce::for_scene`] | -> [`equations::StateEquations`] | states and parameters that the scene does not need |
//! | [`second::arrange`] | -> [`equations::StateEquations`] | states of second order among the others, kinds mixed |
//! | [`jacobian::differentiate`] | -> [`jacobian::Jacobian`] | entries that are identically zero |
//! | [`second::differentiate`] | -> [`second::Second`] | second derivatives: those of the displacements that follow momenta |
//! | [`elimination::plan`] | places -> [`elimination::Elimination`] | the order of the pivots left open |
//! | [`program::schedule`] | -> [`program::Program`] | order left open: flat single assignment |
//! | [`pairs::pair`] | [`program::Routine`] -> [`pairs::Paired`] | operations that could be done two at a time |
//! | [`emit::model`] | -> tokens | |
//!
//! Every stage raises all its faults at once; a later stage sees only what an earlier one accepted. [`stages::stages`] gives
//! every stage's result as text.

pub mod ast;
pub mod causality;
pub mod elimination;
pub mod emit;
pub mod equations;
pub mod expr;
pub mod fault;
pub mod graph;
pub mod jacobian;
pub mod mechanism;
mod names;
pub mod pairs;
pub mod print;
pub mod program;
mod random;
pub mod reduce;
pub mod scene;
pub mod second;
pub mod stages;
pub mod syntax;
pub mod units;

use proc_macro2::TokenStream;

use crate::ast::Source;
use crate::fault::{Faults, Staged, compile_errors};
use crate::scene::Variant;

/// Compiles one macro call. Faults come out as compile errors at their tokens, together with stubs of the promised items.
#[must_use]
pub fn compile(tokens: TokenStream) -> TokenStream {
    let (source, faults) = syntax::parse_leniently(tokens);
    let result = if faults.is_empty() { models(&source) } else { Err(faults) };
    result.unwrap_or_else(|faults| {
        let mut items = compile_errors(&faults);
        items.extend(emit::stub(&source));
        items
    })
}

/// The models of all graphs, or the faults of all of them.
fn models(source: &Source) -> Staged<TokenStream> {
    let mut items = TokenStream::new();
    let mut faults = scene::check_names(source).err().unwrap_or_default();
    for graph in &source.graphs {
        match scene::variants(graph) {
            Ok(variants) => each_variant(&variants, &mut items, &mut faults),
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() { Ok(items) } else { Err(faults) }
}

/// The model of every variant; a fault of the literal graph is not repeated for its scenes.
fn each_variant(variants: &[Variant], items: &mut TokenStream, faults: &mut Faults) {
    for variant in variants {
        match model(variant) {
            Ok(tokens) => items.extend(tokens),
            Err(found) => {
                faults.extend(found);
                if variant.scene.is_none() {
                    return;
                }
            }
        }
    }
}

/// All stages of one model.
fn model(variant: &Variant) -> Staged<TokenStream> {
    let expanded = mechanism::expand(&variant.graph)?;
    let resolved = graph::resolve(&expanded)?;
    let causal = causality::assign(resolved)?;
    let (mut equations, report) = variant.reduce(equations::derive(&causal)?)?;
    let mut jacobian = jacobian::differentiate(&equations);
    let mut second = second::differentiate(&equations);
    let elimination = elimination::plan(equations.states.len(), &jacobian.places());
    Ok(emit::model(emit::Parts {
        expanded: &expanded.to_string(),
        causal: &causal,
        equations: &mut equations,
        report: report.as_ref(),
        jacobian: &mut jacobian,
        second: &mut second,
        elimination: &elimination,
    }))
}
