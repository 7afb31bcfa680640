//! What is measured: a scene with parameters and the solution that it is held against.

use bg_model::extended::Accuracy;
use bg_model::parameters::ParameterError;
use bg_model::run::sample_times;
use bg_model::simulation::Recording;
use thiserror::Error;

use crate::ask::machine::{Absent, Machine, MachineError};
use crate::ask::reference::ReferenceError;
use crate::ask::scenes::{Fixed, Models, Scene};

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
    /// It is computed, in double-double arithmetic at a hundred instants, of what has
    /// [`Machine::solution`].
    Computed,
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
    /// None is computed.
    #[error("no solution to measure against: {0}")]
    Absent(#[from] Absent),
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

    /// Its model, one of `models`.
    ///
    /// # Errors
    /// Parameters that cannot be.
    pub(crate) fn machine(&self, models: &Models) -> Result<Box<dyn Machine>, CaseError> {
        let mut values = models.defaults();
        self.set.iter().try_for_each(|(name, value)| values.set(name, *value))?;
        models.made(self.scene(&models.scenes), &values, &[]).map_err(|fault| match fault {
            MachineError::Fixed(fault) => fault.into(),
            MachineError::Parameter(fault) => fault.into(),
        })
    }

    /// Its solution.
    ///
    /// # Errors
    /// A computation that fails.
    pub fn solve(&self, models: &Models) -> Result<Recording, CaseError> {
        /// Two digits beyond what a run in double precision can show.
        const ACCURACY: Accuracy = Accuracy { columns: 10, tolerance: 1e-18 };
        if let CaseSolution::Stored(stored) = self.solution {
            return Ok(stored());
        }
        let machine = self.machine(models)?;
        let instants = sample_times(0.0, self.t_end / 100.0, self.t_end);
        Ok(machine.known("reference solutions", machine.solution(ACCURACY, &instants))??.samples)
    }
}
