//! The command `campbell`: natural frequencies over a parameter as a figure, tables and a text.

use std::cell::Cell;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use serde_json::json;

use super::arguments::{ModelArguments, Start};
use super::linearize::{To, check_time, linearised};
use super::methods::integrator;
use super::progress::bar;
use super::run::chosen;
use super::sensitivity::unknown;
use super::{InputError, ended};
use crate::ask::inputs;
use crate::ask::parameters::{Chosen, bounds, number};
use crate::ask::request::Integration;
use crate::ask::scenes::Scene;
use crate::files::json::rows;
use crate::files::{FileError, RunFolder, console};
use crate::program::Program;
use crate::show::figures::FigureError;
use crate::show::output::OutputError;
use crate::studies::sweep::campbell::{Asked, Campbell, campbell as follow, turns};
use bg_analysis::linear::Mode;
use bg_model::integrator::Integrator;
use bg_model::run::Request;

const SVG: &str = "campbell.svg";
const CSV: &str = "campbell.csv";
const CRITICALS: &str = "critical_speeds.csv";
const TEXT: &str = "campbell.txt";

/// What is followed over what.
#[derive(Debug, Args)]
pub struct CampbellArguments {
    /// The parameter, from where to where, in its unit or another one, such as speed=0..12000 or speed=0..200Hz
    #[arg(long, value_name = "NAME=FROM..TO", required = true, allow_hyphen_values = true)]
    pub by: String,

    /// At how many values
    #[arg(long, value_name = "COUNT", default_value = "61", value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub points: u32,

    /// The orders of the parameter, which is a speed, that lines are drawn of: what excites once a turn has the order 1
    /// [default: 1,2 where the parameter is a speed]
    #[arg(long, value_name = "NUMBER", value_delimiter = ',')]
    pub orders: Option<Vec<f64>>,

    /// Draw frequencies up to this one only, Hz [default: a quarter above the highest order]
    #[arg(long, value_name = "HERTZ")]
    pub up_to: Option<f64>,

    #[command(flatten)]
    pub model: ModelArguments,

    /// Where to linearise: as the model starts, with the speeds that it has there, or at rest with its springs loaded
    #[arg(long, value_name = "START", value_enum, default_value_t, conflicts_with = "at")]
    pub start: Start,

    /// Linearise where a run is at this time, s, in place of its start: a run for each value
    #[arg(long, value_name = "SECONDS")]
    pub at: Option<f64>,

    /// The integrator of the runs to --at
    #[arg(long, value_name = "NAME", default_value_t, value_parser = integrator())]
    pub method: Integrator,

    /// Relative tolerance of the runs to --at
    #[arg(long, value_name = "NUMBER", default_value_t = Request::default().rtol)]
    pub rtol: f64,

    /// Print what is found as JSON in place of the text
    #[arg(long)]
    pub json: bool,

    /// Folder for campbell.svg, campbell.csv, critical_speeds.csv and campbell.txt, which replace those of the run
    /// before
    #[arg(long, value_name = "DIR", default_value = "out/campbell")]
    pub out: PathBuf,
}

/// What is asked of a scene: the parameter with its range as `NAME=FROM..TO`, at how many values, which orders, up to
/// which frequency (Hz).
pub fn asked(
    scene: &Scene,
    by: &str,
    points: usize,
    orders: Option<&[f64]>,
    up_to: Option<f64>,
) -> Result<Asked, InputError> {
    let refused = |option: &'static str, fault: String| InputError::Unknown { option, fault };
    let form = || refused("--by", format!("{by}: give it as NAME=FROM..TO, for example speed=0..3000"));
    let (name, range) = by.split_once('=').ok_or_else(form)?;
    let own = scene.description.parameters;
    let info = own.iter().find(|info| info.name == name.trim());
    let absent = || unknown("--by", "parameter", name.trim(), &scene.name, own.iter().map(|info| info.name));
    let info = info.ok_or_else(absent)?;
    let range = bounds(info, range).map_err(|fault| refused("--by", format!("{by}: {fault}")))?;
    let is_speed = turns(info.unit).is_some();
    let orders = match orders {
        Some(_) if !is_speed => {
            let fault = format!("`{}` is in {} and no speed: leave --orders out", info.name, info.unit);
            return Err(refused("--orders", fault));
        }
        Some(orders) => orders.to_vec(),
        None if is_speed => vec![1.0, 2.0],
        None => Vec::new(),
    };
    let is_none = |value: &f64| !(value.is_finite() && *value > 0.0);
    let above = || "a number above 0".to_owned();
    if let Some(&value) = orders.iter().find(|order| is_none(order)) {
        return Err(InputError::Range { name: "--orders", value, range: above() });
    }
    if let Some(value) = up_to.filter(is_none) {
        return Err(InputError::Range { name: "--up-to", value, range: above() });
    }
    Ok(Asked { by: info, range, points, orders, up_to })
}

/// The modes over the parameter: of models that are linearised at `place`, a time (s) or the equilibrium; runs there
/// are made as `to` says. `told` is told after each model how many there were, and says whether to go on.
pub fn followed(
    program: &Program,
    scene: &Scene,
    chosen: &Chosen,
    asked: Asked,
    (place, to): (Option<f64>, To<'_>),
    told: &dyn Fn(usize) -> bool,
) -> Result<Campbell, InputError> {
    let name = asked.by.name;
    let (done, goes_on) = (Cell::new(0), Cell::new(true));
    let modes = |value: f64| -> Result<Vec<Mode>, String> {
        if !goes_on.get() {
            return Err(InputError::Interrupted.to_string());
        }
        let mut values = chosen.values.clone();
        values.set(name, value).map_err(|fault| fault.to_string())?;
        let machine = program.models.made(scene, &values, &chosen.inputs).map_err(|fault| fault.to_string())?;
        let found = linearised(&*machine, place, to);
        done.set(done.get() + 1);
        goes_on.set(told(done.get()));
        Ok(found.map_err(|fault| fault.to_string())?.0.modes)
    };
    let found = follow(asked, modes);
    if !goes_on.get() {
        return Err(InputError::Interrupted);
    }
    match found.failure() {
        Some(why) => {
            let value = number(found.failed[0].0);
            let fault = format!("no linear model from {name} = {value} {} on: {why}", found.asked.by.unit);
            Err(InputError::Unknown { option: "--by", fault })
        }
        None => Ok(found),
    }
}

impl CampbellArguments {
    /// Where it is linearised: at a time, s, or at the equilibrium.
    fn place(&self) -> Option<f64> {
        match (self.at, self.start) {
            (Some(at), _) => Some(at),
            (None, Start::Model) => Some(0.0),
            (None, Start::Equilibrium) => None,
        }
    }
}

pub fn campbell(program: &Program, arguments: &CampbellArguments) -> Result<ExitCode, InputError> {
    check_time("--at", arguments.at)?;
    let (chosen, named) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let CampbellArguments { by, points, orders, up_to, .. } = arguments;
    let asked = asked(scene, by, *points as usize, orders.as_deref(), *up_to)?;
    let folder = RunFolder::claim(&arguments.out, &[SVG, CSV, CRITICALS, TEXT].map(str::to_owned))?;
    let bar = bar(u64::from(*points), "linearised at {pos} of {len} values");
    let told = |_| {
        bar.inc(1);
        true
    };
    let integration = Integration::by(arguments.method, arguments.rtol);
    let place_and_way: (_, To<'_>) = (arguments.place(), &|t| integration.request_to(t));
    let found = followed(program, scene, &chosen, asked, place_and_way, &told);
    bar.finish_and_clear();
    let found = found?;
    let inputs = inputs::text(&named, [0.0, arguments.place().unwrap_or(0.0)]);
    let text = format!("{}{inputs}", found.text());
    let (is_written, faults) = write(folder, &found, &scene.name, &text);
    let written = if is_written { arguments.out.display().to_string() } else { "nothing".to_owned() };
    let told = format!("{text}\nwritten: {written}; open {SVG} there\n");
    let json =
        || json!({ "modes": rows(&found.modes().csv()), "critical_speeds": rows(&found.critical_speeds().csv()) });
    let printed = console::tell_as(arguments.json, &told, json);
    Ok(ended(faults.into_iter().chain(printed.err().map(OutputError::from))))
}

/// Writes the files; says whether they are there, and what failed.
fn write(mut folder: RunFolder, found: &Campbell, scene: &str, text: &str) -> (bool, Vec<OutputError>) {
    let mut faults = Vec::new();
    let mut fill = || -> Result<(), FileError> {
        folder.write_text(TEXT, text)?;
        folder.write_text(CSV, &found.modes().csv())?;
        if !found.asked.orders.is_empty() {
            folder.write_text(CRITICALS, &found.critical_speeds().csv())?;
        }
        match found.drawn(scene) {
            Ok(svg) => folder.write_text(SVG, &svg),
            // No mode swings where one could be drawn.
            Err(FigureError::Empty) => Ok(()),
            Err(source) => {
                faults.push(OutputError::Figure { file: SVG.to_owned(), source });
                Ok(())
            }
        }
    };
    match fill().and_then(|()| folder.publish()) {
        Ok(_) => (true, faults),
        Err(fault) => {
            faults.push(fault.into());
            (false, faults)
        }
    }
}
