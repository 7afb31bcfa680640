//! What Python asks for: keyword arguments, plans and measurements as the workbench takes them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bg_model::run::State;
use bg_workbench::Program;
use bg_workbench::calls::{self, Asked, Begin};
use bg_workbench::hint;
use bg_workbench::sweep::folder::Folder;
use bg_workbench::sweep::plan::Plan;
use bg_workbench::sweep::{Outcome, Share, recipe, sweep};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::given::refused;
use crate::waiting::Seen;

/// How a run is asked for in Python; what is not given is as on the command line.
pub(crate) fn asked(
    scene: Option<String>,
    set: Option<BTreeMap<String, f64>>,
    inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
    start: &str,
    parameters: Option<BTreeMap<String, f64>>,
) -> PyResult<Asked> {
    let inputs = inputs.unwrap_or_default().into_iter();
    let inputs =
        inputs.map(|(name, value)| Ok(format!("{name}={}", value.str()?))).collect::<PyResult<Vec<String>>>()?;
    let mut set = set.unwrap_or_default();
    set.extend(parameters.unwrap_or_default());
    let start = match start {
        "model" => Begin::Model,
        "equilibrium" => Begin::Equilibrium,
        state if state.trim_start().starts_with('{') => {
            Begin::At(State::from_json(state).map_err(|fault| PyValueError::new_err(format!("start: {fault}")))?)
        }
        other => {
            let fault =
                format!("start {other:?}: give \"model\", \"equilibrium\" or a state, as info[\"state\"] of a run");
            return Err(PyValueError::new_err(fault));
        }
    };
    Ok(Asked { scene, set, inputs, start, ..Asked::default() })
}

/// How it is integrated, where that is given.
pub(crate) fn integrated(
    asked: &mut Asked,
    t_end: Option<f64>,
    step: Option<f64>,
    method: Option<&str>,
    hint: Option<PathBuf>,
    rtol: Option<f64>,
    atol: Option<f64>,
) -> PyResult<()> {
    let integration = &mut asked.integration;
    integration.t_end = t_end.unwrap_or(integration.t_end);
    integration.step = step.unwrap_or(integration.step);
    integration.rtol = rtol.unwrap_or(integration.rtol);
    integration.atol = atol;
    if let Some(method) = method {
        integration.method = method.parse().map_err(|fault| PyValueError::new_err(format!("method: {fault}")))?;
    }
    if let Some(hint) = hint {
        let read = hint::read(&hint.to_string_lossy());
        integration.hint = Some(read.map_err(|fault| PyValueError::new_err(format!("hint {hint:?}: {fault}")))?);
    }
    Ok(())
}

/// A text, or several.
#[derive(FromPyObject)]
pub(crate) enum Texts {
    One(String),
    Several(Vec<String>),
}

impl Texts {
    pub fn all(self) -> Vec<String> {
        match self {
            Self::One(text) => vec![text],
            Self::Several(texts) => texts,
        }
    }
}

/// A plan, as a file or as text.
pub(crate) enum Source {
    File(PathBuf),
    Text(String),
}

/// What is to be done of a sweep.
pub(crate) struct Work {
    pub plan: Source,
    pub out: PathBuf,
    pub share: Share,
    pub threads: usize,
}

impl Source {
    pub fn read<'a>(&self, program: &'a Program) -> Result<Plan<'a>, String> {
        let plan = match self {
            Self::File(path) => Plan::read(program, path),
            Self::Text(text) => Plan::parse(program, "the plan", Path::new(""), text.clone()),
        };
        plan.map_err(|fault| fault.to_string())
    }
}

impl Work {
    /// Does it as long as who waits for it says so.
    pub fn done(&self, program: &Program, seen: &Seen) -> Result<Outcome, String> {
        let plan = self.plan.read(program)?;
        let folder = Folder::claim(&self.out, &recipe::of(program, &plan)).map_err(|fault| fault.to_string())?;
        sweep(program, &plan, &folder, self.share, self.threads, &|done, all| {
            seen.done(done as f64 / all.max(1) as f64)
        })
        .map_err(|fault| fault.to_string())
    }
}

/// A plan from a path or a dict.
pub(crate) fn source(plan: &Bound<'_, PyAny>) -> PyResult<Source> {
    if !plan.is_instance_of::<PyDict>() {
        return Ok(Source::File(plan.extract()?));
    }
    let text: String = plan.py().import("json")?.call_method1("dumps", (plan,))?.extract()?;
    calls::toml_of_json(&text).map(Source::Text).map_err(refused)
}

/// What was measured, as the text of a CSV file: read from a path, or of columns by name.
pub(crate) fn measured(data: &Bound<'_, PyAny>) -> PyResult<String> {
    let Ok(columns) = data.getattr("items") else {
        let path: PathBuf = data.extract()?;
        return Ok(std::fs::read_to_string(path)?);
    };
    let mut named = Vec::new();
    for item in columns.call0()?.try_iter()? {
        let (name, values): (String, Vec<f64>) = item?.extract()?;
        named.push((name, values));
    }
    named.sort_by_key(|(name, _)| name != "t");
    let heads: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
    let rows = named.iter().map(|(_, values)| values.len()).max().unwrap_or_default();
    if let Some((name, values)) = named.iter().find(|(_, values)| values.len() != rows) {
        let fault = format!("data: the column `{name}` has {} values, another one {rows}", values.len());
        return Err(PyValueError::new_err(fault));
    }
    let field = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
    let row = |row| named.iter().map(|(_, values)| field(values[row])).collect::<Vec<_>>().join(",");
    let lines: Vec<String> = std::iter::once(heads.join(",")).chain((0..rows).map(row)).collect();
    Ok(lines.join("\n"))
}
