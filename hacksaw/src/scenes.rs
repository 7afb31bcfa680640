//! The scenes of the hacksaw by a name that the compiler knows.

use bg_model::description::Description;
use bg_model::mechanism::{MechanismVisitor, Scenes};
use bg_model::parameters::Parameters;
use bg_workbench::Compiled;
use bg_workbench::parameters::Values;
use bg_workbench::scenes::{self, Fixed};

use crate::mechanism::{Hacksaw, HacksawParameters};

/// A scene, or the literal model that the scenes are reduced from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// The paper's case, reduced to the plane.
    Paper,
    /// Where the links are in the paper's case, and nothing else.
    Motion,
    /// The three-dimensional motion, every parameter adjustable.
    Full,
    /// Only the angles of the four links.
    Angles,
    /// The ideal mechanism with rigid joints.
    Rigid,
    /// The blade off the work.
    FreeRun,
    /// The multibond graph as it stands, nothing left out.
    Literal,
}

impl Scene {
    /// All, in the order of listing.
    pub const ALL: [Self; 7] =
        [Self::Paper, Self::Motion, Self::Full, Self::Angles, Self::Rigid, Self::FreeRun, Self::Literal];

    /// Hands the scene's type to `visitor`.
    pub fn visit<V: MechanismVisitor>(self, visitor: V) -> V::Output {
        Hacksaw::model(self.record().index, visitor)
    }

    /// Whether the scene has the literal model's joints, so that it moves the same way.
    #[must_use]
    pub fn is_compliant(self) -> bool {
        self != Self::Rigid
    }

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        self.record().name
    }

    /// The tables of the scene's model.
    #[must_use]
    pub fn description(self) -> &'static Description {
        self.record().description
    }

    /// The scene's own parameters, by name from `values`.
    ///
    /// # Errors
    /// A value differs from the one that the scene keeps the parameter at.
    pub fn parameters<P: Parameters>(self, values: &HacksawParameters) -> Result<P, Fixed> {
        let own =
            scenes::own_values(&self.record(), &scenes::scenes(&Compiled::<Hacksaw>::new()), &Values::of(values))?;
        Ok(P::of_values(own.values()))
    }

    /// The workbench's record of it, which lists the scenes in the same order.
    fn record(self) -> scenes::Scene {
        scenes::scenes(&Compiled::<Hacksaw>::new()).swap_remove(self as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::has_reference_columns;
    use crate::mechanism::{FreeRunParameters, PaperParameters};

    #[test]
    fn every_name_leads_to_its_model() {
        let of = |scene: Scene| (scene.name(), scene.description().name, scene.description().states.len());
        let expected = [
            ("paper", "Paper", 31),
            ("motion", "Motion", 29),
            ("full", "Full", 83),
            ("angles", "Angles", 24),
            ("rigid", "Rigid", 9),
            ("free-run", "FreeRun", 29),
            ("literal", "Hacksaw", 85),
        ];
        for (scene, (name, model, states)) in Scene::ALL.into_iter().zip(expected) {
            assert_eq!(of(scene), (name.to_owned(), model, states));
        }
        let has_reference =
            |scene: &Scene| has_reference_columns(scene.description().outputs.iter().map(|output| output.name));
        let with_reference: Vec<Scene> = Scene::ALL.into_iter().filter(has_reference).collect();
        assert_eq!(with_reference, [Scene::Paper, Scene::Full, Scene::Literal]);
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
