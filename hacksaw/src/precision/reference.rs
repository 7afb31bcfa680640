//! Reference solutions: scenes integrated in double-double arithmetic, stored as tables with their own check.
//!
//! In: a scene with its parameters. Out: its outputs at the sample instants, rounded to `f64` once, at the end. The
//! initial value problem is that of a run: the generated model in `DoubleDouble`, from the start state that the model
//! has in `f64`. Method: [`bg_model::extended`]. The check of each is a second computation of another order and
//! tolerance; the largest differences between the two are stored beside the table. `cargo run --release -p hacksaw
//! --example make_references` makes both files anew.

use std::error::Error;

use bg_model::extended::Accuracy;
use bg_model::mechanism::{Mechanism, MechanismVisitor};
use bg_model::run::sample_times;
use bg_model::simulation::Recording;
use bg_workbench::precision::errors::Errors;
use bg_workbench::precision::reference::{Effort, Solution, solve};
use bg_workbench::samples;
use serde::{Deserialize, Serialize};

use crate::columns::add_angles;
use crate::mechanism::HacksawParameters;
use crate::scenes::Scene;

/// A case with a stored reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// The paper's case; also that of the scenes `literal`, `angles`, and `full` with its defaults.
    Paper,
    /// The scene `full` with the rod 25 mm out of the plane: stiff.
    FullOffset,
    /// The ideal mechanism.
    Rigid,
    /// The blade off the work; 1 s, after which the motion is chaotic.
    FreeRun,
}

/// How a stored reference was made, and its check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// The computation that is stored.
    pub stored: Effort,
    /// The computation that it was compared with.
    pub check: Effort,
    /// The differences between the two, both rounded to `f64`.
    pub differences: Errors,
}

/// The table and the certificate of a reference.
macro_rules! stored {
    ($name:literal) => {
        (
            include_str!(concat!("../../reference/", $name, ".csv")),
            include_str!(concat!("../../reference/", $name, ".toml")),
        )
    };
}

impl Reference {
    /// All that are stored.
    pub const ALL: [Self; 4] = [Self::Paper, Self::FullOffset, Self::Rigid, Self::FreeRun];

    /// The name of its files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::FullOffset => "full_offset",
            Self::Rigid => "rigid",
            Self::FreeRun => "free_run",
        }
    }

    /// The scene that is integrated.
    #[must_use]
    pub const fn scene(self) -> Scene {
        match self {
            Self::Paper => Scene::Paper,
            Self::FullOffset => Scene::Full,
            Self::Rigid => Scene::Rigid,
            Self::FreeRun => Scene::FreeRun,
        }
    }

    /// Its parameters.
    #[must_use]
    pub fn parameters(self) -> HacksawParameters {
        let rod_offset = if self == Self::FullOffset { 0.025 } else { 0.0 };
        HacksawParameters { rod_offset, ..HacksawParameters::default() }
    }

    /// Its instants, s, from 0 to the end of the run.
    #[must_use]
    pub fn instants(self) -> Vec<f64> {
        match self {
            Self::Paper | Self::Rigid => sample_times(0.0, 0.01, 5.0),
            Self::FullOffset => sample_times(0.0, 0.05, 5.0),
            Self::FreeRun => sample_times(0.0, 0.01, 1.0),
        }
    }

    /// The accuracies of the stored computation and of its check. In the stiff case steps are short whatever the order,
    /// so that few columns cost least.
    #[must_use]
    pub const fn accuracies(self) -> [Accuracy; 2] {
        match self {
            Self::FullOffset => [Accuracy { columns: 4, tolerance: 1e-18 }, Accuracy { columns: 3, tolerance: 1e-16 }],
            Self::Paper | Self::Rigid | Self::FreeRun => {
                [Accuracy { columns: 12, tolerance: 1e-24 }, Accuracy { columns: 10, tolerance: 1e-21 }]
            }
        }
    }

    /// The outputs at `instants` (s, ascending, from 0 on), integrated with `accuracy`. Compiled where it is called,
    /// since the program calls it nowhere.
    ///
    /// # Errors
    /// Instants that cannot be, and a run that fails.
    #[inline]
    pub fn compute(self, accuracy: Accuracy, instants: &[f64]) -> Result<Solution, Box<dyn Error>> {
        let mut solution = self.scene().visit(Compute { reference: self, accuracy, instants })?;
        if self == Self::Paper {
            add_angles(&mut solution.samples)?;
        }
        Ok(solution)
    }

    /// Computes the reference and its check. Compiled where it is called, as [`Reference::compute`] is.
    ///
    /// # Errors
    /// A run that fails.
    #[inline]
    pub fn make(self) -> Result<(Recording, Certificate), Box<dyn Error>> {
        let [stored, check] = self.accuracies();
        let stored = self.compute(stored, &self.instants())?;
        let check = self.compute(check, &self.instants())?;
        let differences = Errors::between(&check.samples, &stored.samples, self.scene().description().outputs)?;
        Ok((stored.samples, Certificate { stored: stored.effort, check: check.effort, differences }))
    }

    /// The stored table, its columns with units.
    ///
    /// # Panics
    /// The stored file is broken, which a test excludes.
    #[must_use]
    pub fn load(self) -> Recording {
        let mut samples = samples::read(self.stored().0.as_bytes()).expect("a stored table");
        let outputs = self.scene().description().outputs;
        for column in &mut samples.columns {
            let output = outputs.iter().find(|output| output.name == column.name);
            output.map_or("rad", |output| output.unit).clone_into(&mut column.unit);
        }
        samples
    }

    /// The stored check.
    ///
    /// # Panics
    /// As [`Reference::load`].
    #[must_use]
    pub fn certificate(self) -> Certificate {
        toml::from_str(self.stored().1).expect("a stored certificate")
    }

    const fn stored(self) -> (&'static str, &'static str) {
        match self {
            Self::Paper => stored!("paper"),
            Self::FullOffset => stored!("full_offset"),
            Self::Rigid => stored!("rigid"),
            Self::FreeRun => stored!("free_run"),
        }
    }
}

struct Compute<'a> {
    reference: Reference,
    accuracy: Accuracy,
    instants: &'a [f64],
}

impl MechanismVisitor for Compute<'_> {
    type Output = Result<Solution, Box<dyn Error>>;

    /// Gaps are left out: rounding.
    fn visit<Sc: Mechanism>(self) -> Self::Output {
        let Self { reference, accuracy, instants } = self;
        let model = Sc::make(reference.scene().parameters(&reference.parameters())?, &[])?;
        Ok(solve(&model, accuracy, instants, &|output| !output.starts_with("gap_"))?)
    }
}
