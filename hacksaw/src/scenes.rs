//! The scenes: which of the generated models a run integrates.
//!
//! In: a scene's name and the values of the hacksaw's full parameter table. Out: that scene's model type, handed to a
//! [`Visitor`], and its own parameters. [`Scene::visit`] is the only place that knows the types behind the names.

use bg_model::description::Description;
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::system::Model;
use clap::ValueEnum;
use thiserror::Error;

use crate::mechanism::{Angles, FreeRun, Full, Hacksaw, HacksawParameters, Motion, Paper, Rigid};
use crate::parameters::number;
use crate::trajectory::reference_columns;

/// A scene, or the literal model that the scenes are reduced from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Scene {
    /// The paper's case, reduced to the plane
    #[default]
    Paper,
    /// Where the links are in the paper's case, and nothing else
    Motion,
    /// The three-dimensional motion, every parameter adjustable
    Full,
    /// The multibond graph as it stands, nothing left out
    Literal,
    /// Only the angles of the four links
    Angles,
    /// The ideal mechanism with rigid joints
    Rigid,
    /// The blade off the work
    FreeRun,
}

/// Something to do with a model, whatever its type.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Is given how the model is made from its parameters `P`.
    fn visit<P, Mo, const N: usize, const G: usize, const M: usize>(
        self,
        new: fn(P) -> Result<Mo, ParameterError>,
    ) -> Self::Output
    where
        P: Parameters + 'static,
        Mo: Model<f64, N, G, M> + 'static;
}

/// A value that a scene cannot take.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("scene `{}` keeps `{name}` fixed at {value}; use --scene {}", .scene.name(), .adjusting.name())]
pub struct Fixed {
    /// The scene.
    pub scene: Scene,
    /// The parameter.
    pub name: &'static str,
    /// Its index in the full table.
    pub index: usize,
    /// What the scene keeps it at, with its unit.
    pub value: String,
    /// The first scene that leaves it adjustable.
    pub adjusting: Scene,
}

impl Scene {
    /// Hands the scene's types to `visitor`.
    pub fn visit<V: Visitor>(self, visitor: V) -> V::Output {
        match self {
            Self::Paper => visitor.visit(Paper::new),
            Self::Motion => visitor.visit(Motion::new),
            Self::Full => visitor.visit(Full::new),
            Self::Literal => visitor.visit(Hacksaw::new),
            Self::Angles => visitor.visit(Angles::new),
            Self::Rigid => visitor.visit(Rigid::new),
            Self::FreeRun => visitor.visit(FreeRun::new),
        }
    }

    /// All scenes, in the order of listing.
    #[must_use]
    pub fn all() -> &'static [Self] {
        Self::value_variants()
    }

    /// Whether the scene has the literal model's joints, so that it moves the same way.
    #[must_use]
    pub fn is_compliant(self) -> bool {
        self != Self::Rigid
    }

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value().expect("no scene is skipped").get_name().to_owned()
    }

    /// The tables of the scene's model.
    #[must_use]
    pub fn description(self) -> &'static Description {
        struct Describe;
        impl Visitor for Describe {
            type Output = &'static Description;

            fn visit<P, Mo, const N: usize, const G: usize, const M: usize>(
                self,
                new: fn(P) -> Result<Mo, ParameterError>,
            ) -> Self::Output
            where
                P: Parameters,
                Mo: Model<f64, N, G, M>,
            {
                new(P::default()).expect("defaults are in their ranges: the compiler checks it").description()
            }
        }
        self.visit(Describe)
    }

    /// Whether the parameter called `name` stays adjustable.
    #[must_use]
    pub fn adjusts(self, name: &str) -> bool {
        self.description().parameters.iter().any(|info| info.name == name)
    }

    /// Whether the scene's outputs include all columns of the reference trajectory, which figures and checks need.
    #[must_use]
    pub fn has_reference_columns(self) -> bool {
        let outputs = self.description().outputs;
        reference_columns().iter().all(|column| outputs.iter().any(|output| output.name == column))
    }

    /// The scene's own parameters, by name from `values`.
    ///
    /// # Errors
    /// A value differs from the one that the scene keeps the parameter at.
    pub fn parameters<P: Parameters>(self, values: &HacksawParameters) -> Result<P, Fixed> {
        let mut own = P::default();
        for (index, info) in HacksawParameters::table().iter().enumerate() {
            let value = values.value(index);
            if let Some(place) = P::table().iter().position(|kept| kept.name == info.name) {
                own.set_value(place, value);
            } else if value != info.default {
                let adjusting = Self::all().iter().copied().find(|scene| scene.adjusts(info.name));
                return Err(Fixed {
                    scene: self,
                    name: info.name,
                    index,
                    value: format!("{} {}", number(info.default), info.unit).trim_end().to_owned(),
                    adjusting: adjusting.unwrap_or(Self::Literal),
                });
            }
        }
        Ok(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{FreeRunParameters, PaperParameters};

    #[test]
    fn every_name_leads_to_its_model() {
        let of = |scene: Scene| (scene.name(), scene.description().name, scene.description().states.len());
        let expected = [
            ("paper", "Paper", 31),
            ("motion", "Motion", 29),
            ("full", "Full", 83),
            ("literal", "Hacksaw", 85),
            ("angles", "Angles", 24),
            ("rigid", "Rigid", 28),
            ("free-run", "FreeRun", 29),
        ];
        for (&scene, (name, model, states)) in Scene::all().iter().zip(expected) {
            assert_eq!(of(scene), (name.to_owned(), model, states));
        }
        let with_reference = Scene::all().iter().filter(|scene| scene.has_reference_columns());
        assert_eq!(with_reference.copied().collect::<Vec<_>>(), [Scene::Paper, Scene::Full, Scene::Literal]);
    }

    #[test]
    fn parameters_go_over_by_name() {
        let mut values = HacksawParameters::default();
        values.set("r_return", 12.5).unwrap();
        let own: PaperParameters = Scene::Paper.parameters(&values).unwrap();
        assert_eq!(own.get("r_return"), Some(12.5));
        assert_eq!(own.get("rod_offset"), None);
    }

    #[test]
    fn a_value_that_a_scene_keeps_is_refused_with_the_scene_that_takes_it() {
        let mut values = HacksawParameters::default();
        values.set("rod_offset", 0.025).unwrap();
        let fault = Scene::Paper.parameters::<PaperParameters>(&values).unwrap_err();
        assert_eq!(fault.to_string(), "scene `paper` keeps `rod_offset` fixed at 0 m; use --scene full");
        values.set("rod_offset", 0.0).unwrap();
        values.set("k_2", 2e7).unwrap();
        let fault = Scene::FreeRun.parameters::<FreeRunParameters>(&values).unwrap_err();
        assert_eq!(fault.to_string(), "scene `free-run` keeps `k_2` fixed at 1e7 N/m; use --scene paper");
    }
}
