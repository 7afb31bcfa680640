//! What Python asks for: keyword arguments, plans and measurements as the workbench takes them.

use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};

use bg_model::run::State;
use bg_workbench::Program;
use bg_workbench::calls::{self, Asked, Begin, Measurement};
use bg_workbench::hint;
use bg_workbench::sweep::folder::Folder;
use bg_workbench::sweep::plan::Plan;
use bg_workbench::sweep::{Outcome, Share, recipe, sweep};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::given::refused;
use crate::signal::{Raised, Signal, input};
use crate::waiting::Seen;

/// What is asked, and what functions that are asked meanwhile have raised.
#[derive(Default)]
pub(crate) struct Question {
    asked: Asked,
    raised: Raised,
}

impl Question {
    /// Both.
    pub fn parts(self) -> (Asked, Raised) {
        (self.asked, self.raised)
    }
}

impl Deref for Question {
    type Target = Asked;

    fn deref(&self) -> &Asked {
        &self.asked
    }
}

impl DerefMut for Question {
    fn deref_mut(&mut self) -> &mut Asked {
        &mut self.asked
    }
}

/// How a run is asked for in Python; what is not given is as on the command line.
pub(crate) fn asked(
    scene: Option<String>,
    set: Option<Numbers>,
    inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
    start: &str,
    parameters: Option<Numbers>,
) -> PyResult<Question> {
    let raised = Raised::default();
    let (mut texts, mut signals) = (Vec::new(), BTreeMap::new());
    for (name, value) in inputs.unwrap_or_default() {
        match input(&name, &value, &raised)? {
            Signal::Text(text) => texts.push(format!("{name}={text}")),
            Signal::Setting(setting) => drop(signals.insert(name, setting)),
        }
    }
    let (Numbers(mut set), Numbers(parameters)) = (set.unwrap_or_default(), parameters.unwrap_or_default());
    set.extend(parameters);
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
    Ok(Question { asked: Asked { scene, set, inputs: texts, signals, start, ..Asked::default() }, raised })
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

/// Numbers by name.
#[derive(Default)]
pub(crate) struct Numbers(BTreeMap<String, f64>);

impl<'py> FromPyObject<'_, 'py> for Numbers {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number = |(name, value): (String, Bound<'py, PyAny>)| {
            let number = value
                .extract()
                .map_err(|_| PyTypeError::new_err(format!("{name}={value:?}: give a number, in the parameter's unit")));
            Ok((name, number?))
        };
        given
            .extract::<BTreeMap<String, Bound<'_, PyAny>>>()?
            .into_iter()
            .map(number)
            .collect::<PyResult<_>>()
            .map(Self)
    }
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
        let mut plan = self.plan.read(program)?;
        plan.request.interrupt = seen.interrupt();
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

/// What was measured: the path of a CSV file, or columns by name.
pub(crate) fn measured(data: &Bound<'_, PyAny>) -> PyResult<Measurement> {
    let Ok(columns) = data.getattr("items") else { return Ok(Measurement::File(data.extract()?)) };
    let column = |item: PyResult<Bound<'_, PyAny>>| {
        let (name, values): (String, Bound<'_, PyAny>) = item?.extract()?;
        let values = values.extract().map_err(|_| {
            PyValueError::new_err(format!("data: the column `{name}` has values that are no numbers; leave it out"))
        });
        Ok((name, values?))
    };
    columns.call0()?.try_iter()?.map(column).collect::<PyResult<_>>().map(Measurement::Columns)
}
