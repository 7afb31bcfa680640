//! A page that compiles: the language of `bond_graph!` in a browser.
//!
//! | module | question it answers |
//! |---|---|
//! | [`answers`] | what the page asks of the compiler, which is a WebAssembly module there |
//! | [`site`] | which files the page consists of |

pub mod answers;
#[cfg(not(target_arch = "wasm32"))]
pub mod examples;
#[cfg(not(target_arch = "wasm32"))]
pub mod site;
