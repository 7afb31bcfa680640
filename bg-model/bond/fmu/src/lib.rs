//! The library of functional mock-up units whose models are text: `bond fmu` packs it.
//!
//! In: the folder of a unit's resources, with the text of its model ([`Chosen`]). Out: the model, compiled when the
//! first instance is made, and run in machine code where that pays. One library serves all texts.

use std::fs::read_to_string;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::{Mutex, PoisonError};

use bg_fmi::{Exported, MadeBy};
use bg_loaded::{Chosen, Interpreted};
use bg_model::mechanism::Liftable;
use bg_model::scalar::Dual;

bg_fmi::export_found!(crate::found);

/// The models that were made so far, each with what it was made of.
type Made = Vec<(String, &'static MadeBy)>;

static MADE: Mutex<Made> = Mutex::new(Vec::new());

/// The model whose text stands in the folder of a unit's resources.
///
/// # Errors
/// Why there is none, in words.
pub fn found(resources: Option<PathBuf>) -> Result<Vec<&'static dyn Exported>, String> {
    let folder = resources.ok_or("the host does not say where the resources of the unit are, in which its model is")?;
    let file = folder.join(Chosen::FILE);
    let text = read_to_string(&file).map_err(|fault| format!("cannot read {}: {fault}", file.display()))?;
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, model)) = made.iter().find(|(known, _)| *known == text) {
        return Ok(vec![*model]);
    }
    let unusable = |fault: &dyn std::fmt::Display| format!("{}: {fault}", file.display());
    let chosen: Chosen = serde_json::from_str(&text).map_err(|fault| unusable(&fault))?;
    let blueprint = chosen.blueprint().map_err(|fault| unusable(&fault))?;
    let description = blueprint.description();
    let make = Box::new(move |values: &[f64], inputs: &[_]| {
        Ok(Rc::new(Interpreted::new(&blueprint, values, inputs)?) as Rc<dyn Liftable<Dual>>)
    });
    // Instances have it for as long as the library is loaded.
    let model: &'static MadeBy = Box::leak(Box::new(MadeBy { description, make }));
    made.push((text, model));
    Ok(vec![model])
}
