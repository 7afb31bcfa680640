//! What a run was made with: all that its bits depend on, as `summary.json` has it.
//!
//! In: the program, its model and what was asked for. Out: a recipe, which reads back from the file. Models and files
//! are known by CRC-32: it guards against mistakes, not against forgery.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ask::request::Integration;
use crate::ask::table_file::TableFile;
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

/// The file of a model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    /// Its name, without its folder.
    pub name: String,
    /// The CRC-32 of its bytes; files that it uses are not among them.
    pub crc32: String,
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
    /// The file that the model was read from; none of a compiled one. A file with other words for the same gives the
    /// same run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model_file: Option<ModelFile>,
    /// The commit that the model is from, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
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
    /// The tables of a text that had the points of other files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tables: Vec<TableFile>,
    /// How it was integrated.
    pub integration: Integration,
    /// Where it began.
    pub begin: Begin,
}

impl Recipe {
    /// What the model was read from, and the commit, in words; nothing where neither is known.
    #[must_use]
    pub fn origin(&self) -> Option<String> {
        let file = self.model_file.as_ref().map(|ModelFile { name, crc32 }| format!("{name}, CRC-32 {crc32}"));
        let commit = self.commit.as_ref().map(|commit| format!("commit {commit}"));
        let known: Vec<String> = file.into_iter().chain(commit).collect();
        (!known.is_empty()).then(|| known.join(", "))
    }
}

#[cfg(not(target_arch = "wasm32"))]
pub use read::{AgainError, fingerprint, input_files, quantities, read};

#[cfg(not(target_arch = "wasm32"))]
mod read {
    //! Recipes read back, and what they know files and models by.

    use std::collections::BTreeMap;
    use std::path::{Path, PathBuf};

    use bg_model::description::{Description, ParameterInfo};
    use thiserror::Error;

    use super::{Quantity, Recipe};
    use crate::ask::inputs::Named;
    use crate::ask::parameters::Values;
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

    /// All parameters by their names.
    pub fn quantities(values: &Values) -> BTreeMap<String, Quantity> {
        let quantity = |(info, value): (&ParameterInfo, f64)| {
            (info.name.to_owned(), Quantity { value, unit: info.unit.to_owned() })
        };
        values.all().map(quantity).collect()
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
