//! The command `plot`: outputs of a run over time, against each other, as spectra; other runs and measurements beside
//! them.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_analysis::criterion::Criteria;
use bg_model::description::Description;
use bg_model::run::{Request, sample_times};
use bg_model::simulation::{Recording, Samples};
use clap::Args;

use super::arguments::{IntegrationArguments, ModelArguments};
use super::run::{chosen, follow, machine, request};
use super::{InputError, ended};
use crate::ask::scenes::own_values;
use crate::files::{FileError, console, whole};
use crate::program::Program;
use crate::run::samples::read_file_of;
use crate::show::figures::plot::Series;
use crate::show::signals::{Drawing, Over};

/// What is drawn.
#[derive(Debug, Args)]
pub struct PlotArguments {
    /// What is drawn: outputs, or made of them, such as "|pin.force|" or "speed * torque"; several with further --show
    #[arg(long, value_name = "SIGNAL", required = true, allow_hyphen_values = true)]
    pub show: Vec<String>,

    /// Over this in place of the time: a phase plane, a path, a hodograph. Where both are in one unit, both axes have
    /// one scale
    #[arg(long, value_name = "SIGNAL", conflicts_with_all = ["spectrum", "order"], allow_hyphen_values = true)]
    pub over: Option<String>,

    /// The amplitude spectrum over frequency, Hz
    #[arg(long, conflicts_with = "order")]
    pub spectrum: bool,

    /// The amplitude spectrum over the orders of a shaft: its angle with its turns, such as crank.angle
    #[arg(long, value_name = "ANGLE")]
    pub order: Option<String>,

    /// From this time on, s, where a start does not count
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    pub from: f64,

    /// Draw spectra up to this frequency or order only [default: a quarter above the last amplitude that is a
    /// thousandth of the largest one]
    #[arg(long, value_name = "NUMBER")]
    pub up_to: Option<f64>,

    /// The vertical axis is logarithmic
    #[arg(long)]
    pub log: bool,

    /// The same of a CSV file of another run or a measurement in the same chart; can be given again and again
    #[arg(long = "with", value_name = "FILE.csv")]
    pub others: Vec<PathBuf>,

    #[command(flatten)]
    pub model: ModelArguments,

    #[command(flatten)]
    pub integration: IntegrationArguments,

    /// The drawing. Replaces a file that is there
    #[arg(long, value_name = "FILE.svg", default_value = "out/plot.svg")]
    pub out: PathBuf,

    /// Print what is drawn as JSON in place of the text: the points of each line
    #[arg(long)]
    pub json: bool,
}

/// The least number of samples: a drawing of fewer would have corners.
pub const SAMPLES: f64 = 4000.0;

pub fn plot(program: &Program, arguments: &PlotArguments) -> Result<ExitCode, InputError> {
    let (chosen, _) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let model = scene.description;
    let drawing = arguments.drawing(model)?;
    let request = request(&arguments.integration, 0.0, None)?;
    if !(0.0..request.t_end).contains(&arguments.from) {
        let range = format!("a time in the run, 0 to {} s", request.t_end);
        return Err(InputError::Range { name: "--from", value: arguments.from, range });
    }
    let step = arguments.integration.step.min((request.t_end - arguments.from) / SAMPLES);
    let rows = sample_times(arguments.from, step, request.t_end);
    let samples = Samples::At(rows);
    let machine = machine(program, scene, &chosen)?;
    let own = own_values(scene, &program.models.scenes, &chosen.values)
        .map_err(|fault| InputError::Unknown { option: "--set", fault: fault.to_string() })?;
    let others = others(&arguments.others, model)?;
    for (path, (_, run)) in arguments.others.iter().zip(&others) {
        drawing.check(run).map_err(|name| InputError::Unknown {
            option: "--with",
            fault: format!("{} has no column `{name}`", path.display()),
        })?;
    }
    let outcome = follow(&*machine, Request { samples, ..request }, None)?;
    let others = others.iter().map(|(name, run)| (name.as_str(), run));
    let runs: Vec<(&str, &Recording)> = std::iter::once(("", &outcome.run.recording)).chain(others).collect();
    let plot = drawing.plot(&scene.name, &runs, own.values());
    let svg = plot.drawn().map_err(|source| crate::show::output::OutputError::Figure {
        file: arguments.out.display().to_string(),
        source,
    })?;
    if let Some(folder) = arguments.out.parent() {
        let failed = |source| FileError::Write { path: folder.to_owned(), source };
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    whole::write(&arguments.out, |file| file.write_all(svg.as_bytes()))?;
    let file = arguments.out.display().to_string();
    let printed = console::tell_as(arguments.json, &format!("written: {file}\n"), || {
        let line = |line: &Series| serde_json::json!({ "name": line.name, "points": line.points });
        let lines: Vec<_> = plot.series.iter().map(line).collect();
        serde_json::json!({ "file": file, "across": plot.across, "up": plot.up, "series": lines })
    });
    let failure = outcome.failure.map(|failure| format!("the run failed: {failure}"));
    Ok(ended(printed.err().map(|fault| fault.to_string()).into_iter().chain(failure)))
}

impl PlotArguments {
    fn drawing(&self, model: &'static Description) -> Result<Drawing, InputError> {
        let mut criteria = Criteria::new(model);
        let mut signal = |option: &'static str, text: &str| {
            criteria.signal(text).map_err(|fault| InputError::Unknown { option, fault: format!("{text}: {fault}") })
        };
        let shown = self.show.iter().map(|text| signal("--show", text)).collect::<Result<Vec<_>, _>>()?;
        let over = match (&self.order, &self.over) {
            (Some(angle), _) => Over::Order(signal("--order", angle)?),
            (None, Some(over)) => Over::Signal(signal("--over", over)?),
            (None, None) if self.spectrum => Over::Frequency,
            (None, None) => Over::Time,
        };
        Ok(Drawing { model, shown, over, from: self.from, up_to: self.up_to, is_logarithmic: self.log })
    }
}

/// The runs and measurements in CSV files, each by its file's name.
pub fn others(paths: &[PathBuf], model: &'static Description) -> Result<Vec<(String, Recording)>, InputError> {
    let one = |path: &PathBuf| {
        let run = read_file_of(path, model.outputs.iter())?;
        Ok((path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned()), run))
    };
    paths.iter().map(one).collect()
}
