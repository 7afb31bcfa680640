//! The arguments as the user writes them.

use std::path::PathBuf;

use bg_model::integrator::Integrator;
use clap::{Args, ColorChoice, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use super::campbell::CampbellArguments;
use super::identify::IdentifyArguments;
use super::methods::integrator;
use super::optimize::OptimizeArguments;
use super::plot::PlotArguments;
use super::sensitivity::SensitivityArguments;
use super::sweep::SweepArguments;
use crate::ask::hint;
use crate::ask::request::Integration;
use crate::ask::request::T_END;
use crate::show::picture::Level;
use crate::show::tables::ScenePart;
use crate::show::trajectory::Form;
use crate::studies::golden::FOLDER;

#[derive(Debug, Parser)]
#[command(name = "program", version, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub run: RunArguments,

    /// Say nothing but faults and what is asked for: no summary beside files that are written, no progress
    #[arg(long, short, global = true)]
    pub quiet: bool,

    /// Colour help and faults: on a terminal, always or never
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub color: ColorChoice,

    /// Take options from a TOML file: `t-end = 2`, `output = ["a", "b"]`, a table [set] of parameters. Those on the
    /// command line come after them
    #[arg(long, global = true, value_name = "FILE.toml")]
    pub config: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the mechanism (also what the program alone does)
    Run(RunArguments),
    /// Run the mechanism and write one HTML file that shows it: in motion, in charts, as a graph, with equations and
    /// parameters
    Report(ReportArguments),
    /// Draw outputs of a run over time, against each other, or as a spectrum
    Plot(PlotArguments),
    /// List the scenes, or say what a scene left out of the literal model and why
    Scene {
        /// The scene to report on; without it, one line for each
        #[arg(value_name = "NAME", id = "scene")]
        scene: Option<String>,

        /// Print it as JSON: the scenes with their states, parameters and outputs
        #[arg(long)]
        json: bool,
    },
    /// Print or draw the multibond graph of a scene: elements, bonds with causal strokes, states, equations, operations
    Graph(GraphArguments),
    /// Measure what each error costs: integrators over tolerances against reference solutions in extended precision
    Precision(PrecisionArguments),
    /// Linearise at an equilibrium or at some time: modes, frequency responses, A, B, C and D
    Linearize(LinearizeArguments),
    /// Follow natural frequencies over a parameter, such as a rotor's speed: a Campbell diagram, critical speeds
    Campbell(CampbellArguments),
    /// Differentiate a run by parameters, exactly and through events: which parameter moves which output, or one number
    /// by all parameters at once
    Sensitivity(SensitivityArguments),
    /// Fit parameters to measured columns: values with confidence, correlations, what cannot be identified
    Identify(IdentifyArguments),
    /// Find the parameters with which a number of a run is least, subject to others, by exact derivatives; of two
    /// numbers their front
    Optimize(OptimizeArguments),
    /// Run for many values of parameters by a plan, into Parquet files; on all cores, or on many machines
    Sweep(SweepArguments),
    /// Pack a scene as a functional mock-up unit for other programs: FMI 3.0 or 2.0, Model Exchange and Co-Simulation
    /// in one file
    Fmu(FmuArguments),
    /// Record a run as a golden output, or check that recorded runs are reproduced
    #[command(subcommand)]
    Golden(GoldenCommand),
    /// Compare two runs, output by output: the largest difference and its time
    Compare(CompareArguments),
    /// List the parameters: name, default, unit, meaning
    Parameters {
        /// Print them as a file for --params
        #[arg(long)]
        toml: bool,

        /// Print them as JSON, by their names
        #[arg(long, conflicts_with = "toml")]
        json: bool,
    },
    /// Print what makes a shell complete commands, options, scenes and cases
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Print the manual page, or write those of all commands
    Man {
        /// Folder for a page of each command
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Which graph, and what of it.
#[derive(Debug, Args)]
pub struct GraphArguments {
    /// The scene. All of one mechanism have the same graph but for what they are without; states, operations differ
    #[arg(long, value_name = "NAME")]
    pub scene: String,

    /// What to print; without it, an overview of counts, states and operations
    #[arg(long, value_name = "PART", value_enum, conflicts_with_all = ["svg", "dot"])]
    pub part: Option<ScenePart>,

    /// Draw the graph into this file: half arrows, causal strokes, multibonds thick. Replaces a file that is there
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,

    /// Write the graph into this file in the language of Graphviz. Replaces a file that is there
    #[arg(long, value_name = "FILE")]
    pub dot: Option<PathBuf>,

    /// How much of it is drawn
    #[arg(long, value_name = "LEVEL", value_enum, default_value_t)]
    pub level: Level,

    /// Print it as JSON: elements, bonds, states, equations and operations, or one part of these
    #[arg(long)]
    pub json: bool,
}

/// Which model is packed, and into what.
#[derive(Debug, Args)]
pub struct FmuArguments {
    /// The scene
    #[arg(long, value_name = "NAME")]
    pub scene: String,

    /// The version of the standard
    #[arg(long, value_name = "VERSION", default_value = "3.0", value_parser = ["2.0", "3.0"])]
    pub fmi: String,

    /// The library that exports the scene; without it, the one of the program's name with `_fmu` beside the program
    #[arg(long, value_name = "FILE")]
    pub library: Option<PathBuf>,

    /// The unit; without it, in this folder, of the program's and the scene's name. Replaces a file that is there
    #[arg(long, value_name = "FILE.fmu")]
    pub out: Option<PathBuf>,

    /// The end of a simulation that the unit proposes, s
    #[arg(long, value_name = "SECONDS", default_value_t = T_END)]
    pub t_end: f64,

    /// Print what was packed as JSON in place of the text
    #[arg(long)]
    pub json: bool,
}

/// What is run, and how.
#[derive(Clone, Debug, Args)]
pub struct ModelArguments {
    /// What to model; the command `scene` says more
    #[arg(long, value_name = "NAME")]
    pub scene: String,

    /// Set a parameter, in its unit or another one, as in length=75mm; can be given again and again, the last one
    /// counts. Comes after --params
    #[arg(long = "set", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// Read parameters from a TOML file of lines `name = value`
    #[arg(long, value_name = "FILE.toml")]
    pub params: Option<PathBuf>,

    /// Set an input of the model, 0 otherwise: to a number, or to the second column of a CSV file over the first, in s.
    /// A column by its name as FILE.csv:COLUMN; straight lines between the rows, a spline with cubic:FILE.csv. The
    /// first line may be names or numbers; outside the rows the value of the nearest one is held
    #[arg(long = "input", value_name = "NAME=VALUE|FILE.csv", allow_hyphen_values = true)]
    pub input: Vec<String>,
}

/// How it is integrated.
#[derive(Clone, Debug, Args)]
pub struct IntegrationArguments {
    /// End of the run, s
    #[arg(long, value_name = "SECONDS", default_value = "5", value_parser = real, allow_negative_numbers = true)]
    pub t_end: f64,

    /// The integrator; auto says in the summary what it chose
    #[arg(long, value_name = "NAME", default_value_t, value_parser = integrator())]
    pub method: Integrator,

    /// What auto begins with, without trials: a method's name, or the summary.json of a run like this, which says by
    /// what most of it was made. Another method takes over later on where it is ahead
    #[arg(long, value_name = "NAME|summary.json", value_parser = hint::read)]
    pub hint: Option<Integrator>,

    /// Step of an integrator with a fixed step, s
    #[arg(long, value_name = "SECONDS", default_value = "1e-4", value_parser = real, allow_negative_numbers = true)]
    pub fixed_step: f64,

    /// Relative tolerance of each step
    #[arg(long, value_name = "NUMBER", default_value = "1e-8", value_parser = real, allow_negative_numbers = true)]
    pub rtol: f64,

    /// Absolute tolerance of each step, in SI units [default: by the sizes that states have had]
    #[arg(long, value_name = "NUMBER", value_parser = real, allow_negative_numbers = true)]
    pub atol: Option<f64>,

    /// Output interval of the CSV file, s. Figures and summary use finer samples where they need them
    #[arg(long, value_name = "SECONDS", default_value = "0.01", value_parser = real, allow_negative_numbers = true)]
    pub step: f64,
}

impl IntegrationArguments {
    /// The same, not yet checked.
    pub const fn integration(&self) -> Integration {
        let &Self { t_end, method, hint, fixed_step, rtol, atol, step } = self;
        Integration { t_end, step, method, hint, rtol, atol, fixed_step }
    }
}

#[derive(Debug, Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub model: ModelArguments,

    #[command(flatten)]
    pub integration: IntegrationArguments,

    /// Where to start: as the model says, or at rest with its springs loaded
    #[arg(long, value_name = "START", value_enum, default_value_t, conflicts_with = "from")]
    pub start: Start,

    /// Start from a state that --save-state wrote, at its time. The parameters may be others: what stays are the
    /// states, and what sticks or rests as far as it can
    #[arg(long, value_name = "FILE.json")]
    pub from: Option<PathBuf>,

    /// Make the run of a summary.json again, with its scene, parameters, inputs, start and integrator: the same bits.
    /// Files of inputs are read again and have to be the same
    #[arg(long, value_name = "summary.json", conflicts_with_all = [
        "scene", "set", "params", "input", "t_end", "method", "hint", "fixed_step", "rtol", "atol", "step", "start",
            "from"
    ])]
    pub again: Option<PathBuf>,

    /// Keep these outputs only, in this order: in the CSV file, the summary, the page and the figures; several with
    /// commas. A name without components stands for all of them
    #[arg(long = "output", value_name = "NAME", value_delimiter = ',')]
    pub outputs: Vec<String>,

    /// Show another run or a measurement, a CSV file whose columns have names of outputs, in the charts of the page;
    /// can be given again and again
    #[arg(long = "with", value_name = "FILE.csv")]
    pub others: Vec<PathBuf>,

    /// Draw a picture on the page: "pin.force.y over pin.force.x", "spectrum of speed", "orders of torque over
    /// crank.angle", or a signal over time; ", 2.." at its end leaves the first 2 s out. Can be given again and again
    #[arg(long = "plot", value_name = "PICTURE", allow_hyphen_values = true)]
    pub plots: Vec<String>,

    /// Write the state at the end here, for --from
    #[arg(long, value_name = "FILE.json")]
    pub save_state: Option<PathBuf>,

    #[command(flatten)]
    pub trajectory: TrajectoryArguments,

    /// Folder for figures, index.html, summary.txt, summary.json and trajectory.csv; made if it is not there. They
    /// replace the files of the run before as soon as all are written; other files stay
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,

    /// Draw no figures and no page; together with --csv, --parquet or --npz nothing is written but these files
    #[arg(long)]
    pub no_figures: bool,

    /// Print the summary as JSON
    #[arg(long)]
    pub json: bool,
}

/// Where the trajectory goes, and as what.
#[derive(Clone, Debug, Args)]
pub struct TrajectoryArguments {
    /// Write the trajectory here instead of trajectory.csv in --out. Replaces a file that is there; later runs leave
    /// it. `-` is standard output; the summary goes to standard error then
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,

    /// Give the columns of CSV files their units, as in `speed [rpm]`
    #[arg(long)]
    pub units: bool,

    /// The same as Parquet, with the columns' units in its metadata
    #[arg(long, value_name = "FILE")]
    pub parquet: Option<PathBuf>,

    /// The same as arrays for numpy.load, by the columns' names
    #[arg(long, value_name = "FILE")]
    pub npz: Option<PathBuf>,
}

impl TrajectoryArguments {
    /// What CSV files are.
    pub const fn form_of_csv(&self) -> Form {
        if self.units { Form::CsvWithUnits } else { Form::Csv }
    }

    /// The files that are asked for.
    pub fn tables(&self) -> Vec<(Form, PathBuf)> {
        let asked = [(self.form_of_csv(), &self.csv), (Form::Parquet, &self.parquet), (Form::Npz, &self.npz)];
        asked.into_iter().filter_map(|(form, path)| Some((form, path.clone()?))).collect()
    }
}

/// A report takes what a run takes; its page is in place of `index.html` and the figures' files.
#[derive(Debug, Args)]
pub struct ReportArguments {
    #[command(flatten)]
    pub run: RunArguments,

    /// Write the machine in motion as binary glTF as well, for other programs
    #[arg(long)]
    pub glb: bool,

    /// Put the model into the page, with a slider for each parameter: a move of one runs it again. Needs the target
    /// wasm32-unknown-unknown; or give the program compiled for it
    #[arg(long, value_name = "FILE.wasm", num_args = 0..=1, require_equals = true)]
    pub live: Option<Option<PathBuf>>,

    /// Linearise and show the modes: where the run is at this time, s; without a number at the equilibrium near the
    /// start
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, value_parser = real, allow_negative_numbers = true)]
    pub modes: Option<Option<f64>>,

    /// Write the page for a frame of another page, which has its style and script and replaces it again and again: no
    /// CSV file, and the picture of the graph is kept in this file and taken from there while the graph is the same
    #[arg(long, value_name = "FILE", hide = true)]
    pub frame: Option<PathBuf>,

    /// Show an SVG file in the report, such as a diagram of `precision` or `linearize`; can be given again and again
    #[arg(long, value_name = "FILE.svg")]
    pub show: Vec<PathBuf>,
}

/// Where a run starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Start {
    /// As the model says
    #[default]
    Model,
    /// The equilibrium near there, inputs as at t = 0
    Equilibrium,
}

#[derive(Debug, Args)]
pub struct LinearizeArguments {
    #[command(flatten)]
    pub model: ModelArguments,

    /// Where the run is at this time, s; 0 is the start [default: at the static equilibrium near the start, springs
    /// loaded, inputs as at t = 0]
    #[arg(long, value_name = "SECONDS", value_parser = real, allow_negative_numbers = true)]
    pub at: Option<f64>,

    /// The integrator of the run to --at
    #[arg(long, value_name = "NAME", default_value_t, value_parser = integrator())]
    pub method: Integrator,

    /// Relative tolerance of the run to --at
    #[arg(long, value_name = "NUMBER", default_value = "1e-8", value_parser = real, allow_negative_numbers = true)]
    pub rtol: f64,

    /// Print what is found as JSON in place of the text
    #[arg(long)]
    pub json: bool,

    /// Folder for modes.txt, linear.json, linear.npz, responses.csv and Bode diagrams, which replace those of the run
    /// before
    #[arg(long, value_name = "DIR", default_value = "out/linear")]
    pub out: PathBuf,
}

#[derive(Debug, Subcommand)]
pub enum GoldenCommand {
    /// Run a scene and record its trajectory, its settings and its counts. Tolerances that were edited are kept
    Record(RecordArguments),
    /// Run again what is recorded and say what differs
    Check(CheckArguments),
}

#[derive(Debug, Args)]
pub struct RecordArguments {
    #[command(flatten)]
    pub model: ModelArguments,

    #[command(flatten)]
    pub integration: IntegrationArguments,

    /// Folder of golden outputs; made if it is not there
    #[arg(long, value_name = "DIR", default_value = FOLDER)]
    pub out: PathBuf,

    /// What it is called: the files are NAME.toml and NAME.csv [default: the scene's name]
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,

    /// Print what is recorded as JSON in place of the text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Folder of golden outputs
    #[arg(long, value_name = "DIR", default_value = FOLDER)]
    pub out: PathBuf,

    /// Which of them [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,

    /// Print what is found as JSON in place of the text: of each whether it is as recorded, and what differs
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// A scene, a CSV file of a run, or the folder of one
    #[arg(value_name = "A")]
    pub a: String,

    /// What it is compared with, likewise
    #[arg(value_name = "B")]
    pub b: String,

    /// Set a parameter of the scenes; can be given again and again
    #[arg(long = "set", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// Set an input of the scenes to a number or a table, as for `run`
    #[arg(long = "input", value_name = "NAME=VALUE|FILE.csv", allow_hyphen_values = true)]
    pub input: Vec<String>,

    /// Read parameters of the scenes from a TOML file
    #[arg(long, value_name = "FILE.toml")]
    pub params: Option<PathBuf>,

    #[command(flatten)]
    pub integration: IntegrationArguments,

    /// Print what is found as JSON in place of the text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct PrecisionArguments {
    /// What is run
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,

    /// The integrators [default: all]
    #[arg(long, value_name = "NAME", value_parser = integrator(), value_delimiter = ',')]
    pub methods: Vec<Integrator>,

    /// Relative tolerances
    #[arg(
        long,
        value_name = "NUMBER",
        value_delimiter = ',',
        value_parser = real,
        default_values = ["1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10", "1e-11", "1e-12"]
    )]
    pub rtol: Vec<f64>,

    /// Absolute tolerances, in SI units, over the relative ones [default: by the sizes of the states]
    #[arg(long, value_name = "NUMBER", value_parser = real)]
    pub atol_ratio: Option<f64>,

    /// Steps of integrators with a fixed step, s
    #[arg(long, value_name = "SECONDS", value_delimiter = ',', value_parser = real, default_values = ["2e-4", "1e-4",
        "5e-5", "2e-5"])]
    pub fixed_step: Vec<f64>,

    /// Runs of each point, within two seconds; the least and the median of their times count
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    pub repeats: usize,

    /// Folder for precision.txt, precision.json and the diagrams, which replace those of the run before
    #[arg(long, value_name = "DIR", default_value = "out/precision")]
    pub out: PathBuf,

    /// Print what is measured as JSON in place of the table: what precision.json has
    #[arg(long)]
    pub json: bool,
}

/// A number on the command line.
fn real(text: &str) -> Result<f64, &'static str> {
    text.parse().map_err(|_| "not a number")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_that_tells_something_has_it_as_json() {
        fn leaves(command: &clap::Command) -> Vec<&clap::Command> {
            if command.get_name() == "help" {
                return Vec::new();
            }
            let below = command.get_subcommands().flat_map(leaves);
            // `golden` alone is none.
            let own = !command.is_subcommand_required_set();
            below.chain(own.then_some(command)).collect()
        }
        let command = <Cli as clap::CommandFactory>::command();
        let is_json = |command: &clap::Command| command.get_arguments().any(|argument| argument.get_id() == "json");
        let without: Vec<_> = leaves(&command).into_iter().filter(|command| !is_json(command)).collect();
        let names: Vec<_> = without.iter().map(|command| command.get_name()).collect();
        // What they print is for a shell and for `man`.
        assert_eq!(names, ["completions", "man"]);
    }

    #[test]
    fn what_is_not_given_is_as_elsewhere() {
        let run = Cli::parse_from(["program", "--scene", "any"]).run;
        assert_eq!(run.integration.integration(), Integration::default());
    }
}
