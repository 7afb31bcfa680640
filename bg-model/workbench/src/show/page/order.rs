//! What a page that runs its model again asks for.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ask::inputs::Setting;
use crate::ask::request::Integration;
use crate::run::running::Begin;

/// What a page asks for: a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// The scene, by its name on the command line.
    pub scene: String,
    /// The parameters that are not at their defaults.
    pub parameters: BTreeMap<String, f64>,
    /// The inputs in the order of the model's description; those that are missing are 0.
    pub inputs: Vec<Setting>,
    /// How it is integrated.
    pub integration: Integration,
    /// Where it begins.
    pub begin: Begin,
}

/// A report that can run its model again.
#[derive(Clone, Debug, PartialEq)]
pub struct Live {
    /// The program, compiled for WebAssembly for the order's scene.
    pub module: Vec<u8>,
    /// The run that the page shows first.
    pub order: Order,
}
