//! The command: options, the order of the work, the files.

use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use serde_json::json;

use crate::machine::Machine;
use crate::measure::{Plan, Series, measure};
use crate::poses::{Reference, reference};
use crate::problem::Problem;
use crate::solvers::python::{self, Python};
use crate::solvers::{Solver, Source, in_rust};
use crate::{batch, diagram, ratios, table};

/// Compares bg-model with other solvers on 5 s of the paper's hacksaw in the plane.
#[derive(Debug, Parser)]
#[command(version)]
pub struct Arguments {
    /// Only solvers from these sources
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = Source::value_variants().to_vec())]
    only: Vec<Source>,

    /// Runs of each solver at each setting
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,

    /// A solver that takes longer than this, s, is not run with finer settings
    #[arg(long, default_value_t = 1.0)]
    longest: f64,

    /// Leave out the solvers from Python packages
    #[arg(long)]
    no_python: bool,

    /// A Python that has the packages of python/requirements.txt, instead of a virtual environment in the output folder
    #[arg(long)]
    python: Option<PathBuf>,

    /// Instead of all this: so many runs with parameters of their own, ours in lanes and heyoka's in batches
    #[arg(long, value_name = "RUNS", value_parser = clap::value_parser!(u32).range(1..))]
    batch: Option<u32>,

    /// Where the files go
    #[arg(long, default_value = "out/peers")]
    out: PathBuf,
}

/// Does what is asked for.
pub fn run(arguments: &Arguments) -> Result<(), String> {
    std::fs::create_dir_all(&arguments.out).map_err(|fault| format!("{}: {fault}", arguments.out.display()))?;
    let problem = Problem::paper();
    if let Some(runs) = arguments.batch {
        let interpreter = interpreter(arguments)?;
        print!("{}", batch::compared(&interpreter, &problem, runs as usize, arguments.repeats.into())?);
        return Ok(());
    }
    let reference = reference()?;
    let python = from_python(arguments, &problem);
    let mut solvers: Vec<Box<dyn Solver + '_>> = in_rust(&problem, &arguments.only);
    solvers.extend(python.solvers);
    let plan = Plan { rounds: arguments.repeats.into(), longest: arguments.longest };
    let series = measure(&mut solvers, &reference, plan, |done| eprintln!("{done}"));
    let machine = Machine::here(python.versions);
    write(&arguments.out, &machine, &reference, &series, &python.faults)
}

/// What Python offers; what it does not is said and left out.
fn from_python(arguments: &Arguments, problem: &Problem) -> Python {
    let sources: Vec<Source> = python::SOURCES.into_iter().filter(|source| arguments.only.contains(source)).collect();
    let nothing = |faults| Python { solvers: Vec::new(), versions: Default::default(), faults };
    if arguments.no_python || sources.is_empty() {
        return nothing(Vec::new());
    }
    let python = interpreter(arguments).and_then(|interpreter| python::start(&interpreter, problem, &sources));
    let python = python.unwrap_or_else(|fault| nothing(vec![format!("solvers from Python left out: {fault}")]));
    python.faults.iter().for_each(|fault| eprintln!("warning: {fault}"));
    python
}

fn interpreter(arguments: &Arguments) -> Result<PathBuf, String> {
    match &arguments.python {
        Some(path) => Ok(path.clone()),
        None => {
            eprintln!("virtual environment for Python's packages");
            python::environment(&std::path::absolute(arguments.out.join("venv")).unwrap_or_default())
        }
    }
}

fn write(
    folder: &Path,
    machine: &Machine,
    reference: &Reference,
    series: &[Series],
    missing: &[String],
) -> Result<(), String> {
    let head = format!("{} Errors against {}.\n", machine.sentence(), reference.origin);
    let left_out = missing.iter().map(|fault| format!("\nLeft out: {fault}.\n")).collect::<String>();
    let summary = format!("{head}{left_out}\n{}\n{}", table::summary(series), ratios::table(series));
    let whole = format!("# Work and precision\n\n{summary}\n## All points\n\n{}", table::points(series));
    let data = json!({ "machine": machine, "reference": reference.origin, "missing": missing, "series": series });
    let data = serde_json::to_string_pretty(&data).map_err(|fault| fault.to_string())?;
    let files = [
        ("peers.md", whole),
        ("peers.json", data + "\n"),
        ("peers.csv", table::csv(series)?),
        ("work_precision.svg", diagram::draw(series)?),
    ];
    for (name, text) in files {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|fault| format!("{}: {fault}", path.display()))?;
    }
    println!("{summary}");
    println!("All points and the diagram are in {}.", folder.display());
    Ok(())
}
