//! The command `optimize`: the parameters with which a number of a run is least, as tables, figures and a page.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::arguments::{IntegrationArguments, ModelArguments};
use super::progress::bar;
use super::run::{chosen, machine, request};
use super::{InputError, ended};
use crate::ask::inputs;
use crate::files::{FileError, RunFolder, console};
use crate::program::Program;
use crate::show::figures::FigureError;
use crate::show::output::OutputError;
use crate::studies::optimize::{Asked, Optimum, POINTS, STEPS, Sought, Trial, optimum, report, sought};

const TEXT: &str = "optimize.txt";
const PAGE: &str = "index.html";
const JSON: &str = "optimize.json";
const CSV: &str = "optimize.csv";
const PARQUET: &str = "optimize.parquet";
const FOUND: &str = "optimum.toml";
const COURSE: &str = "optimize.svg";
const FRONT_CSV: &str = "front.csv";
const FRONT: &str = "front.svg";

/// What is sought.
#[derive(Debug, Args)]
pub struct OptimizeArguments {
    /// What is to be least, such as "max |pin.force|" or "range(speed, 2..) / mean(speed, 2..)"; a second goal with a
    /// second --minimize or with --maximize gives their front
    #[arg(long, value_name = "NUMBER", required_unless_present = "maximize", allow_hyphen_values = true)]
    pub minimize: Vec<String>,

    /// What is to be largest
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    pub maximize: Vec<String>,

    /// What has to be fulfilled, such as "mean(crank_speed) > 30 rad/s"; can be given again and again
    #[arg(long, value_name = "NUMBER < NUMBER", allow_hyphen_values = true)]
    pub subject: Vec<String>,

    /// The parameters that may change, with bounds where these are narrower than their ranges, such as
    /// length=0.5..0.9,stiffness. They start at their values, or in the middle of bounds that these are outside of
    #[arg(
        long,
        value_name = "NAME[=LOWER..UPPER]",
        value_delimiter = ',',
        required = true,
        allow_hyphen_values = true
    )]
    pub by: Vec<String>,

    /// From how many starts it is searched, spread between the bounds: a search finds the next minimum
    #[arg(long, value_name = "COUNT", default_value_t = 1)]
    pub starts: u32,

    /// In how many points the front of two goals is sought
    #[arg(long, value_name = "COUNT", default_value_t = POINTS)]
    pub points: u32,

    /// The most steps of a search
    #[arg(long, value_name = "COUNT", default_value_t = STEPS)]
    pub steps: u64,

    /// Threads; 0 are as many as there are cores. Each makes a search
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    pub threads: usize,

    #[command(flatten)]
    pub model: ModelArguments,

    #[command(flatten)]
    pub integration: IntegrationArguments,

    /// Print what is found as JSON in place of the text
    #[arg(long)]
    pub json: bool,

    /// Folder for index.html, optimize.txt, optimize.json, optimize.csv, optimize.parquet, optimum.toml (for --params),
    /// optimize.svg; of two goals front.csv and front.svg
    #[arg(long, value_name = "DIR", default_value = "out/optimize")]
    pub out: PathBuf,
}

impl OptimizeArguments {
    fn asked(&self) -> Asked {
        Asked {
            minimize: self.minimize.clone(),
            maximize: self.maximize.clone(),
            subject: self.subject.clone(),
            by: self.by.clone(),
            starts: self.starts,
            points: self.points,
            steps: self.steps,
            threads: self.threads,
        }
    }
}

pub fn optimize(program: &Program, arguments: &OptimizeArguments) -> Result<ExitCode, InputError> {
    let (chosen, named) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    // A value that the scene does not take is told with its place.
    machine(program, scene, &chosen)?;
    let request = request(&arguments.integration, 0.0, None)?;
    let sought = sought(scene, &chosen.values, &arguments.asked(), &request, arguments.integration.step)?;
    let names = [PAGE, TEXT, JSON, CSV, PARQUET, FOUND, COURSE, FRONT_CSV, FRONT].map(str::to_owned);
    let folder = RunFolder::claim(&arguments.out, &names)?;
    let bar = bar(1, "run {pos}: {msg}");
    let told = |number: usize, trial: &Trial| {
        bar.set_position(number as u64);
        bar.set_message(progress(&sought, trial));
        true
    };
    let found = optimum(&program.models, scene, &chosen.values, &chosen.inputs, &sought, &told);
    bar.finish_and_clear();
    let found = found?;
    let inputs = inputs::text(&named, [0.0, request.t_end]);
    let told = format!("{}{inputs}", report::text(&sought, &found));
    let about = format!("{}, scene `{}`, over {} s.", program.texts.name_and_version(), scene.name, request.t_end);
    let (written, faults) = write(folder, &sought, &found, [&told, &about, &scene.name]);
    let written =
        written.map_or_else(|| "nothing".to_owned(), |count| format!("{count} files in {}", arguments.out.display()));
    let told = format!("{told}\nwritten: {written}; open {PAGE} there\n");
    let printed = console::tell_as(arguments.json, &told, || report::json(&sought, &found));
    let faults = faults.iter().map(ToString::to_string).chain(printed.err().map(|fault| fault.to_string()));
    Ok(ended(faults.chain(report::failure(&sought, &found))))
}

/// A run in a line of the terminal.
fn progress(sought: &Sought, trial: &Trial) -> String {
    let goals = sought.goals(trial).map_or_else(
        || "failed".to_owned(),
        |goals| goals.iter().map(|goal| format!("{goal:.6e}")).collect::<Vec<_>>().join(", "),
    );
    let missed = if trial.missed > 0.0 { format!(", missed by {:.1e}", trial.missed) } else { String::new() };
    format!("{goals}{missed}")
}

/// Writes the files; gives their number, where they are there, and what failed.
fn write(
    mut folder: RunFolder,
    sought: &Sought,
    found: &Optimum,
    [text, about, scene]: [&str; 3],
) -> (Option<usize>, Vec<OutputError>) {
    let mut faults = Vec::new();
    let mut fill = || -> Result<(), FileError> {
        folder.write_text(TEXT, text)?;
        folder.write_text(FOUND, &report::toml(sought, found))?;
        folder.write_text(JSON, &format!("{:#}\n", report::json(sought, found)))?;
        let trials = report::trials(sought, found);
        folder.write_text(CSV, &trials.csv())?;
        folder.write(PARQUET, |file| file.write_all(&trials.bytes()))?;
        let mut figures = Vec::new();
        let mut drawn = vec![(COURSE, "The best search, run by run", report::course(sought, found))];
        if !found.front.is_empty() {
            folder.write_text(FRONT_CSV, &report::front(sought, found).csv())?;
            drawn.push((FRONT, "The front of both goals", report::front_figure(sought, found)));
        }
        for (file, caption, svg) in drawn {
            match svg {
                Ok(svg) => {
                    folder.write_text(file, &svg)?;
                    figures.push((caption.to_owned(), svg));
                }
                Err(FigureError::Empty) => {}
                Err(source) => faults.push(OutputError::Figure { file: file.to_owned(), source }),
            }
        }
        let title = format!("{scene}: {}", sought.title());
        folder.write_text(PAGE, &report::page(&title, sought, found, about, figures))
    };
    match fill().and_then(|()| folder.publish()) {
        Ok(files) => (Some(files.len()), faults),
        Err(fault) => {
            faults.push(fault.into());
            (None, faults)
        }
    }
}
