//! The version of the macro, for the run time to compare with its own.

use proc_macro2::TokenStream;
use quote::quote;

/// Generated code of another version than the run time's is one compile error, which says so.
#[must_use]
pub fn version() -> TokenStream {
    let version = env!("CARGO_PKG_VERSION");
    quote!(::bg_model::__private::of_one_version! { #version })
}
