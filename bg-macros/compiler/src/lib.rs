//! The compiler of `bond_graph!`: tokens of a multibond graph to tokens of flat Rust.
//!
//! Each floor builds on those below it only; [`pipeline`] calls their stages in order, and a test holds the floors.
//!
//! | floor | from -> to | what no longer occurs after it |
//! |---|---|---|
//! | [`source`] | tokens -> [`source::ast::Graph`] of bond-graph words, one for each scene | tokens, parts, scenes, bodies, joints |
//! | [`graph`] | -> [`graph::causality::CausalGraph`] | names, missing ports, unknown units; bonds without a stroke |
//! | [`system`] | -> [`system::equations::StateEquations`] and their derivatives | bonds; what a scene does not need |
//! | [`program`] | -> [`program::Programs`] | order left open: flat single assignment |
//! | [`tables`] | [`pipeline::Compiled`] -> [`tables::Tables`] | expressions |
//! | [`emit`] | both -> tokens | |
//!
//! Under them are [`expr`], the expressions of package `bg-expressions`, which know nothing of bond graphs, and
//! [`fault`]. [`stages::stages`] gives every stage's result as text.

pub mod emit;
pub mod fault;
pub mod graph;
pub mod pipeline;
pub mod program;
pub mod source;
pub mod stages;
pub mod system;
pub mod tables;

pub use bg_expressions::expr;
use bg_expressions::random;
use proc_macro2::TokenStream;

use crate::fault::{Faults, compile_errors};
use crate::source::{part, syntax};

/// Compiles one macro call. Faults come out as compile errors at their tokens, together with stubs of the promised
/// items.
///
/// Where the call uses a part of another call that has not been asked yet, the result is the question: a call of that
/// part's macro, which calls `bond_graph!` again, with the part in front of the tokens.
#[must_use]
pub fn compile(tokens: TokenStream) -> TokenStream {
    let (mut items, faults) = compiled(tokens);
    items.extend(compile_errors(&faults));
    items
}

/// The same without the errors, and whether there are any.
#[must_use]
pub fn compile_items(tokens: TokenStream) -> (TokenStream, bool) {
    let (items, faults) = compiled(tokens);
    (items, !faults.is_empty())
}

/// The items of a call, or stubs of them with the faults.
fn compiled(tokens: TokenStream) -> (TokenStream, Faults) {
    let (with_library, of_files) = syntax::files::call(tokens.clone());
    let (source, of_syntax) = syntax::parse_leniently(with_library);
    let faults = [of_syntax, of_files].concat();
    if let Some(path) = part::unasked(&source) {
        return (emit::question(path, &tokens), Faults::new());
    }
    let models = if faults.is_empty() { pipeline::models(&source) } else { Err(faults) };
    let mut items: TokenStream = emit::parts(&source);
    match models {
        Ok(models) => {
            items.extend(emit::version());
            items.extend(models.iter().map(emit::model));
            items.extend(emit::remarks(&models));
            items.extend(emit::anchors(&source, &models));
            (items, Faults::new())
        }
        Err(faults) => {
            items.extend(emit::anchors_with_faults(&source, &faults));
            items.extend(emit::stub(&part::flatten_leniently(&source).0.source));
            (items, faults)
        }
    }
}
