//! The models of a graph by name: its scenes and the graph as it stands.
//!
//! In: what makes models. Out: each with its name on the command line; the parameters of one of them, from values of
//! the whole table, and it made of these.

use bg_model::description::Description;
use bg_model::input::Input;
use thiserror::Error;

use crate::ask::machine::{Machine, MachineError};
use crate::ask::maker::Maker;
use crate::ask::parameters::{Values, number};

/// A model: a scene, or the literal one that the scenes are reduced from.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its number, as [`Maker::models`] has it.
    pub index: usize,
    /// The name on the command line: `literal`, or the scene's name in small letters with hyphens.
    pub name: String,
    /// What it consists of.
    pub description: &'static Description,
}

/// The scenes in the order of the text, then the literal model, where there is one.
#[must_use]
pub fn scenes(maker: &dyn Maker) -> Vec<Scene> {
    let scene = |(index, description): (usize, &'static Description)| Scene {
        index,
        name: in_small_letters(description.name),
        description,
    };
    let mut scenes: Vec<Scene> = maker.models().into_iter().enumerate().map(scene).collect();
    if !maker.is_literal() {
        return scenes;
    }
    let mut literal = scenes.remove(0);
    if scenes.iter().all(|scene| scene.name != LITERAL) {
        LITERAL.clone_into(&mut literal.name);
    }
    scenes.push(literal);
    scenes
}

const LITERAL: &str = "literal";

/// The models of a graph by name, with what makes them.
pub struct Models {
    maker: Box<dyn Maker>,
    /// All, as [`scenes`] lists them.
    pub scenes: Vec<Scene>,
}

impl Models {
    /// Those of `maker`.
    #[must_use]
    pub fn of(maker: impl Maker + 'static) -> Self {
        Self { scenes: scenes(&maker), maker: Box::new(maker) }
    }

    /// What makes them.
    #[must_use]
    pub fn maker(&self) -> &dyn Maker {
        &*self.maker
    }

    /// The one that stands for the graph.
    #[must_use]
    pub fn graph(&self) -> &Scene {
        self.scenes.iter().find(|scene| scene.index == 0).expect("the graph is one of its models")
    }

    /// The parameters of the graph at their defaults.
    #[must_use]
    pub fn defaults(&self) -> Values {
        Values::new(self.graph().description.parameters)
    }

    /// The one called `name`.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&Scene> {
        self.scenes.iter().find(|scene| scene.name == name)
    }

    /// The model of `scene`, one of these, with these values of the graph's parameters and inputs.
    ///
    /// # Errors
    /// [`MachineError`].
    pub fn made(&self, scene: &Scene, values: &Values, inputs: &[Input]) -> Result<Box<dyn Machine>, MachineError> {
        let own = own_values(scene, &self.scenes, values)?;
        Ok(self.maker.make(scene.index, own.values(), inputs)?)
    }
}

/// `FreeRun` as `free-run`.
#[must_use]
pub fn in_small_letters(name: &str) -> String {
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
pub fn check_fixed(scene: &Scene, scenes: &[Scene], values: &Values) -> Result<(), Fixed> {
    let table = values.table().iter().enumerate();
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

/// The values of the own parameters of `scene`, one of `scenes`, by name from `values` of the whole table.
///
/// # Errors
/// As [`check_fixed`].
pub fn own_values(scene: &Scene, scenes: &[Scene], values: &Values) -> Result<Values, Fixed> {
    check_fixed(scene, scenes, values)?;
    let mut own = Values::new(scene.description.parameters);
    for (index, info) in own.table().iter().enumerate() {
        if let Some(value) = values.get(info.name) {
            own.set_value(index, value);
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
