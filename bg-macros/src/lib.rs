//! The procedural macro `bond_graph!`. Its documentation is the reference of the language, a page of `docs/language`
//! for each chapter; users get the macro as `bg_model::bond_graph`, together with what generated code needs at run
//! time.

extern crate proc_macro;

mod file;

use proc_macro::TokenStream;

/// Compiles multibond graphs of mechanisms, machines and circuits to Rust types that run.
///
// The chapters are one page here and a file each elsewhere: these targets take the place of those at their ends.
/// [a-delay]: #a-delay
/// [angles-and-ways]: #angles-and-ways
/// [arrays-and-repetitions]: #arrays-and-repetitions
/// [causality]: #causality
/// [derivative-causality]: #derivative-causality
/// [dry-friction]: #dry-friction
/// [events]: #events
/// [expressions]: #expressions
/// [faults]: #faults
/// [generated-items]: #generated-items
/// [mechanism-words]: #mechanism-words
/// [observe]: #observe
/// [outputs]: #outputs
/// [parts]: #parts
/// [refused-values]: #refused-values
/// [rigid-joints]: #rigid-joints
/// [sampled-blocks]: #every
/// [scenes]: #scenes
/// [start-poses]: #start-poses
/// [start-velocities]: #start-velocities
/// [statements]: #statements
/// [stops-with-a-restitution]: #stops-with-a-restitution
/// [tables]: #table
/// [the-library]: #the-library
/// [the-square-root-at-zero]: #the-square-root-at-zero
/// [the-start]: #the-start
/// [units]: #units
#[doc = include_str!("../docs/language/README.md")]
#[doc = include_str!("../docs/language/statements.md")]
#[doc = include_str!("../docs/language/expressions.md")]
#[doc = include_str!("../docs/language/units.md")]
#[doc = include_str!("../docs/language/mechanisms.md")]
#[doc = include_str!("../docs/language/parts.md")]
#[doc = include_str!("../docs/language/library.md")]
#[doc = include_str!("../docs/language/scenes.md")]
#[doc = include_str!("../docs/language/start.md")]
#[doc = include_str!("../docs/language/values.md")]
#[doc = include_str!("../docs/language/causality.md")]
#[doc = include_str!("../docs/language/events.md")]
#[doc = include_str!("../docs/language/outputs.md")]
#[doc = include_str!("../docs/language/generated-items.md")]
#[doc = include_str!("../docs/language/faults.md")]
#[proc_macro]
pub fn bond_graph(tokens: TokenStream) -> TokenStream {
    let tokens = tokens.into();
    match file::named(&tokens) {
        Some(named) => {
            let root = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default();
            file::compile(&named, root.as_ref()).into()
        }
        None => bg_compiler::compile(tokens).into(),
    }
}

/// The picture of a bond graph as HTML, for the documentation of a generated model. Only generated code calls it.
#[doc(hidden)]
#[proc_macro]
pub fn picture(tokens: TokenStream) -> TokenStream {
    bg_compiler::emit::picture(tokens.into()).into()
}
