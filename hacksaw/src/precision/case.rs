//! What is measured: scenes with a reference solution.

use clap::ValueEnum;

use super::reference::Reference;
use crate::scenes::Scene;

/// A scene with a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Case {
    /// The paper's case in the plane
    Paper,
    /// Only where the links are in the paper's case
    Motion,
    /// The rod 25 mm out of the plane: 3-D and stiff
    FullOffset,
    /// Ideal joints
    Rigid,
    /// The paper's case as the multibond graph stands, 85 states
    Literal,
    /// The paper's case in 3-D
    Full,
    /// Only the four angles of the paper's case
    Angles,
    /// The blade off the work, 1 s
    FreeRun,
}

impl Case {
    /// The scene that is run.
    #[must_use]
    pub fn scene(self) -> Scene {
        match self {
            Self::Paper => Scene::Paper,
            Self::Motion => Scene::Motion,
            Self::FullOffset | Self::Full => Scene::Full,
            Self::Rigid => Scene::Rigid,
            Self::Literal => Scene::Literal,
            Self::Angles => Scene::Angles,
            Self::FreeRun => Scene::FreeRun,
        }
    }

    /// What it is held against.
    #[must_use]
    pub fn reference(self) -> Reference {
        match self {
            Self::Paper | Self::Motion | Self::Literal | Self::Full | Self::Angles => Reference::Paper,
            Self::FullOffset => Reference::FullOffset,
            Self::Rigid => Reference::Rigid,
            Self::FreeRun => Reference::FreeRun,
        }
    }

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value().expect("no case is skipped").get_name().to_owned()
    }
}
