//! What a run and its model look like: figures, the picture of the graph, tables, a page, and the files of all that.

#[cfg(not(target_arch = "wasm32"))]
pub mod described;
pub mod extras;
pub mod figures;
pub mod markup;
#[cfg(not(target_arch = "wasm32"))]
pub mod output;
pub mod page;
pub mod picture;
#[cfg(not(target_arch = "wasm32"))]
pub mod sheet;
#[cfg(not(target_arch = "wasm32"))]
pub mod shown;
#[cfg(not(target_arch = "wasm32"))]
pub mod signals;
#[cfg(not(target_arch = "wasm32"))]
pub mod tables;
#[cfg(not(target_arch = "wasm32"))]
pub mod trajectory;
