//! The models of a graph by name: its scenes and the graph as it stands.
//!
//! In: a mechanism. Out: its models, each with its name on the command line; the parameters of one of them, from values
//! of the whole table.

use bg_model::description::Description;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::Parameters;
use thiserror::Error;

use crate::parameters::number;

/// A model: a scene, or the literal one that the scenes are reduced from.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its number, as [`Scenes::model`] has it.
    pub index: usize,
    /// The name on the command line: `literal`, or the scene's name in small letters with hyphens.
    pub name: String,
    /// What it consists of.
    pub description: &'static Description,
}

/// The scenes in the order of the text, then the literal model, where there is one.
#[must_use]
pub fn scenes<Me: Scenes>() -> Vec<Scene> {
    let scene = |index| {
        let description = Me::model(index, Describe);
        Scene { index, name: in_small_letters(description.name), description }
    };
    let mut scenes: Vec<Scene> = (usize::from(Me::LITERAL)..Me::MODELS).map(scene).collect();
    if !Me::LITERAL {
        return scenes;
    }
    let is_taken = scenes.iter().any(|scene| scene.name == LITERAL);
    let literal = scene(0);
    let name = if is_taken { literal.name.clone() } else { LITERAL.to_owned() };
    scenes.push(Scene { name, ..literal });
    scenes
}

const LITERAL: &str = "literal";

struct Describe;

impl MechanismVisitor for Describe {
    type Output = &'static Description;

    fn visit<Me: Mechanism>(self) -> &'static Description {
        Me::describe()
    }
}

/// `FreeRun` as `free-run`.
pub(crate) fn in_small_letters(name: &str) -> String {
    let mut text = String::new();
    let mut after_small = false;
    for c in name.chars() {
        if c.is_uppercase() && after_small {
            text.push('-');
        }
        after_small = c.is_lowercase();
        text.extend(if c == '_' { vec!['-'] } else { c.to_lowercase().collect() });
    }
    text
}

impl Scene {
    /// Whether the parameter called `name` stays adjustable.
    #[must_use]
    pub fn adjusts(&self, name: &str) -> bool {
        self.description.parameters.iter().any(|info| info.name == name)
    }

    /// Its name and, where there are several, what it is: the first sentence of its documentation.
    #[must_use]
    pub fn summary(&self) -> String {
        let doc = self.description.doc.split_whitespace().collect::<Vec<_>>().join(" ");
        let end = doc.find(". ").map_or(doc.len(), |end| end + 1);
        doc[..end].trim_end_matches('.').to_owned()
    }
}

/// A value that a scene cannot take.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("scene `{scene}` keeps `{name}` fixed at {value}; use --scene {adjusting}")]
pub struct Fixed {
    /// The scene.
    pub scene: String,
    /// The parameter.
    pub name: &'static str,
    /// Its index in the full table.
    pub index: usize,
    /// What the scene keeps it at, with its unit.
    pub value: String,
    /// The first scene that leaves it adjustable.
    pub adjusting: String,
}

/// Whether `scene`, one of `scenes`, can have these values of the whole table.
///
/// # Errors
/// The first value that differs from the one that the scene keeps the parameter at.
pub fn check_fixed<P: Parameters>(scene: &Scene, scenes: &[Scene], values: &P) -> Result<(), Fixed> {
    let table = P::table().iter().enumerate();
    let fixed = table.filter(|(index, info)| values.value(*index) != info.default && !scene.adjusts(info.name));
    match fixed.into_iter().next() {
        None => Ok(()),
        Some((index, info)) => Err(Fixed {
            scene: scene.name.clone(),
            name: info.name,
            index,
            value: format!("{} {}", number(info.default), info.unit).trim_end().to_owned(),
            adjusting: scenes
                .iter()
                .find(|scene| scene.adjusts(info.name))
                .map_or_else(String::new, |scene| scene.name.clone()),
        }),
    }
}

/// The own parameters of `scene`, one of `scenes`, by name from `values` of the whole table.
///
/// # Errors
/// As [`check_fixed`].
pub fn own_parameters<P: Parameters, All: Parameters>(
    scene: &Scene,
    scenes: &[Scene],
    values: &All,
) -> Result<P, Fixed> {
    check_fixed(scene, scenes, values)?;
    let mut own = P::default();
    for (index, info) in All::table().iter().enumerate() {
        if let Some(place) = P::table().iter().position(|kept| kept.name == info.name) {
            own.set_value(place, values.value(index));
        }
    }
    Ok(own)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_small_letters() {
        let names = ["FreeRun", "Paper", "Full3D", "gen_two", "DCMotor"].map(in_small_letters);
        assert_eq!(names, ["free-run", "paper", "full3d", "gen-two", "dcmotor"]);
    }
}
