//! What a run was made with: all that its bits depend on, as `summary.json` has it.
//!
//! In: the program, its model and what was asked for. Out: a recipe, which reads back from the file. Models and files
//! are known by CRC-32: it guards against mistakes, not against forgery.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ask::request::Integration;
use crate::run::running::Begin;

/// A value of a parameter with its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// The value, in its unit.
    pub value: f64,
    /// The unit.
    pub unit: String,
}

/// What a run was made with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// The program's name.
    pub program: String,
    /// Its version.
    pub version: String,
    /// The version of the workbench and of what integrates.
    pub workbench: String,
    /// The CRC-32 of the model's equations and of the names of its outputs.
    pub model: String,
    /// The scene.
    pub scene: String,
    /// All parameters of the graph.
    pub parameters: BTreeMap<String, Quantity>,
    /// The inputs that were given, as on the command line.
    pub inputs: Vec<String>,
    /// The CRC-32 of the files that inputs are from, by the inputs' names.
    pub input_files: BTreeMap<String, String>,
    /// How it was integrated.
    pub integration: Integration,
    /// Where it began.
    pub begin: Begin,
}

#[cfg(not(target_arch = "wasm32"))]
pub use read::{AgainError, fingerprint, input_files, read};

#[cfg(not(target_arch = "wasm32"))]
mod read {
    //! Recipes read back, and what they know files and models by.

    use std::collections::BTreeMap;
    use std::path::{Path, PathBuf};

    use bg_model::description::Description;
    use thiserror::Error;

    use super::Recipe;
    use crate::ask::inputs::Named;
    use crate::files::crc32;

    /// A run that cannot be made again.
    #[derive(Debug, Error)]
    #[error("--again {}: {fault}", path.display())]
    pub struct AgainError {
        /// The file.
        pub path: PathBuf,
        /// Why not: a sentence.
        pub fault: String,
    }

    /// Of a model its equations, and what is observed.
    pub fn fingerprint(model: &Description) -> String {
        let outputs = model.outputs.iter().map(|output| output.name);
        crc32(model.equations.iter().copied().chain(outputs).collect::<Vec<_>>().join("\n").as_bytes())
    }

    /// The CRC-32 of the files that inputs are from, by the inputs' names.
    pub fn input_files(inputs: &[Named]) -> BTreeMap<String, String> {
        let source =
            |input: &Named| Some((input.name.to_owned(), input.table.as_ref()?.source.as_ref()?.crc32.clone()));
        inputs.iter().filter_map(source).collect()
    }

    /// The recipe in the `summary.json` at `path`.
    ///
    /// # Errors
    /// It cannot be read, or has none.
    pub fn read(path: &Path) -> Result<Recipe, AgainError> {
        let failed = |fault: String| AgainError { path: path.to_owned(), fault };
        let text = std::fs::read_to_string(path).map_err(|fault| failed(format!("cannot be read: {fault}")))?;
        let mut json: serde_json::Value = serde_json::from_str(&text)
            .map_err(|fault| failed(format!("is no JSON: {fault}; give the summary.json of a run")))?;
        let recipe = json.get_mut("recipe").map(serde_json::Value::take);
        let recipe = recipe.ok_or_else(|| failed("has no `recipe`; give the summary.json of a run".to_owned()))?;
        serde_json::from_value(recipe).map_err(|fault| failed(format!("its recipe cannot be read: {fault}")))
    }
}
