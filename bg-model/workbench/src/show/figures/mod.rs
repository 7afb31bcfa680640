//! Figures as SVG: curves over time, paths, speed against error; light or dark as the reader prefers.
//!
//! In: curves. Out: SVG text. Every figure has 16 : 9 and follows the reader's colour scheme (`palette`). Curves are
//! thinned to what the eye can see at the drawn size ([`thinning`]), so a file stays below 300 kB whatever the output
//! interval.

#[cfg(not(target_arch = "wasm32"))]
pub mod bode;
#[cfg(not(target_arch = "wasm32"))]
pub mod canvas;
pub mod compact;
#[cfg(not(target_arch = "wasm32"))]
pub mod fit;
#[cfg(not(target_arch = "wasm32"))]
mod lettering;
#[cfg(not(target_arch = "wasm32"))]
pub mod outputs;
#[cfg(not(target_arch = "wasm32"))]
pub mod palette;
#[cfg(not(target_arch = "wasm32"))]
pub mod panel;
#[cfg(not(target_arch = "wasm32"))]
pub mod parallel;
#[cfg(not(target_arch = "wasm32"))]
pub mod plot;
#[cfg(not(target_arch = "wasm32"))]
mod work_precision;

use std::sync::Arc;

pub use bg_analysis::thinning;
use bg_model::simulation::{MissingColumn, Recording};
use thiserror::Error;

#[cfg(not(target_arch = "wasm32"))]
pub use work_precision::{Curve, work_precision};

/// What draws a figure of a run.
pub type Draw = Arc<dyn Fn(&Recording) -> Result<String, FigureError>>;

/// A figure that a run gives.
#[derive(Clone)]
pub struct Figure {
    /// Its file's name, such as `figure_05_crank_angular_momentum.svg`.
    pub file: String,
    /// Its anchor on a page, such as `figure-5`.
    pub anchor: String,
    /// What it shows.
    pub title: String,
    /// What is said below it; empty where there is nothing to say.
    pub caption: String,
    /// Draws it.
    pub draw: Draw,
}

impl std::fmt::Debug for Figure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Figure({:?})", self.file)
    }
}

/// A figure that cannot be drawn.
#[derive(Debug, Error)]
pub enum FigureError {
    /// The run lacks a column.
    #[error(transparent)]
    Column(#[from] MissingColumn),
    /// The run has no sample.
    #[error("there is no sample to draw")]
    Empty,
    /// The drawing crate refuses.
    #[error("drawing failed: {0}")]
    Drawing(String),
}
