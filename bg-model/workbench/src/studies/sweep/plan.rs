//! The plan of a sweep: which model is run, with which values, and what is kept.
//!
//! In: a TOML file. Out: a [`Plan`] in which everything has been checked that can be before a run, or one line that
//! says what to change. Parameters, inputs and tolerances are read and checked as those of the command `run`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use bg_analysis::criterion::Criteria;
use bg_analysis::criterion::of_run::Look;
use bg_model::description::Description;
use bg_model::run::Request;
use serde::Deserialize;
use thiserror::Error;
use toml::Spanned;

use super::design::{Axis, Design, DesignError, Interval};
use super::distribution::{Distribution, Drawn};
use super::wanted::{Numbers, Reduction, Wanted};
use crate::ask::hint;
use crate::ask::inputs::{self, InputSettingError, Setting};
use crate::ask::parameters::{self, Chosen, SettingError, Values, nearest, one_line, place_of};
use crate::ask::request::{Integration, RequestError};
use crate::ask::scenes::{Fixed, Scene, check_fixed};
use crate::files::head::is_row;
use crate::program::Program;
use crate::run::running::Begin;

/// Runs in a shard, unless the plan says how many or trajectories are kept.
const SHARD: usize = 200;
/// The most numbers of trajectories in a shard then: some 16 MB.
const MOST_NUMBERS: usize = 2_000_000;

/// A plan that cannot be followed. All but the first begin with the plan's name.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The plan or its list cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is no TOML, or has words that no plan has.
    #[error("{plan}, line {line}, column {column}: {message}")]
    Toml {
        /// The plan.
        plan: String,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// A parameter.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A parameter that the scene has not.
    #[error("{place}: {fault}")]
    Fixed {
        /// The plan and what of it.
        place: String,
        /// What is wrong.
        fault: Box<Fixed>,
    },
    /// An input.
    #[error("{plan}, [inputs]: {}", fault.to_string().trim_start_matches("--input "))]
    Input {
        /// The plan.
        plan: String,
        /// What is wrong.
        fault: Box<InputSettingError>,
    },
    /// Times or tolerances.
    #[error("{plan}: {fault}")]
    Request {
        /// The plan.
        plan: String,
        /// What is wrong.
        fault: RequestError,
    },
    /// No runs.
    #[error("{plan}, {of}: {fault}")]
    Design {
        /// The plan.
        plan: String,
        /// Where.
        of: &'static str,
        /// What is wrong.
        fault: DesignError,
    },
    /// A list that is no table of numbers.
    #[error("{plan}: the list {}: {fault}", list.display())]
    List {
        /// The plan.
        plan: String,
        /// The list.
        list: PathBuf,
        /// What is wrong.
        fault: String,
    },
    /// Anything else, as a sentence.
    #[error("{plan}: {fault}")]
    Other {
        /// The plan.
        plan: String,
        /// What is wrong.
        fault: String,
    },
}

/// The file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    scene: Option<String>,
    t_end: Option<f64>,
    step: Option<f64>,
    method: Option<String>,
    hint: Option<String>,
    rtol: Option<f64>,
    atol: Option<f64>,
    fixed_step: Option<f64>,
    step_limit: Option<u64>,
    #[serde(default)]
    start: Start,
    shard: Option<usize>,
    params: Option<PathBuf>,
    #[serde(default)]
    set: toml::Table,
    #[serde(default)]
    inputs: BTreeMap<String, Given>,
    grid: Option<BTreeMap<String, Spanned<Axis>>>,
    list: Option<PathBuf>,
    latin_hypercube: Option<Sampled<u64>>,
    sobol: Option<Sampled<u32>>,
    tolerances: Option<Tolerances>,
    numbers: Option<BTreeMap<String, Spanned<String>>>,
    columns: Option<Columns>,
    #[serde(default)]
    event_times: usize,
    #[serde(default)]
    trajectories: Trajectories,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Start {
    #[default]
    Model,
    Equilibrium,
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "give a number, or the name of a CSV file")]
enum Given {
    Number(f64),
    File(String),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sampled<Seed> {
    count: usize,
    seed: Seed,
    ranges: BTreeMap<String, Spanned<Interval>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tolerances {
    count: usize,
    seed: u64,
    #[serde(default)]
    indices: bool,
    #[serde(default)]
    correlations: Vec<(String, String, f64)>,
    parameters: BTreeMap<String, Spanned<Distribution>>,
}

#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "give lists of max, min, mean, final and integral by output, or one such list for all outputs"
)]
enum Columns {
    All(Vec<Reduction>),
    Named(BTreeMap<String, Vec<Reduction>>),
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "give true for all outputs, or a list of outputs")]
enum Trajectories {
    All(bool),
    Named(Vec<String>),
}

impl Default for Trajectories {
    fn default() -> Self {
        Self::All(false)
    }
}

/// A plan, checked.
#[derive(Debug)]
pub struct Plan<'a> {
    /// The file's text.
    pub text: String,
    /// The model.
    pub scene: &'a Scene,
    /// How it is integrated.
    pub integration: Integration,
    /// The same, as it is asked of each run.
    pub request: Request,
    /// Where runs begin.
    pub begin: Begin,
    /// The parameters that are not swept, and the inputs.
    pub chosen: Chosen,
    /// The inputs as they were set.
    pub settings: Vec<Setting>,
    /// The values of the others.
    pub design: Design,
    /// What is kept.
    pub wanted: Wanted,
    /// Numbers of runs that are kept beside that.
    pub numbers: Option<Numbers>,
    /// Runs in a shard.
    pub shard: usize,
}

impl<'a> Plan<'a> {
    /// Reads the plan at `path`. Names of files in it are seen from the plan's folder.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn read(program: &'a Program, path: &Path) -> Result<Self, PlanError> {
        let text =
            fs::read_to_string(path).map_err(|source| PlanError::Unreadable { path: path.to_owned(), source })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(program, &path.display().to_string(), folder, text)
    }

    /// The plan with this `text`, which messages call `plan`; names of files in it are seen from `folder`.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn parse(program: &'a Program, plan: &str, folder: &Path, text: String) -> Result<Self, PlanError> {
        let file = entries(plan, &text)?;
        let other = |fault: String| PlanError::Other { plan: plan.to_owned(), fault };
        let scene = program.find_scene(file.scene.as_deref()).map_err(other)?;
        let params = file.params.as_ref().map(|params| folder.join(params));
        let (graph, scenes) = (program.models.graph().description, &program.models.scenes);
        let mut chosen = parameters::merge(graph.parameters, params.as_deref(), &[])?;
        parameters::set_from_table(&mut chosen, &format!("{plan}, [set]"), &file.set)?;
        let settings = inputs(&file.inputs, folder, graph)
            .map_err(|fault| PlanError::Input { plan: plan.to_owned(), fault: Box::new(fault) })?;
        chosen.inputs = inputs::made(&settings);
        let (of, design) = design(&file, plan, folder)?;
        check_parameters(&design, &chosen, &format!("{plan}, {of}"), scene, scenes)?;
        if let Some(name) = design.names.iter().find(|name| file.set.contains_key(*name)) {
            return Err(other(format!("`{name}` is both in [set] and swept; take it out of one of them")));
        }
        let integration = integration(&file).map_err(other)?;
        let request = integration.request(0.0, None);
        let mut request = request.map_err(|fault| PlanError::Request { plan: plan.to_owned(), fault })?;
        request.step_limit = file.step_limit.unwrap_or(request.step_limit);
        let wanted = wanted(&file, scene.description).map_err(other)?;
        request.peaks = wanted.has_peaks();
        let numbers = numbers(&file, scene.description, &integration).map_err(other)?;
        check_names(&design, &wanted, numbers.as_ref(), scene.description).map_err(other)?;
        let rows = 1 + (integration.t_end / integration.step) as usize;
        let samples = rows * wanted.trajectories.len();
        let shard = file.shard.unwrap_or_else(|| MOST_NUMBERS.checked_div(samples).unwrap_or(SHARD).clamp(1, SHARD));
        if shard == 0 {
            return Err(other("shard is 0; give the number of runs in a file, such as 200".to_owned()));
        }
        let begin = match file.start {
            Start::Model => Begin::Model,
            Start::Equilibrium => Begin::Equilibrium,
        };
        Ok(Self { text, scene, integration, request, begin, chosen, settings, design, wanted, numbers, shard })
    }
}

/// The entries of a plan. For all mechanisms the same, so it is compiled once.
fn entries(plan: &str, text: &str) -> Result<File, PlanError> {
    toml::from_str(text).map_err(|fault| {
        let [line, column] = place_of(&fault, text);
        PlanError::Toml { plan: plan.to_owned(), line, column, message: one_line(fault.message()) }
    })
}

fn inputs(
    given: &BTreeMap<String, Given>,
    folder: &Path,
    model: &Description,
) -> Result<Vec<Setting>, InputSettingError> {
    let setting = |(name, given): (&String, &Given)| match given {
        Given::Number(value) => format!("{name}={value}"),
        Given::File(file) => {
            let (kind, file) = match file.strip_prefix(inputs::CUBIC) {
                Some(file) => (inputs::CUBIC, file),
                None => ("", file.as_str()),
            };
            format!("{name}={kind}{}", folder.join(file).display())
        }
    };
    inputs::settings(&given.iter().map(setting).collect::<Vec<_>>(), model.inputs)
}

/// The runs, and the part of the plan that says which.
fn design(file: &File, plan: &str, folder: &Path) -> Result<(&'static str, Design), PlanError> {
    let kinds = [
        ("[grid]", file.grid.is_some()),
        ("list", file.list.is_some()),
        ("[latin_hypercube]", file.latin_hypercube.is_some()),
        ("[sobol]", file.sobol.is_some()),
        ("[tolerances]", file.tolerances.is_some()),
    ];
    let there: Vec<&'static str> = kinds.into_iter().filter(|(_, is_there)| *is_there).map(|(kind, _)| kind).collect();
    let [of] = there[..] else {
        let found = if there.is_empty() { "none".to_owned() } else { there.join(" and ") };
        let fault = format!("give one of [grid], list, [latin_hypercube], [sobol] and [tolerances]; there is {found}");
        return Err(PlanError::Other { plan: plan.to_owned(), fault });
    };
    let design = if let Some(grid) = &file.grid {
        Design::grid(&in_order(grid))
    } else if let Some(list) = &file.list {
        let path = folder.join(list);
        let (names, rows) =
            rows(&path).map_err(|fault| PlanError::List { plan: plan.to_owned(), list: path, fault })?;
        Design::list(names, rows)
    } else if let Some(Sampled { count, seed, ranges }) = &file.latin_hypercube {
        Design::latin_hypercube(&in_order(ranges), *count, *seed)
    } else if let Some(tolerances) = &file.tolerances {
        let fault = |fault| PlanError::Other { plan: plan.to_owned(), fault: format!("{of}: {fault}") };
        let (names, drawn) = drawn(tolerances).map_err(fault)?;
        Design::drawn(names, drawn, tolerances.count)
    } else {
        let Sampled { count, seed, ranges } = file.sobol.as_ref().expect("one of them is there");
        Design::sobol(&in_order(ranges), *count, *seed)
    };
    match design {
        Ok(design) => Ok((of, design)),
        Err(fault) => Err(PlanError::Design { plan: plan.to_owned(), of, fault }),
    }
}

/// The parameters that tolerances spread, and what they are drawn from.
fn drawn(tolerances: &Tolerances) -> Result<(Vec<String>, Drawn), String> {
    let Tolerances { seed, indices, correlations, parameters, .. } = tolerances;
    let (names, distributions): (Vec<String>, Vec<Distribution>) = in_order(parameters).into_iter().unzip();
    for (name, distribution) in names.iter().zip(&distributions) {
        distribution.check().map_err(|fault| format!("`{name}`: {fault}"))?;
    }
    let place = |name: &String| {
        let found = names.iter().position(|known| known == name);
        found.ok_or_else(|| format!("the correlation of `{name}`: it is none of the parameters here"))
    };
    let correlations = correlations.iter().map(|(a, b, value)| Ok((place(a)?, place(b)?, *value)));
    let correlations = correlations.collect::<Result<Vec<_>, String>>()?;
    let drawn = Drawn::new(distributions, &correlations, *seed, *indices)?;
    Ok((names, drawn))
}

/// The numbers of runs that are kept, by their names.
fn numbers(file: &File, model: &'static Description, integration: &Integration) -> Result<Option<Numbers>, String> {
    let Some(texts) = &file.numbers else { return Ok(None) };
    if file.columns.is_some() || !matches!(file.trajectories, Trajectories::All(false)) {
        return Err("[numbers] are beside no columns and no trajectories; leave out one of them".to_owned());
    }
    if matches!(file.start, Start::Equilibrium) {
        return Err("[numbers] are of runs from the model's own start; leave out start".to_owned());
    }
    let mut criteria = Criteria::new(model);
    let mut named = Vec::new();
    for (name, text) in in_order(texts) {
        let found = criteria.criterion(&text).map_err(|fault| format!("[numbers], `{name}`: {fault}"))?;
        named.push((name, found));
    }
    let look = Look::new(criteria, integration.step, integration.t_end).map_err(|fault| fault.to_string())?;
    Ok(Some(Numbers { look, named }))
}

/// As they stand in the file: the parser sorts them by name.
fn in_order<T: Clone>(named: &BTreeMap<String, Spanned<T>>) -> Vec<(String, T)> {
    let mut named: Vec<_> = named.iter().collect();
    named.sort_by_key(|(_, value)| value.span().start);
    named.into_iter().map(|(name, value)| (name.clone(), value.get_ref().clone())).collect()
}

/// Header and rows of a CSV file of numbers.
fn rows(path: &Path) -> Result<(Vec<String>, Vec<f64>), String> {
    let said = |fault: csv::Error| one_line(&fault.to_string());
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(said)?;
    let first = reader.headers().map_err(said)?;
    if is_row(first) {
        return Err("its first line has numbers; write a first line with the names of the parameters".to_owned());
    }
    let names: Vec<String> = first.iter().map(str::to_owned).collect();
    if let Some(name) = names.iter().enumerate().find_map(|(k, name)| names[..k].contains(name).then_some(name)) {
        return Err(format!("the column `{name}` is there twice"));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(said)?;
        let line = record.position().map_or(0, csv::Position::line);
        for field in &record {
            rows.push(field.parse().map_err(|_| format!("`{field}` in line {line} is not a number"))?);
        }
    }
    Ok((names, rows))
}

/// Sets each swept parameter to values that lie around all others, as `run` would.
fn check_parameters(
    design: &Design,
    chosen: &Chosen,
    place: &str,
    scene: &Scene,
    scenes: &[Scene],
) -> Result<(), PlanError> {
    let check = |values: &Values, places: &[String]| {
        check_fixed(scene, scenes, values).map_err(|fault| {
            let set = &places[fault.index];
            PlanError::Fixed { place: set.clone(), fault: Box::new(fault) }
        })
    };
    check(&chosen.values, &chosen.places)?;
    for (parameter, name) in design.names.iter().enumerate() {
        for value in design.extremes(parameter) {
            let mut probe = chosen.clone();
            parameters::set(&mut probe, place, name, value)?;
            check(&probe.values, &probe.places)?;
        }
    }
    Ok(())
}

fn integration(file: &File) -> Result<Integration, String> {
    let usual = Integration::default();
    let method = file
        .method
        .as_ref()
        .map_or(Ok(usual.method), |name| name.parse().map_err(|fault| format!("method: {fault}")))?;
    Ok(Integration {
        t_end: file.t_end.unwrap_or(usual.t_end),
        step: file.step.unwrap_or(usual.step),
        method,
        hint: file.hint.as_deref().map(hint::read).transpose().map_err(|fault| format!("hint: {fault}"))?,
        rtol: file.rtol.unwrap_or(usual.rtol),
        atol: file.atol,
        fixed_step: file.fixed_step.unwrap_or(usual.fixed_step),
    })
}

fn wanted(file: &File, model: &Description) -> Result<Wanted, String> {
    let output = |name: &String| {
        model.outputs.iter().position(|output| output.name == name).ok_or_else(|| {
            let near = nearest(name, model.outputs.iter().map(|output| output.name));
            let near = near.map_or_else(
                || "the command `scene` lists the outputs".to_owned(),
                |near| format!("did you mean `{near}`?"),
            );
            format!("there is no output `{name}`; {near}")
        })
    };
    let all = |reductions: &[Reduction]| {
        (0..model.outputs.len()).flat_map(|output| reductions.iter().map(move |&by| (output, by))).collect()
    };
    let mut trajectories = match &file.trajectories {
        Trajectories::All(true) => (0..model.outputs.len()).collect(),
        Trajectories::All(false) => Vec::new(),
        Trajectories::Named(names) => names.iter().map(output).collect::<Result<_, _>>()?,
    };
    let mut reductions: Vec<(usize, Reduction)> = match &file.columns {
        None if file.numbers.is_some() || file.event_times > 0 || !trajectories.is_empty() => Vec::new(),
        None => all(&[Reduction::Max, Reduction::Min, Reduction::Mean, Reduction::Final]),
        Some(Columns::All(reductions)) => all(reductions),
        Some(Columns::Named(named)) => {
            let mut all = Vec::new();
            for (name, reductions) in named {
                let output = output(name)?;
                all.extend(reductions.iter().map(|&by| (output, by)));
            }
            all
        }
    };
    // In the order of the model, whatever that of the plan.
    trajectories.sort_unstable();
    trajectories.dedup();
    reductions.sort_unstable();
    reductions.dedup();
    Ok(Wanted { reductions, event_times: file.event_times, trajectories })
}

/// No column may be called as another.
fn check_names(design: &Design, wanted: &Wanted, numbers: Option<&Numbers>, model: &Description) -> Result<(), String> {
    let numbers = numbers.into_iter().flat_map(Numbers::columns);
    let kept = wanted.columns(model).into_iter().chain(numbers).map(|(name, _)| name);
    let mut names: Vec<String> = super::OWN_COLUMNS.map(str::to_owned).into_iter().chain(kept).collect();
    names.extend(design.names.iter().cloned());
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(format!("the table would have two columns `{}`; leave one of them out", pair[0])),
        None => Ok(()),
    }
}
