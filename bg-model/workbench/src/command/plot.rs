//! The command `plot`: outputs of a run over time, against each other, as spectra; other runs and measurements beside
//! them.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_analysis::criterion::{Criteria, Signal};
use bg_analysis::spectrum::{over_frequency, over_order};
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
use crate::show::figures::plot::{Mark, Plot, Series, with_unit};

/// What is drawn.
#[derive(Debug, Args)]
pub struct PlotArguments {
    /// What is drawn: outputs, or made of them, such as "|pin.force|" or "speed * torque"; several with further --show
    #[arg(long, value_name = "SIGNAL", required = true, allow_hyphen_values = true)]
    pub show: Vec<String>,

    /// Over this in place of the time: a phase plane, a path, a hodograph. Where both are in one unit, both axes have one
    /// scale
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

    /// Draw spectra up to this frequency or order only
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
}

/// The least number of samples: a drawing of fewer would have corners.
const SAMPLES: f64 = 4000.0;

pub fn plot(program: &Program, arguments: &PlotArguments) -> Result<ExitCode, InputError> {
    let (chosen, _) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let model = scene.description;
    let mut criteria = Criteria::new(model);
    let mut signal = |option: &'static str, text: &str| {
        criteria.signal(text).map_err(|fault| InputError::Unknown { option, fault: format!("{text}: {fault}") })
    };
    let shown = arguments.show.iter().map(|text| signal("--show", text)).collect::<Result<Vec<_>, _>>()?;
    let over = arguments.over.as_ref().map(|text| signal("--over", text)).transpose()?;
    let order = arguments.order.as_ref().map(|text| signal("--order", text)).transpose()?;
    let request = request(&arguments.integration, 0.0, None)?;
    if !(0.0..request.t_end).contains(&arguments.from) {
        let range = format!("a time in the run, 0 to {} s", request.t_end);
        return Err(InputError::Range { name: "--from", value: arguments.from, range });
    }
    let step = arguments.integration.step.min((request.t_end - arguments.from) / SAMPLES);
    let rows = sample_times(arguments.from, step, request.t_end);
    let samples = Samples::At(rows);
    let machine = machine(program, scene, &chosen)?;
    let asked = Asked { model, shown, over, order };
    let own = own_values(scene, &program.models.scenes, &chosen.values)
        .map_err(|fault| InputError::Unknown { option: "--set", fault: fault.to_string() })?;
    let others: Vec<(String, Recording)> = arguments
        .others
        .iter()
        .map(|path| {
            let run = read_file_of(path, model.outputs.iter())?;
            asked.check(&run).map_err(|name| InputError::Unknown {
                option: "--with",
                fault: format!("{} has no column `{name}`", path.display()),
            })?;
            Ok((path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned()), run))
        })
        .collect::<Result<_, InputError>>()?;
    let outcome = follow(&*machine, Request { samples, ..request }, None)?;
    let mut series = asked.series("", &outcome.run.recording, own.values(), arguments);
    for (name, run) in &others {
        series.extend(asked.series(name, run, own.values(), arguments));
    }
    let svg = asked.plot(&scene.name, series, arguments).drawn().map_err(|source| {
        crate::show::output::OutputError::Figure { file: arguments.out.display().to_string(), source }
    })?;
    if let Some(folder) = arguments.out.parent() {
        let failed = |source| FileError::Write { path: folder.to_owned(), source };
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    whole::write(&arguments.out, |file| file.write_all(svg.as_bytes()))?;
    let printed = console::tell(&format!("written: {}\n", arguments.out.display()));
    let failure = outcome.failure.map(|failure| format!("the run failed: {failure}"));
    Ok(ended(printed.err().map(|fault| fault.to_string()).into_iter().chain(failure)))
}

/// What is drawn of each run.
struct Asked {
    model: &'static Description,
    shown: Vec<Signal>,
    over: Option<Signal>,
    order: Option<Signal>,
}

impl Asked {
    fn signals(&self) -> impl Iterator<Item = &Signal> {
        self.shown.iter().chain(&self.over).chain(&self.order)
    }

    /// The columns that are needed of another run.
    ///
    /// # Errors
    /// The name of one that it has not.
    fn check(&self, run: &Recording) -> Result<(), &'static str> {
        let needed = self.signals().flat_map(Signal::outputs).map(|place| self.model.outputs[place].name);
        needed.into_iter().try_for_each(|name| match run.columns.iter().any(|column| column.name == name) {
            true => Ok(()),
            false => Err(name),
        })
    }

    /// What is drawn of a run, which is called `name` where there are several.
    fn series(&self, name: &str, run: &Recording, parameters: &[f64], arguments: &PlotArguments) -> Vec<Series> {
        let from = run.times.partition_point(|t| *t < arguments.from);
        let times = &run.times[from..];
        let column = |place: usize| {
            let wanted = self.model.outputs[place].name;
            let found = run.columns.iter().find(|column| column.name == wanted);
            found.map_or(&[][..], |column| &column.values[from..])
        };
        let values = |signal: &Signal| signal.values(self.model, parameters, times, column);
        let angles = self.order.as_ref().map(values);
        let over = self.over.as_ref().map(values);
        let pair = |signal: &Signal| -> Vec<(f64, f64)> {
            let own = values(signal);
            let mut points: Vec<(f64, f64)> = match (&angles, &over) {
                (Some(angles), _) => over_order(angles, &own),
                (None, Some(over)) => over.iter().copied().zip(own).collect(),
                (None, None) if arguments.spectrum => over_frequency(times, &own),
                (None, None) => times.iter().copied().zip(own).collect(),
            };
            if let Some(end) = arguments.up_to.filter(|_| angles.is_some() || arguments.spectrum) {
                points.retain(|(place, _)| *place <= end);
            }
            points
        };
        let several = self.shown.len() > 1;
        let called = |signal: &Signal| match (several, name) {
            (_, "") if several || !arguments.others.is_empty() => signal.text.clone(),
            (_, "") => String::new(),
            (true, name) => format!("{}, {name}", signal.text),
            (false, name) => name.to_owned(),
        };
        let one = |signal: &Signal| Series { name: called(signal), points: pair(signal), mark: Mark::Line };
        self.shown.iter().map(one).collect()
    }

    fn plot(&self, scene: &str, series: Vec<Series>, arguments: &PlotArguments) -> Plot {
        let names: Vec<&str> = self.shown.iter().map(|signal| signal.text.as_str()).collect();
        let unit = self.shown[0].unit();
        let is_one_unit = self.shown.iter().all(|signal| signal.unit() == unit);
        let what = with_unit(&names.join(", "), if is_one_unit { unit } else { "" });
        let (across, what) = match (&self.order, &self.over) {
            (Some(order), _) => (format!("order of {}", order.text), format!("amplitude of {what}")),
            (None, Some(over)) => (with_unit(&over.text, over.unit()), what),
            (None, None) if arguments.spectrum => ("frequency in Hz".to_owned(), format!("amplitude of {what}")),
            (None, None) => ("t in s".to_owned(), what),
        };
        let is_path = self.over.as_ref().is_some_and(|over| is_one_unit && over.unit() == unit && !unit.is_empty());
        let mut plot = Plot::new(&format!("{scene}: {}", names.join(", ")), &across, &what, series);
        (plot.is_true_to_scale, plot.is_logarithmic) = (is_path, arguments.log);
        plot
    }
}
