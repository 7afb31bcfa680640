//! What is measured: a scene with parameters and the solution that it is held against.

use std::marker::PhantomData;

use bg_model::extended::Accuracy;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::run::sample_times;
use bg_model::simulation::Recording;
use thiserror::Error;

use super::reference::{self, ReferenceError};
use crate::machine::{Machine, MachineError, Making};
use crate::scenes::{Fixed, Scene, own_parameters};

/// A case.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name on the command line.
    pub name: String,
    /// What it is, in one line.
    pub about: String,
    /// The name of its scene.
    pub scene: String,
    /// The parameters that are not at their defaults.
    pub set: Vec<(&'static str, f64)>,
    /// The end of its runs, s, where its solution is computed.
    pub t_end: f64,
    /// Its solution.
    pub solution: CaseSolution,
}

/// Where the solution of a case comes from.
#[derive(Clone, Copy, Debug)]
pub enum CaseSolution {
    /// It is stored.
    Stored(fn() -> Recording),
    /// It is computed, of the case with its scene among these.
    Computed(fn(&Case, &[Scene]) -> Result<Recording, CaseError>),
}

impl CaseSolution {
    /// It is computed in double-double arithmetic at a hundred instants, for which each model of `Me` is compiled once
    /// more.
    #[must_use]
    pub fn computed<Me: Scenes>() -> Self {
        Self::Computed(|case, scenes| {
            Me::model(case.scene(scenes).index, Solve::<Me> { case, scenes, of: PhantomData })
        })
    }
}

/// A case that cannot be built or solved.
#[derive(Debug, Error)]
pub enum CaseError {
    /// A parameter.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A parameter that the scene keeps.
    #[error(transparent)]
    Fixed(#[from] Fixed),
    /// Its solution.
    #[error("no solution to measure against: {0}")]
    Reference(#[from] ReferenceError),
}

impl Case {
    /// A case for each scene: its defaults until `t_end` (s), with this solution.
    #[must_use]
    pub fn of_scenes(scenes: &[Scene], t_end: f64, solution: CaseSolution) -> Vec<Self> {
        let case = |scene: &Scene| Self {
            name: scene.name.clone(),
            about: scene.summary(),
            scene: scene.name.clone(),
            set: Vec::new(),
            t_end,
            solution,
        };
        scenes.iter().map(case).collect()
    }

    /// Its scene among `scenes`.
    ///
    /// # Panics
    /// There is none.
    #[must_use]
    pub fn scene<'a>(&self, scenes: &'a [Scene]) -> &'a Scene {
        let scene = scenes.iter().find(|scene| scene.name == self.scene);
        scene.unwrap_or_else(|| panic!("there is no scene `{}`", self.scene))
    }

    /// Its model, `Sc` of the mechanism `Me`.
    ///
    /// # Errors
    /// Parameters that cannot be.
    pub fn model<Me: Mechanism, Sc: Mechanism>(&self, scenes: &[Scene]) -> Result<Sc, CaseError> {
        Ok(Sc::make(own_parameters(self.scene(scenes), scenes, &self.values::<Me>()?)?, &[])?)
    }

    /// The same of the mechanism `Me`, whatever its type.
    ///
    /// # Errors
    /// Parameters that cannot be.
    pub(crate) fn machine<Me: Scenes>(&self, scenes: &[Scene]) -> Result<Box<dyn Machine>, CaseError> {
        let values = self.values::<Me>()?;
        let made = Making { scene: self.scene(scenes), scenes, values: &values, inputs: &[] }.made::<Me>();
        made.map_err(|fault| match fault {
            MachineError::Fixed(fault) => fault.into(),
            MachineError::Parameter(fault) => fault.into(),
        })
    }

    /// The values of all parameters.
    fn values<Me: Mechanism>(&self) -> Result<Me::Parameters, ParameterError> {
        let mut values = Me::Parameters::default();
        self.set.iter().try_for_each(|(name, value)| values.set(name, *value))?;
        Ok(values)
    }

    /// Its solution.
    ///
    /// # Errors
    /// A computation that fails.
    pub fn solve(&self, scenes: &[Scene]) -> Result<Recording, CaseError> {
        match self.solution {
            CaseSolution::Stored(stored) => Ok(stored()),
            CaseSolution::Computed(computed) => computed(self, scenes),
        }
    }
}

struct Solve<'a, Me> {
    case: &'a Case,
    scenes: &'a [Scene],
    of: PhantomData<Me>,
}

impl<Me: Mechanism> MechanismVisitor for Solve<'_, Me> {
    type Output = Result<Recording, CaseError>;

    fn visit<Sc: Mechanism>(self) -> Self::Output {
        /// Two digits beyond what a run in double precision can show.
        const ACCURACY: Accuracy = Accuracy { columns: 10, tolerance: 1e-18 };
        let Self { case, scenes, .. } = self;
        let model: Sc = case.model::<Me, Sc>(scenes)?;
        let instants = sample_times(0.0, case.t_end / 100.0, case.t_end);
        Ok(reference::solve(&model, ACCURACY, &instants, |_| true)?.samples)
    }
}
