//! The compiler of `bond_graph!`: tokens of a multibond graph to tokens of flat Rust.
//!
//! Each floor builds on those below it only; [`pipeline`] calls their stages in order, and a test holds the floors.
//!
//! | floor | from -> to | what no longer occurs after it |
//! |---|---|---|
//! | [`source`] | tokens -> [`source::ast::Graph`] of bond-graph words, one for each scene | tokens, scenes, bodies, joints |
//! | [`graph`] | -> [`graph::causality::CausalGraph`] | names, missing ports, unknown units; bonds without a stroke |
//! | [`system`] | -> [`system::equations::StateEquations`] and their derivatives | bonds; what a scene does not need |
//! | [`program`] | -> [`program::Programs`] | order left open: flat single assignment |
//! | [`emit`] | [`pipeline::Compiled`] -> tokens | |
//!
//! Beside them stand [`expr`], the kernel of expressions, which knows nothing of bond graphs, and [`fault`].
//! [`stages::stages`] gives every stage's result as text.

pub mod emit;
pub mod expr;
pub mod fault;
pub mod graph;
pub mod pipeline;
pub mod program;
mod random;
pub mod source;
pub mod stages;
pub mod system;

use proc_macro2::TokenStream;

use crate::fault::compile_errors;
use crate::source::syntax;

/// Compiles one macro call. Faults come out as compile errors at their tokens, together with stubs of the promised items.
#[must_use]
pub fn compile(tokens: TokenStream) -> TokenStream {
    let (source, faults) = syntax::parse_leniently(tokens);
    let models = if faults.is_empty() { pipeline::models(&source) } else { Err(faults) };
    match models {
        Ok(models) => models.iter().map(emit::model).collect(),
        Err(faults) => {
            let mut items = compile_errors(&faults);
            items.extend(emit::stub(&source));
            items
        }
    }
}
