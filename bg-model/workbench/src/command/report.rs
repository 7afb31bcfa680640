//! The command `report`: a run, and one page that shows it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use bg_model::mechanism::{Mechanism, Scenes};
use bg_model::run::Simulation;

use super::InputError;
use super::arguments::ReportArguments;
use super::run::simulate;
use crate::Program;
use crate::linear::{equilibrium, linearise};
use crate::output::ReportFiles;
use crate::page::{Linearised, Views};

/// What a report is to show beside the run.
pub struct Look {
    /// Its files.
    pub files: ReportFiles,
    /// More drawings, each with its title: SVG texts.
    pub drawings: Vec<(String, String)>,
    /// Whether to linearise.
    pub modes: bool,
}

pub fn report<Me: Scenes>(program: &Program<Me>, arguments: &ReportArguments) -> Result<ExitCode, InputError> {
    let ReportArguments { run, glb, modes, show } = arguments;
    let name = &program.texts.name;
    let files = ReportFiles { page: format!("{name}.html"), glb: glb.then(|| format!("{name}.glb")) };
    let drawings = show.iter().map(|path| drawing(path)).collect::<Result<_, _>>()?;
    simulate(program, run, Some(&Look { files, drawings, modes: *modes }))
}

/// A drawing with its file's name as title.
fn drawing(path: &Path) -> Result<(String, String), InputError> {
    let failed = |fault: String| InputError::Show { path: PathBuf::from(path), fault };
    let svg = std::fs::read_to_string(path).map_err(|fault| failed(format!("cannot be read: {fault}")))?;
    if !svg.contains("<svg") {
        return Err(failed("has no <svg".to_owned()));
    }
    let title = path.file_stem().unwrap_or_default().to_string_lossy().replace('_', " ");
    Ok((title, svg))
}

impl Look {
    /// What is known of the model before it is run.
    pub fn before<Sc: Mechanism>(&self, model: &Sc) -> Result<Views, InputError> {
        let modes = if self.modes { Some(linearised(model)?) } else { None };
        Ok(Views { modes, ..Views::default() })
    }
}

/// The modes at the equilibrium near the start, inputs as at t = 0.
fn linearised<Sc: Mechanism>(model: &Sc) -> Result<Linearised, InputError> {
    let start: Vec<f64> = Simulation::new(model).start()?.states.iter().map(|(_, value)| *value).collect();
    let rest = equilibrium(model, 0.0, &start)?;
    let space = linearise(model, 0.0, &rest.x)?;
    Ok(Linearised { modes: space.modes, rest: None })
}
