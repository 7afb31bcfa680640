//! A golden output run again.
//!
//! In: what was recorded, and the mechanism of now. Out: the run that the record asks for, or why there is none.

use std::ops::ControlFlow;

use bg_model::input::Input;
use bg_model::run::{Request, RunError, Trajectory};
use thiserror::Error;

use super::GoldenError;
use super::file::Golden;
use crate::ask::inputs;
use crate::ask::machine::MachineError;
use crate::ask::parameters::{Chosen, Values, set};
use crate::ask::scenes::{Models, Scene};
use crate::run::recipe::input_files;

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

/// A golden output that fits the mechanism.
pub(crate) struct Prepared<'a> {
    pub golden: Golden,
    pub parameters: Values,
    inputs: Vec<Input>,
    scene: &'a Scene,
    models: &'a Models,
    request: Request,
}

impl<'a> Prepared<'a> {
    /// Looks whether the mechanism with these models has what the record names.
    pub fn new(golden: Golden, models: &'a Models) -> Result<Self, GoldenError> {
        let path = golden.files.toml();
        let record = &golden.record;
        let unknown = || GoldenError::Scene { path: path.clone(), scene: record.scene.clone() };
        let scene = models.named(&record.scene).ok_or_else(unknown)?;
        let mut chosen = Chosen::new(models.graph().description.parameters);
        let place = path.display().to_string();
        for (name, value) in &record.parameters {
            set(&mut chosen, &place, name, *value)?;
        }
        let request =
            record.run.request(0.0, None).map_err(|fault| GoldenError::Request { path: path.clone(), fault })?;
        let (inputs, named) = inputs::chosen_and_named(&record.inputs, scene.description.inputs)?;
        let files = input_files(&named);
        // A record that has no CRC-32 of a file is of an earlier version.
        let other = record.input_files.iter().find(|(input, crc32)| files.get(*input) != Some(*crc32));
        if let Some((input, _)) = other {
            return Err(GoldenError::InputFile { path, input: input.clone() });
        }
        Ok(Self { parameters: chosen.values, inputs, scene, models, request, golden })
    }

    /// Makes the run.
    pub fn run(&self) -> Result<Trajectory, RunFault> {
        let machine = self.models.made(self.scene, &self.parameters, &self.inputs)?;
        Ok(machine.run(self.request.clone(), None, &mut |_| ControlFlow::Continue(()))?)
    }
}
