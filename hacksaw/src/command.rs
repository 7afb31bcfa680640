//! The command line: what a user asks for, and what it comes to.
//!
//! In: arguments. Out: a run with its files and the summary on stdout, or one line `error: ...` on stderr.
//! Exit codes: 0 done; 1 the run or an output failed, what could be written is; 2 the input cannot be used, nothing was run.

use std::ffi::OsString;
use std::fmt::Display;
use std::io::{IsTerminal, stderr};
use std::path::PathBuf;
use std::process::ExitCode;

use bg_model::parameters::{ParameterError, Parameters};
use bg_model::system::Model;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use thiserror::Error;

use crate::checks;
use crate::files::{FileError, RunFolder, console};
use crate::mechanism::HacksawParameters;
use crate::methods::integrator;
use crate::output::{Claimed, OutputError, Places};
use crate::parameters::{self, Chosen, SettingError};
use crate::precision::case::Case;
use crate::precision::measure::{Entry, MeasureError, Setting, measure};
use crate::precision::report as precision;
use crate::report::{self, Part};
use crate::run::{self, RTOL_OVER_ATOL, RunSettings, Simulation};
use crate::scenes::{Fixed, Scene, Visitor};
use crate::summary::Summary;
use crate::trajectory::TrajectoryError;
use bg_model::integrator::Integrator;

/// Simulates the five-link power hacksaw of the paper, draws its Figures 4 to 19 and checks what it says about them.
#[derive(Debug, Parser)]
#[command(name = "hacksaw", version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: RunArguments,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the hacksaw (also what `hacksaw` alone does)
    Run(RunArguments),
    /// List the scenes, or say what a scene left out of the literal model and why
    Scene {
        /// The scene to report on; without it, one line for each
        #[arg(value_name = "NAME")]
        scene: Option<Scene>,
    },
    /// Print the multibond graph of a scene: elements, bonds with causal strokes, states, equations, operations
    Graph {
        /// The scene. All of one mechanism have the same graph but for what they are without; states, operations differ
        #[arg(long, value_name = "NAME", default_value_t, value_enum)]
        scene: Scene,
        /// What to print; without it, an overview of counts, states and operations
        #[arg(long, value_name = "PART", value_enum)]
        part: Option<Part>,
    },
    /// Measure what each error costs: integrators over tolerances against reference solutions in extended precision
    Precision(PrecisionArguments),
    /// List the parameters: name, default, unit, meaning
    Parameters {
        /// Print them as a file for --params
        #[arg(long)]
        toml: bool,
    },
}

#[derive(Debug, Args)]
struct RunArguments {
    /// What to model: figures and checks need paper, full or literal; `hacksaw scene` says more
    #[arg(long, value_name = "NAME", default_value_t, value_enum)]
    scene: Scene,

    /// Set a parameter; can be given again and again, the last one counts. Comes after --params
    #[arg(long = "set", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,

    /// Read parameters from a TOML file of lines `name = value`
    #[arg(long, value_name = "FILE.toml")]
    params: Option<PathBuf>,

    /// End of the run, s
    #[arg(long, value_name = "SECONDS", default_value = "5", value_parser = real, allow_negative_numbers = true)]
    t_end: f64,

    /// The integrator; auto says in the summary what it chose
    #[arg(long, value_name = "NAME", default_value_t, value_parser = integrator())]
    method: Integrator,

    /// Step of an integrator with a fixed step, s
    #[arg(long, value_name = "SECONDS", default_value = "1e-4", value_parser = real, allow_negative_numbers = true)]
    fixed_step: f64,

    /// Relative tolerance of each step
    #[arg(long, value_name = "NUMBER", default_value = "1e-8", value_parser = real, allow_negative_numbers = true)]
    rtol: f64,

    /// Absolute tolerance of each step, in SI units [default: 0.1 of --rtol]
    #[arg(long, value_name = "NUMBER", value_parser = real, allow_negative_numbers = true)]
    atol: Option<f64>,

    /// Output interval of the CSV file, s. Figures and checks always use 0.002 s or finer
    #[arg(long, value_name = "SECONDS", default_value = "0.01", value_parser = real, allow_negative_numbers = true)]
    step: f64,

    /// Write the trajectory here instead of trajectory.csv in --out. Replaces a file that is there; later runs leave it
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// Folder for figures, index.html, summary.txt, summary.json and trajectory.csv; made if it is not there. They replace
    /// the files of the run before as soon as all are written; other files stay
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,

    /// Draw no figures and no overview page; together with --csv nothing is written but that file
    #[arg(long)]
    no_figures: bool,
}

#[derive(Debug, Args)]
struct PrecisionArguments {
    /// What is run
    #[arg(value_name = "CASE", default_values_t = [Case::Paper, Case::FullOffset, Case::Rigid], value_enum)]
    cases: Vec<Case>,

    /// The integrators [default: all]
    #[arg(long, value_name = "NAME", value_parser = integrator(), value_delimiter = ',')]
    methods: Vec<Integrator>,

    /// Relative tolerances
    #[arg(
        long,
        value_name = "NUMBER",
        value_delimiter = ',',
        value_parser = real,
        default_values = ["1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10", "1e-11", "1e-12"]
    )]
    rtol: Vec<f64>,

    /// Absolute tolerances, in SI units, over the relative ones
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0 / RTOL_OVER_ATOL, value_parser = real)]
    atol_ratio: f64,

    /// Steps of integrators with a fixed step, s
    #[arg(long, value_name = "SECONDS", value_delimiter = ',', value_parser = real, default_values = ["2e-4", "1e-4", "5e-5", "2e-5"])]
    fixed_step: Vec<f64>,

    /// Runs of each point, within two seconds; the least and the median of their times count
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    repeats: usize,

    /// Folder for precision.txt, precision.json and the diagrams, which replace those of the run before
    #[arg(long, value_name = "DIR", default_value = "out/precision")]
    out: PathBuf,
}

/// The most rows of a CSV file: some hundred MB.
const MOST_ROWS: f64 = 500_000.0;

/// Input that cannot be used.
#[derive(Debug, Error)]
enum InputError {
    #[error(transparent)]
    Setting(#[from] SettingError),
    #[error("{name} {}: must be {range}", parameters::number(*value))]
    Range { name: &'static str, value: f64, range: String },
    #[error("--step {}: gives more than {MOST_ROWS} rows until {t_end} s; choose a longer one", parameters::number(*step))]
    Rows { step: f64, t_end: f64 },
    #[error("{place}: {fault}")]
    Fixed { place: String, fault: Fixed },
    #[error(transparent)]
    Model(#[from] ParameterError),
    #[error(transparent)]
    Start(#[from] bg_model::assembly::AssemblyError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Measure(#[from] MeasureError),
}

/// Does what the arguments ask for and gives the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = command().try_get_matches_from(arguments).and_then(|matches| Cli::from_arg_matches(&matches));
    let outcome = match cli {
        Err(fault) if fault.use_stderr() => return refuse(&one_line(&fault)),
        // Help and version.
        Err(help) => Ok(ended(console::printed(help.print()).err())),
        Ok(Cli { command: Some(Command::Scene { scene }), .. }) => {
            Ok(say(&scene.map_or_else(report::scenes, report::scene)))
        }
        Ok(Cli { command: Some(Command::Graph { scene, part }), .. }) => Ok(say(&report::graph(scene, part))),
        Ok(Cli { command: Some(Command::Parameters { toml }), .. }) => {
            let defaults = HacksawParameters::default();
            Ok(say(&if toml { parameters::to_toml(&defaults) } else { parameters::table::<HacksawParameters>() }))
        }
        Ok(Cli { command: Some(Command::Precision(arguments)), .. }) => measure_precision(&arguments),
        Ok(Cli { command: Some(Command::Run(arguments)), .. } | Cli { command: None, run: arguments }) => {
            simulate(&arguments)
        }
    };
    outcome.unwrap_or_else(|fault| refuse(&fault))
}

/// The command line with the parameters in its help.
fn command() -> clap::Command {
    let help = format!(
        "Parameters (name, default, unit, meaning); defaults < --params < --set:\n{}\n\
         Files: a folder has the files of one run. They are written aside and take their place at the end, when those of the\n\
         run before are removed; a run that is stopped leaves the earlier one's. Files that no run wrote are left alone: a run\n\
         that would replace one is refused, as is a second run into the same folder at once. What a run wrote is listed in\n\
         `.run` in the folder.\n\n\
         Exit code: 0 done, 1 the run or an output failed (what could be written is), 2 the input cannot be used.",
        parameters::table::<HacksawParameters>()
    );
    Cli::command().after_help(help.clone()).mut_subcommand("run", |run| run.after_help(help))
}

fn simulate(arguments: &RunArguments) -> Result<ExitCode, InputError> {
    let chosen: Chosen<HacksawParameters> = parameters::merge(arguments.params.as_deref(), &arguments.set)?;
    let settings = settings(arguments)?;
    let scene = arguments.scene;
    // Figures are drawn from the reference columns.
    let figures = !arguments.no_figures && scene.has_reference_columns();
    let places = Places::new(&arguments.out, arguments.csv.as_deref(), figures);
    let (simulation, claimed) = scene.visit(Run { scene, chosen: &chosen, settings: &settings, places: &places })?;
    let failure = simulation.failure.as_ref().map(|failure| format!("the run failed: {failure}"));
    let faults = match report(scene, &simulation, &settings, claimed, changed(&chosen.values)) {
        Ok(faults) => faults.iter().map(ToString::to_string).collect(),
        Err(fault) => vec![fault.to_string()],
    };
    Ok(ended(faults.into_iter().chain(failure)))
}

/// Measures every case with every integrator.
fn measure_precision(arguments: &PrecisionArguments) -> Result<ExitCode, InputError> {
    let ratios = vec![arguments.atol_ratio];
    let numbers = [("--rtol", &arguments.rtol), ("--atol-ratio", &ratios), ("--fixed-step", &arguments.fixed_step)];
    for (name, values) in numbers {
        if let Some(&value) = values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
            return Err(InputError::Range { name, value, range: "a finite number above 0".to_owned() });
        }
    }
    let methods = if arguments.methods.is_empty() { &Integrator::ALL[..] } else { &arguments.methods };
    let settings = |method: Integrator| -> Vec<Setting> {
        if method.has_fixed_step() {
            arguments.fixed_step.iter().copied().map(Setting::Step).collect()
        } else {
            arguments
                .rtol
                .iter()
                .copied()
                .map(|rtol| Setting::Tolerance { rtol, atol: rtol * arguments.atol_ratio })
                .collect()
        }
    };
    let folder = RunFolder::claim(&arguments.out, &precision::names(&arguments.cases))?;
    let points: usize = methods.iter().map(|method| settings(*method).len()).sum();
    let bar = bar((points * arguments.cases.len()) as u64, "measuring {bar:40} {pos} of {len} {msg}");
    let mut entries: Vec<Entry> = Vec::new();
    for case in &arguments.cases {
        let reference = case.reference().load();
        for method in methods {
            bar.set_message(format!("{} by {}", case.name(), method.name()));
            for setting in settings(*method) {
                entries.push(measure(*case, *method, setting, arguments.repeats, &reference)?);
                bar.inc(1);
            }
        }
    }
    bar.finish_and_clear();
    let (written, fault) = match precision::write(folder, &entries) {
        Ok(count) => (format!("{count} files in {}", arguments.out.display()), None),
        Err(fault) => ("nothing".to_owned(), Some(fault)),
    };
    let printed = console::print(&format!("{}\nwritten: {written}\n", precision::table(&entries)));
    Ok(ended(fault.into_iter().chain(printed.err().map(OutputError::from))))
}

/// Makes a scene's model and runs it, with the places claimed before.
struct Run<'a> {
    scene: Scene,
    chosen: &'a Chosen<HacksawParameters>,
    settings: &'a RunSettings,
    places: &'a Places,
}

impl Visitor for Run<'_> {
    type Output = Result<(Simulation, Claimed), InputError>;

    fn visit<P, Mo, const N: usize, const G: usize, const M: usize>(
        self,
        new: fn(P) -> Result<Mo, ParameterError>,
    ) -> Self::Output
    where
        P: Parameters,
        Mo: Model<f64, N, G, M>,
    {
        let own = self.scene.parameters(&self.chosen.values);
        let own = own.map_err(|fault| InputError::Fixed { place: self.chosen.places[fault.index].clone(), fault })?;
        let model = new(own)?;
        // What cannot be assembled is refused before anything is claimed.
        model.start()?;
        let claimed = self.places.claim()?;
        let bar = progress_bar(self.settings.t_end);
        let simulation = run::run(&model, self.settings, |t| bar.set_position(ticks(t)))?;
        bar.finish_and_clear();
        Ok((simulation, claimed))
    }
}

/// Writes the files and prints the summary; gives what failed.
fn report(
    scene: Scene,
    simulation: &Simulation,
    settings: &RunSettings,
    claimed: Claimed,
    changed_parameters: Vec<String>,
) -> Result<Vec<OutputError>, TrajectoryError> {
    let trajectory = &simulation.trajectory;
    let checks = if trajectory.has_reference_columns() { checks::check(trajectory)? } else { Vec::new() };
    let mut summary = Summary::new(&scene.name(), simulation, settings, checks)?;
    summary.changed_parameters = changed_parameters;
    let mut written = claimed.write(&trajectory.at(&settings.output_times()), trajectory, &mut summary);
    let page = if written.page { "; open index.html there" } else { "" };
    let printed = console::print(&format!("{summary}\nwritten: {written}{page}\n"));
    written.faults.extend(printed.err().map(OutputError::from));
    Ok(written.faults)
}

fn settings(arguments: &RunArguments) -> Result<RunSettings, InputError> {
    let above_zero = |name, value: f64| {
        let range = "a finite number above 0".to_owned();
        if value.is_finite() && value > 0.0 { Ok(value) } else { Err(InputError::Range { name, value, range }) }
    };
    let t_end = above_zero("--t-end", arguments.t_end)?;
    let step = above_zero("--step", arguments.step)?;
    let rtol = above_zero("--rtol", arguments.rtol)?;
    let smallest = bg_model::integrator::Tolerances::<0>::SMALLEST_RELATIVE;
    if !(smallest..1.0).contains(&rtol) {
        let range = format!("at least {smallest:.1e}, which rounding allows, and below 1");
        return Err(InputError::Range { name: "--rtol", value: rtol, range });
    }
    let atol = above_zero("--atol", arguments.atol.unwrap_or(rtol / RTOL_OVER_ATOL))?;
    if t_end / step > MOST_ROWS {
        return Err(InputError::Rows { step, t_end });
    }
    let fixed_step = above_zero("--fixed-step", arguments.fixed_step)?;
    Ok(RunSettings { method: arguments.method, fixed_step, t_end, rtol, atol, step })
}

/// The parameters that differ from their defaults, as `name = value unit`.
fn changed(values: &HacksawParameters) -> Vec<String> {
    let table = HacksawParameters::table().iter().enumerate();
    let changed = table.filter(|(index, info)| values.value(*index) != info.default);
    changed
        .map(|(index, info)| {
            let text = format!("{} = {} {}", info.name, parameters::number(values.value(index)), info.unit);
            text.trim_end().to_owned()
        })
        .collect()
}

/// A thousand ticks a second of simulated time.
fn ticks(t: f64) -> u64 {
    (t * 1e3) as u64
}

/// A bar over simulated time.
fn progress_bar(t_end: f64) -> ProgressBar {
    let bar = bar(ticks(t_end).max(1), "simulating {bar:40} {percent:>3} % of {msg}, {eta} to go");
    bar.set_message(format!("{t_end} s"));
    bar
}

/// A bar on a terminal, nothing in a pipe.
fn bar(length: u64, template: &str) -> ProgressBar {
    // Ten times a second is steady to the eye and costs nothing.
    let target =
        if stderr().is_terminal() { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(length), target);
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.expect("the template is well formed").progress_chars("\u{2501}\u{2578}\u{2500}"));
    bar
}

/// Prints `text`, which is all there is to do.
fn say(text: &str) -> ExitCode {
    ended(console::print(text).err())
}

/// Input that cannot be used.
fn refuse(fault: &impl Display) -> ExitCode {
    console::complain(fault);
    ExitCode::from(2)
}

/// What is done is done; `faults` are what failed of it.
fn ended(faults: impl IntoIterator<Item = impl Display>) -> ExitCode {
    let failed = faults.into_iter().inspect(console::complain).count() > 0;
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// A number on the command line.
fn real(text: &str) -> Result<f64, &'static str> {
    text.parse().map_err(|_| "not a number")
}

/// What clap says in several lines, in one.
fn one_line(fault: &clap::Error) -> String {
    let text = fault.render().to_string();
    let told =
        text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    let told: Vec<&str> = told.filter(|line| !line.is_empty()).collect();
    let line = told.join("; ");
    format!("{}; --help says more", line.strip_prefix("error: ").unwrap_or(&line))
}
