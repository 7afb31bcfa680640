//! The procedural macro `bond_graph!`.

use proc_macro::TokenStream;

/// Compiles multibond graphs to Rust types that run.
#[proc_macro]
pub fn bond_graph(tokens: TokenStream) -> TokenStream {
    bg_compiler::compile(tokens.into()).into()
}
