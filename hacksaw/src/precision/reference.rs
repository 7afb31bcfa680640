//! Reference solutions: scenes integrated in double-double arithmetic, stored as tables with their own check.
//!
//! In: a scene with its parameters. Out: its outputs at the sample instants, rounded to `f64` once, at the end. The initial
//! value problem is that of a run: the generated model in [`DoubleDouble`], from the start state that the model has in `f64`.
//! Method: [`bg_model::extended`]. The check of each is a second computation of another order and tolerance; the
//! largest differences between the two are stored beside the table. `cargo run --release -p hacksaw --example
//! make_references` makes both files anew.

use std::error::Error;

use bg_model::extended::{Accuracy, integrate};
use bg_model::nalgebra::SVector;
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::Span;
use bg_model::system::Model;
use serde::{Deserialize, Serialize};

use super::errors::Errors;
use crate::mechanism::{FreeRun, Full, HacksawParameters, Paper, Rigid};
use crate::scenes::Scene;
use crate::trajectory::{Column, Trajectory, sample_times};

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

/// Settings and work of a computation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effort {
    /// Columns of the extrapolation; the order is twice as high.
    pub columns: usize,
    /// Tolerance of a step.
    pub tolerance: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, those on the search for events included.
    pub rejected: u64,
    /// Evaluations of the rate function.
    pub rate_evaluations: u64,
    /// The times of the switchings, s.
    pub events: Vec<f64>,
}

/// What a computation gives.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The outputs at the instants, those that are gaps left out; for the paper's case also the links' angles.
    pub trajectory: Trajectory,
    /// What it took.
    pub effort: Effort,
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
            Self::Paper | Self::Rigid => sample_times(0.01, 5.0),
            Self::FullOffset => sample_times(0.05, 5.0),
            Self::FreeRun => sample_times(0.01, 1.0),
        }
    }

    /// The accuracies of the stored computation and of its check. In the stiff case steps are short whatever the order, so
    /// that few columns cost least.
    #[must_use]
    pub const fn accuracies(self) -> [Accuracy; 2] {
        match self {
            Self::FullOffset => [Accuracy { columns: 4, tolerance: 1e-18 }, Accuracy { columns: 3, tolerance: 1e-16 }],
            Self::Paper | Self::Rigid | Self::FreeRun => {
                [Accuracy { columns: 12, tolerance: 1e-24 }, Accuracy { columns: 10, tolerance: 1e-21 }]
            }
        }
    }

    /// The outputs at `instants` (s, ascending, from 0 on), integrated with `accuracy`.
    ///
    /// # Errors
    /// Instants that cannot be, and a run that fails.
    pub fn compute(self, accuracy: Accuracy, instants: &[f64]) -> Result<Solution, Box<dyn Error>> {
        macro_rules! with {
            ($model:ident) => {{
                let own = || self.scene().parameters(&self.parameters());
                follow(&$model::new(own()?)?, &$model::<DoubleDouble>::in_scalar(own()?)?, accuracy, instants)?
            }};
        }
        let mut solution = match self {
            Self::Paper => with!(Paper),
            Self::FullOffset => with!(Full),
            Self::Rigid => with!(Rigid),
            Self::FreeRun => with!(FreeRun),
        };
        if self == Self::Paper {
            solution.trajectory.add_angles()?;
        }
        Ok(solution)
    }

    /// Computes the reference and its check.
    ///
    /// # Errors
    /// A run that fails.
    pub fn make(self) -> Result<(Trajectory, Certificate), Box<dyn Error>> {
        let [stored, check] = self.accuracies();
        let stored = self.compute(stored, &self.instants())?;
        let check = self.compute(check, &self.instants())?;
        let differences = Errors::between(&check.trajectory, &stored.trajectory)?;
        Ok((stored.trajectory, Certificate { stored: stored.effort, check: check.effort, differences }))
    }

    /// The stored table, its columns with units.
    ///
    /// # Panics
    /// The stored file is broken, which a test excludes.
    #[must_use]
    pub fn load(self) -> Trajectory {
        let mut trajectory = Trajectory::read_csv(self.stored().0.as_bytes()).expect("a stored table");
        let outputs = self.scene().description().outputs;
        for column in &mut trajectory.columns {
            let output = outputs.iter().find(|output| output.name == column.name);
            output.map_or("rad", |output| output.unit).clone_into(&mut column.unit);
        }
        trajectory
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

/// Integrates `extended` from the start of `plain`.
fn follow<A, B, const N: usize, const G: usize, const M: usize>(
    plain: &A,
    extended: &B,
    accuracy: Accuracy,
    instants: &[f64],
) -> Result<Solution, Box<dyn Error>>
where
    A: Model<f64, N, G, M>,
    B: Model<DoubleDouble, N, G, M>,
{
    let start = plain.start()?.map(DoubleDouble::from);
    let outputs = plain.description().outputs;
    let kept: Vec<usize> = (0..M).filter(|index| !outputs[*index].name.starts_with("gap_")).collect();
    let column =
        |index: &usize| Column { name: outputs[*index].name.to_owned(), unit: outputs[*index].unit.to_owned() };
    let mut trajectory = Trajectory::new(kept.iter().map(column).collect());
    let mut y = SVector::from_element(DoubleDouble::default());
    let span = Span { t0: 0.0, t_end: instants.last().copied().unwrap_or(0.0) };
    let finish = integrate(extended, &start, span, accuracy, instants, |t, x, negative| {
        extended.outputs(t, x, negative, &mut y);
        trajectory.push(t.to_f64(), kept.iter().map(|index| y[*index].to_f64()).collect());
    })?;
    let effort = Effort {
        columns: accuracy.columns,
        tolerance: accuracy.tolerance,
        steps: finish.steps,
        rejected: finish.rejected,
        rate_evaluations: finish.rate_evaluations,
        events: finish.events.iter().map(|event| event.t.to_f64()).collect(),
    };
    Ok(Solution { trajectory, effort })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::LINKS;

    /// The paper's case by a program of its own in quad precision, `reference/independent.c`: all 501 instants.
    const INDEPENDENT: &str = include_str!("../../reference/independent.csv");

    /// The project's reference solution, made by a Taylor integrator in double precision: 51 instants, 72 columns.
    const SHARED: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/hacksaw_paper.csv"));

    /// The largest difference from `reference` in columns whose names begin with `kind`, at all instants of `theirs`.
    fn largest_difference(theirs: &Trajectory, reference: &Trajectory, kind: char) -> f64 {
        let mut largest = 0.0_f64;
        for column in theirs.columns.iter().filter(|column| column.name.starts_with(kind)) {
            let (values, ours) = (theirs.series(&column.name).unwrap(), reference.series(&column.name).unwrap());
            for (t, value) in theirs.times.iter().zip(values) {
                // Some times are multiples of 0.1 with their rounding: 9e-16 s beside ours.
                let place = (t * 100.0).round() as usize;
                assert!((reference.times[place] - t).abs() < 1e-15);
                let difference = (ours[place] - value).abs();
                assert!(difference.is_finite(), "{} at {t} s", column.name);
                largest = largest.max(difference);
            }
        }
        largest
    }

    #[test]
    fn the_paper_s_reference_is_that_of_an_independent_program_at_every_instant() {
        let mut independent = Trajectory::read_csv(INDEPENDENT.as_bytes()).unwrap();
        let reference = Reference::Paper.load();
        assert_eq!((independent.times.as_slice(), independent.columns.len()), (reference.times.as_slice(), 24));
        for link in LINKS {
            let angles = independent.series(&format!("angle{link}")).unwrap();
            for (name, function) in [("11", Scalar::cos as fn(f64) -> f64), ("21", Scalar::sin)] {
                independent.columns.push(Column { name: format!("R{link}_{name}"), unit: String::new() });
                for (row, angle) in independent.rows.iter_mut().zip(&angles) {
                    row.push(function(*angle));
                }
            }
        }
        // Measured: positions 2.2e-15 m, orientations 3.3e-14, momenta 1.8e-12 kg m/s of 21, angular momenta 2.8e-13 kg m^2/s
        // of 2.6. They grow with the time: the model's lengths and the start are those of the specification rounded to doubles.
        for (kind, allowed) in [('C', 5e-15), ('R', 1e-13), ('p', 5e-12), ('h', 1e-12)] {
            let largest = largest_difference(&independent, &reference, kind);
            assert!(largest > 0.0 && largest <= allowed, "{kind} is off by {largest:e}");
        }
    }

    #[test]
    fn the_project_s_reference_in_double_precision_is_the_same_to_its_rounding() {
        let shared = Trajectory::read_csv(SHARED.as_bytes()).unwrap();
        assert_eq!((shared.times.len(), shared.columns.len()), (51, 72));
        // Measured: positions 9e-14 m, orientations 1.4e-12, momenta 4.9e-11 kg m/s of 21, angular momenta 8.3e-12 kg m^2/s
        // of 2.6: all grow with the time, as the rounding errors of a run in double precision do.
        for (kind, allowed) in [('C', 1e-12), ('R', 1e-11), ('p', 1e-10), ('h', 2e-11)] {
            let largest = largest_difference(&shared, &Reference::Paper.load(), kind);
            assert!(largest <= allowed, "{kind} is off by {largest:e}");
        }
    }

    #[test]
    fn the_stored_table_is_what_the_model_gives() {
        let reference = Reference::Paper.load();
        let instants = &reference.times[..6];
        let accuracy = Accuracy { columns: 10, tolerance: 1e-20 };
        let Solution { trajectory, effort } = Reference::Paper.compute(accuracy, instants).unwrap();
        assert_eq!(trajectory.columns, reference.columns);
        for (ours, stored) in trajectory.rows.iter().zip(&reference.rows) {
            for ((ours, stored), column) in ours.iter().zip(stored).zip(&reference.columns) {
                let error = (ours - stored).abs() / (1.0 + stored.abs());
                assert!(error < 1e-15, "{} is off by {error:e}", column.name);
            }
        }
        assert_eq!(effort.events, Reference::Paper.certificate().stored.events[..2]);
    }

    #[test]
    fn every_reference_has_passed_its_check() {
        let measured =
            [("paper", 501, 99, 60), ("full_offset", 101, 95, 58), ("rigid", 501, 9, 96), ("free_run", 101, 7, 0)];
        for (reference, (name, instants, columns, events)) in Reference::ALL.into_iter().zip(measured) {
            let table = reference.load();
            assert_eq!((reference.name(), table.times.clone()), (name, reference.instants()));
            assert_eq!((table.times.len(), table.columns.len()), (instants, columns), "{name}");
            assert!(table.rows.iter().flatten().all(|value| value.is_finite()), "{name}");
            let Certificate { stored, check, differences } = reference.certificate();
            let settings = [&stored, &check].map(|of| Accuracy { columns: of.columns, tolerance: of.tolerance });
            assert_eq!(settings, reference.accuracies());
            assert_eq!((stored.events.len(), check.events.len()), (events, events), "{name}");
            let Errors { poses, momenta, forces } = differences;
            for (of_kind, allowed) in [(poses, 1e-15), (momenta, 1e-14), (forces, 1e-11)] {
                assert!(of_kind.is_none_or(|measure| measure.largest <= allowed), "{name}: {differences:?}");
            }
        }
    }
}
