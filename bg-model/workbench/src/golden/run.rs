//! A golden output run again.
//!
//! In: what was recorded, and the mechanism of now. Out: the run that the record asks for, or why there is none.

use bg_model::input::Input;
use bg_model::mechanism::Scenes;
use bg_model::parameters::Parameters;
use bg_model::run::{Request, RunError, Trajectory};
use thiserror::Error;

use super::file::Golden;
use super::{GoldenError, record};
use crate::inputs;
use crate::machine::{MachineError, Making};
use crate::parameters::{Chosen, set};
use crate::scenes::Scene;

/// A run that cannot be made any more.
#[derive(Debug, Error)]
pub enum RunFault {
    /// The scene keeps a parameter that it left adjustable, or the parameters cannot be.
    #[error(transparent)]
    Model(#[from] MachineError),
    /// It cannot be started, or stops before its end.
    #[error("the run failed: {0}")]
    Run(#[from] RunError),
}

/// A golden output that fits the mechanism with the parameters `P`.
#[derive(Debug)]
pub(crate) struct Prepared<'a, P> {
    pub golden: Golden,
    pub parameters: P,
    inputs: Vec<Input>,
    scene: &'a Scene,
    scenes: &'a [Scene],
    request: Request,
}

impl<'a, P: Parameters> Prepared<'a, P> {
    /// Looks whether the mechanism with these scenes has what the record names.
    pub fn new(golden: Golden, scenes: &'a [Scene]) -> Result<Self, GoldenError> {
        let path = golden.files.toml();
        let record = &golden.record;
        let unknown = || GoldenError::Scene { path: path.clone(), scene: record.scene.clone() };
        let scene = scenes.iter().find(|scene| scene.name == record.scene).ok_or_else(unknown)?;
        let mut chosen = Chosen::<P>::default();
        let place = path.display().to_string();
        for (name, value) in &record.parameters {
            set(&mut chosen, &place, name, *value)?;
        }
        let request =
            record.run.request(0.0, None).map_err(|fault| GoldenError::Request { path: path.clone(), fault })?;
        let (inputs, named) = inputs::chosen_and_named(&record.inputs, scene.description.inputs)?;
        let files = record::files(&named);
        // A record that has no CRC-32 of a file is of an earlier version.
        let other = record.input_files.iter().find(|(input, crc32)| files.get(*input) != Some(*crc32));
        if let Some((input, _)) = other {
            return Err(GoldenError::InputFile { path, input: input.clone() });
        }
        Ok(Self { parameters: chosen.values, inputs, scene, scenes, request, golden })
    }

    /// Makes the run.
    pub fn run<Me: Scenes<Parameters = P>>(&self) -> Result<Trajectory, RunFault> {
        let Self { parameters, inputs, scene, scenes, request, .. } = self;
        let machine = Making { scene, scenes, values: parameters, inputs }.made::<Me>()?;
        Ok(machine.run(request.clone(), None, &mut |_| ())?)
    }
}
