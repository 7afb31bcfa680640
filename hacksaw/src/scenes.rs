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
