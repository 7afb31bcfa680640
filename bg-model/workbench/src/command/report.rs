//! The command `report`: a run, and one page that shows it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::InputError;
use super::arguments::{IntegrationArguments, ReportArguments};
use super::linearize::{check_time, linearised};
use super::run::simulate;
use crate::ask::machine::Machine;
use crate::live::{Module, ModuleError};
use crate::program::Program;
use crate::show::page::Linearised;
use crate::show::page::film::Film;
use crate::show::shown::{PageFiles, PageForm};

/// What a report is to show beside the run.
pub struct Look {
    /// Its files.
    pub files: PageFiles,
    /// More drawings, each with its title: SVG texts.
    pub drawings: Vec<(String, String)>,
    /// Where to linearise, if at all: at a time, s, or at the equilibrium.
    pub modes: Option<Option<f64>>,
    /// Of a page in a frame, where the picture of the graph is kept for another report of it.
    pub picture: Option<PathBuf>,
    /// How the run is integrated.
    pub integration: IntegrationArguments,
    /// Where the program is from that runs in the page, where one is wanted.
    pub module: Option<Module>,
}

pub fn report(program: &Program, arguments: &ReportArguments) -> Result<ExitCode, InputError> {
    let ReportArguments { run, glb, modes, show, live, frame } = arguments;
    let name = program.texts.stem();
    let glb = glb.then(|| format!("{name}.glb"));
    let form = if frame.is_some() { PageForm::Framed } else { PageForm::Whole };
    let files = PageFiles { page: format!("{name}.html"), form, figures: false, glb };
    let drawings = show.iter().map(|path| drawing(path)).collect::<Result<_, _>>()?;
    check_time("--modes", modes.flatten())?;
    if live.is_some() && program.texts.file.is_some() {
        return Err(ModuleError::Text.into());
    }
    let integration = run.integration.clone();
    let module = live.as_ref().map(|file| Module::from(file.clone()));
    let look = Look { files, drawings, modes: *modes, picture: frame.clone(), integration, module };
    simulate(program, run, Some(&look))
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
    /// Whether the page is for a frame.
    pub fn is_framed(&self) -> bool {
        self.files.form == PageForm::Framed
    }

    /// The modes, where they are wanted, or a sentence why there are none: of a machine that has no equilibrium, or
    /// does not come to the instant, the rest of the page stands.
    pub fn modes(&self, machine: &dyn Machine) -> Result<Option<Result<Linearised, String>>, InputError> {
        let Some(at) = self.modes else { return Ok(None) };
        match self.linearised(machine, at) {
            Ok(found) => Ok(Some(Ok(found))),
            Err(fault @ (InputError::Linear(_) | InputError::NotReached { .. })) => Ok(Some(Err(fault.to_string()))),
            Err(fault) => Err(fault),
        }
    }

    fn linearised(&self, machine: &dyn Machine, at: Option<f64>) -> Result<Linearised, InputError> {
        let (space, place) = linearised(machine, at, &|t| self.integration.integration().request_to(t))?;
        let x: Vec<f64> = space.point.iter().map(|state| state.value).collect();
        let rest = Film::still(machine, space.t, &x).animation();
        Ok(Linearised { modes: space.modes, place, rest })
    }
}
