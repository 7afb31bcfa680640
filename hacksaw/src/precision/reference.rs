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

#[cfg(test)]
mod tests {
    use super::*;
    use bg_model::scalar::Scalar;
    use bg_model::simulation::Column;

    use crate::columns::LINKS;

    /// The paper's case by a program of its own in quad precision, `reference/independent.c`: all 501 instants.
    const INDEPENDENT: &str = include_str!("../../reference/independent.csv");

    /// The project's reference solution, made by a Taylor integrator in double precision: 51 instants, 72 columns.
    const SHARED: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/hacksaw_paper.csv"));

    /// The largest difference from `reference` in columns whose names begin with `kind`, at all instants of `theirs`.
    fn largest_difference(theirs: &Recording, reference: &Recording, kind: char) -> f64 {
        let mut largest = 0.0_f64;
        for column in theirs.columns.iter().filter(|column| column.name.starts_with(kind)) {
            let (values, ours) = (theirs.values(&column.name).unwrap(), reference.values(&column.name).unwrap());
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
        let mut independent = samples::read(INDEPENDENT.as_bytes()).unwrap();
        let reference = Reference::Paper.load();
        assert_eq!((independent.times.as_slice(), independent.columns.len()), (reference.times.as_slice(), 24));
        for link in LINKS {
            let angles = independent.values(&format!("angle{link}")).unwrap().to_vec();
            for (name, function) in [("11", Scalar::cos as fn(f64) -> f64), ("21", Scalar::sin)] {
                let values = angles.iter().map(|angle| function(*angle)).collect();
                independent.columns.push(Column { values, ..Column::new(format!("R{link}_{name}"), "") });
            }
        }
        // Measured: positions 2.2e-15 m, orientations 3.3e-14, momenta 1.8e-12 kg m/s of 21, angular momenta 2.8e-13 kg
        // m^2/s of 2.6. They grow with the time: the model's lengths and the start are those of the specification
        // rounded to doubles.
        for (kind, allowed) in [('C', 5e-15), ('R', 1e-13), ('p', 5e-12), ('h', 1e-12)] {
            let largest = largest_difference(&independent, &reference, kind);
            assert!(largest > 0.0 && largest <= allowed, "{kind} is off by {largest:e}");
        }
    }

    #[test]
    fn the_project_s_reference_in_double_precision_is_the_same_to_its_rounding() {
        let shared = samples::read(SHARED.as_bytes()).unwrap();
        assert_eq!((shared.times.len(), shared.columns.len()), (51, 72));
        // Measured: positions 9e-14 m, orientations 1.4e-12, momenta 4.9e-11 kg m/s of 21, angular momenta 8.3e-12 kg
        // m^2/s of 2.6: all grow with the time, as the rounding errors of a run in double precision do.
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
        let Solution { samples, effort } = Reference::Paper.compute(accuracy, instants).unwrap();
        assert_eq!(samples.columns.len(), reference.columns.len());
        for (ours, theirs) in samples.columns.iter().zip(&reference.columns) {
            assert_eq!((&ours.name, &ours.unit, ours.values.len()), (&theirs.name, &theirs.unit, instants.len()));
            for (value, stored) in ours.values.iter().zip(&theirs.values) {
                let error = (value - stored).abs() / (1.0 + stored.abs());
                assert!(error < 1e-15, "{} is off by {error:e}", ours.name);
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
            assert!(table.columns.iter().flat_map(|column| &column.values).all(|value| value.is_finite()), "{name}");
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
