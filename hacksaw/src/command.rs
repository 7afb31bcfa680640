//! The program `hacksaw`: the workbench with the paper's figures, statements and reference solutions on top.

use std::env::ArgsOs;
use std::process::ExitCode;

use bg_model::description::Description;
use bg_model::simulation::{MissingColumn, Recording};
use bg_workbench::Program;
use bg_workbench::extras::{Extras, Page};
#[cfg(not(target_arch = "wasm32"))]
use bg_workbench::figures::Figure;
use bg_workbench::summary::Additions;

use crate::columns::{forces, has_reference_columns, reference_columns};
#[cfg(not(target_arch = "wasm32"))]
use crate::figures::FIGURES;
use crate::mechanism::Hacksaw;
#[cfg(not(target_arch = "wasm32"))]
use crate::precision::case;
use crate::{checks, sources, summary};

/// The program.
#[must_use]
pub fn program() -> Program {
    let program = Program::of::<Hacksaw>().commit(option_env!("BG_COMMIT"));
    #[cfg(not(target_arch = "wasm32"))]
    let program = program.with_cases(case::cases(), &["paper", "full-offset", "rigid"]);
    program
        .version(env!("CARGO_PKG_VERSION"))
        .about(
            "Simulates the five-link power hacksaw of the paper, draws its Figures 4 to 19 and checks what it says \
            about them",
        )
        .scene("paper")
        .extras(Paper)
}

/// Does what the arguments ask for and gives the exit code. All that it calls is compiled here, once, since nothing of
/// it is generic.
pub fn main(arguments: ArgsOs) -> ExitCode {
    program().main(arguments)
}

/// What the program adds.
struct Paper;

impl Extras for Paper {
    /// Figures are drawn from the reference columns.
    #[cfg(not(target_arch = "wasm32"))]
    fn figures(&self, model: &'static Description) -> Option<Vec<Figure>> {
        let has_columns = has_reference_columns(model.outputs.iter().map(|output| output.name));
        has_columns.then(|| FIGURES.map(|figure| figure.drawn()).to_vec())
    }

    fn additions(&self, run: &Recording) -> Result<Additions, MissingColumn> {
        let checks = if has_reference(run) { checks::check(run)? } else { Vec::new() };
        let (lines, entries) = summary::of_paper(run)?;
        Ok(Additions { lines, entries, checks, heading: "What the paper says its figures show" })
    }

    fn columns(&self, run: &Recording) -> Option<Vec<String>> {
        let forces = || forces().into_iter().filter(|name| run.has(name));
        has_reference(run).then(|| reference_columns().into_iter().chain(forces()).collect())
    }

    fn source(&self, name: &str) -> &'static str {
        sources::source(name)
    }

    fn page(&self, _: &str, _: &'static Description) -> Page {
        Page {
            title: "Power hacksaw".to_owned(),
            introduction:
                "The five-link power hacksaw of \u{201C}Modeling and Simulation of Power Hacksaw Machine Using Bond \
                           Graph\u{201D}, compiled from its multibond graph and run."
                    .to_owned(),
            gallery: "Figures 4 to 19".to_owned(),
            about_gallery: "Each link in turn: orientation, momenta and path.".to_owned(),
        }
    }

    fn settled(&self) -> Option<f64> {
        Some(summary::SETTLED)
    }

    /// More than forty samples in each turn of the paper's crank.
    fn finest(&self, _t_end: f64) -> f64 {
        0.002
    }
}

fn has_reference(run: &Recording) -> bool {
    has_reference_columns(run.columns.iter().map(|column| column.name.as_str()))
}
