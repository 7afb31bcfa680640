//! The functions of a model's module.
//!
//! In: keyword arguments. Out: tables; or `ValueError` with the sentence that the command line would say.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bg_model::integrator::Integrator;
use bg_model::nalgebra::DMatrix;
use bg_model::run::State;
use bg_workbench::Program;
use bg_workbench::calls::{self, Asked, Begin, Fit, Number, Ran};
use bg_workbench::files::head::name_and_unit;
use bg_workbench::files::parquet;
use bg_workbench::hint;
use bg_workbench::inputs::Named;
use bg_workbench::optimize;
use bg_workbench::sweep::folder::{Folder, Kind};
use bg_workbench::sweep::plan::Plan;
use bg_workbench::sweep::{Outcome, Share, recipe, shown, sweep};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::table::{Table, Values};
use crate::waiting::{Seen, interruptible};

pyo3::create_exception!(
    bg_python,
    RunFailed,
    PyValueError,
    "A run that stopped before its end; `run` has what was reached."
);

/// The functions that a module has.
pub const FUNCTIONS: [&str; 17] = [
    "run",
    "step",
    "plot",
    "graph",
    "report",
    "linearize",
    "campbell",
    "sensitivity",
    "gradient",
    "identify",
    "optimize",
    "parameters",
    "scenes",
    "outputs",
    "sweep",
    "sweep_shards",
    "read_sweep",
];

/// A plan, as a file or as text.
enum Source {
    File(PathBuf),
    Text(String),
}

/// What is to be done of a sweep.
struct Work {
    plan: Source,
    out: PathBuf,
    share: Share,
    threads: usize,
}

impl Source {
    fn read<'a>(&self, program: &'a Program) -> Result<Plan<'a>, String> {
        let plan = match self {
            Self::File(path) => Plan::read(program, path),
            Self::Text(text) => Plan::parse(program, "the plan", Path::new(""), text.clone()),
        };
        plan.map_err(|fault| fault.to_string())
    }
}

impl Work {
    /// Does it as long as who waits for it says so.
    fn done(&self, program: &Program, seen: &Seen) -> Result<Outcome, String> {
        let plan = self.plan.read(program)?;
        let folder = Folder::claim(&self.out, &recipe::of(program, &plan)).map_err(|fault| fault.to_string())?;
        sweep(program, &plan, &folder, self.share, self.threads, &|done, all| {
            seen.done(done as f64 / all.max(1) as f64)
        })
        .map_err(|fault| fault.to_string())
    }
}

/// A model, whose methods are the functions of its module.
#[pyclass(frozen)]
pub struct Model {
    program: Box<dyn Fn() -> Program + Send + Sync>,
}

impl Model {
    /// Of a program, which is made for each question.
    pub fn new(program: impl Fn() -> Program + Send + Sync + 'static) -> Self {
        Self { program: Box::new(program) }
    }
}

/// What cannot be done, as Python raises it.
fn refused(fault: impl ToString) -> PyErr {
    PyValueError::new_err(fault.to_string())
}

/// How a run is asked for in Python; what is not given is as on the command line.
fn asked(
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
fn integrated(
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

#[pymethods]
impl Model {
    fn __repr__(&self) -> String {
        let [_, about] = calls::about(&(self.program)());
        format!("<Model: {}>", about.lines().next().unwrap_or_default())
    }

    /// What the model is.
    #[getter]
    fn about(&self) -> String {
        let [_, about] = calls::about(&(self.program)());
        about
    }

    /// The program's version.
    #[getter]
    fn version(&self) -> String {
        let [version, _] = calls::about(&(self.program)());
        version
    }

    /// Run the model; parameters are keyword arguments, inputs numbers or names of CSV files.
    ///
    /// Gives a table with the time `t` in s every `step` s until `t_end` s, and all outputs of the scene. `set` takes
    /// parameters whose names are no Python names. `hint` is what `auto` begins with: a method's name, the
    /// `info["hint"]` of a run like this, which is the method that made most of it, or a `summary.json`.
    /// `info["inputs"]` has of each input its `unit`, whether it was given, and its `value` or the `table` that it
    /// follows: file, CRC-32, rows, first and last row. Raises ValueError where something cannot be, RunFailed where
    /// the run stops before its end.
    #[pyo3(signature = (scene=None, *, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, fixed_step=None, start="model", inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn run(
        &self,
        py: Python<'_>,
        scene: Option<String>,
        t_end: Option<f64>,
        step: Option<f64>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        fixed_step: Option<f64>,
        start: &str,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Table> {
        let mut asked = asked(scene, set, inputs, start, parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        asked.integration.fixed_step = fixed_step.unwrap_or(asked.integration.fixed_step);
        let mut ran = interruptible(py, |seen| calls::run(&(self.program)(), &asked, &|part| seen.done(part)))?
            .map_err(refused)?;
        let failure = ran.failure.take();
        let table = table(py, ran)?;
        match failure {
            None => Ok(table),
            Some(failure) => Err(run_failed(py, &failure, table)?),
        }
    }

    /// Go on by `dt` s from a state: what a controller or an environment for learning does again and again.
    ///
    /// Gives the next state and the outputs there by name. A state is a text, the `info["state"]` of a run; without one
    /// it begins at the model's own start. Inputs and parameters are those of this step. Raises `RunFailed` where it
    /// does not come to its end.
    #[pyo3(signature = (state=None, dt=0.01, scene=None, *, method=None, hint=None, rtol=None, atol=None, fixed_step=None, inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn step<'py>(
        &self,
        py: Python<'py>,
        state: Option<&str>,
        dt: f64,
        scene: Option<String>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        fixed_step: Option<f64>,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<(String, Bound<'py, PyDict>)> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(PyValueError::new_err(format!("dt {dt}: must be a finite number above 0")));
        }
        let mut asked = asked(scene, set, inputs, state.unwrap_or("model"), parameters)?;
        let t_end = asked.start.time() + dt;
        integrated(&mut asked, Some(t_end), Some(dt), method, hint, rtol, atol)?;
        asked.integration.fixed_step = fixed_step.unwrap_or(asked.integration.fixed_step);
        let mut ran = interruptible(py, |seen| calls::run(&(self.program)(), &asked, &|part| seen.done(part)))?
            .map_err(refused)?;
        if let Some(failure) = ran.failure.take() {
            return Err(run_failed(py, &failure, table(py, ran)?)?);
        }
        let outputs = PyDict::new(py);
        for column in &ran.run.recording.columns {
            outputs.set_item(&column.name, column.values.last())?;
        }
        Ok((ran.run.last.to_json().map_err(refused)?, outputs))
    }

    /// Run the model and draw a picture of it: "v over x", "spectrum of x", "orders of torque over crank.angle", or a
    /// signal over time; ", 2.." at its end leaves the first 2 s out.
    ///
    /// `others` are CSV files of other runs or measurements, drawn beside it. Gives a picture, which a notebook shows:
    /// its SVG is `svg`, and `save(path)` writes it. Raises ValueError where it cannot be drawn.
    #[pyo3(signature = (picture, scene=None, *, others=None, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, start="model", inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn plot(
        &self,
        py: Python<'_>,
        picture: &str,
        scene: Option<String>,
        others: Option<Vec<PathBuf>>,
        t_end: Option<f64>,
        step: Option<f64>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        start: &str,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Picture> {
        let mut asked = asked(scene, set, inputs, start, parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let others = others.unwrap_or_default();
        let svg = interruptible(py, |seen| {
            calls::plot(&(self.program)(), &asked, picture, &others, &|part| seen.done(part))
        })?;
        Ok(Picture { svg: svg.map_err(refused)? })
    }

    /// The bond graph of a scene, with its causal strokes: a picture, which a notebook shows.
    #[pyo3(signature = (scene=None))]
    fn graph(&self, scene: Option<&str>) -> PyResult<Picture> {
        Ok(Picture { svg: calls::graph(&(self.program)(), scene).map_err(refused)? })
    }

    /// Run the model and show all of it: the machine in motion, charts, energy balance, the bond graph.
    ///
    /// Gives a page, which a notebook shows: its HTML is `html`, and `save(path)` writes it. A run that stops before its
    /// end has a page that says so.
    #[pyo3(signature = (scene=None, *, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, start="model", inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn report(
        &self,
        py: Python<'_>,
        scene: Option<String>,
        t_end: Option<f64>,
        step: Option<f64>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        start: &str,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Page> {
        let mut asked = asked(scene, set, inputs, start, parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let html = interruptible(py, |seen| calls::page(&(self.program)(), &asked, &|part| seen.done(part)))?;
        Ok(Page { html: html.map_err(refused)? })
    }

    /// Follow natural frequencies over a parameter, "speed=0..12000": a Campbell diagram.
    ///
    /// Modes are those about the model's start, at `points` values; `start="equilibrium"` takes the machine at rest,
    /// `at` where its run is, s. Gives a dict: `modes`, a table with a row for each mode at each value,
    /// `critical_speeds`, a table of where the `orders` of a speed meet modes, and `picture`. Raises ValueError where
    /// there are none.
    #[pyo3(signature = (by, scene=None, *, points=61, orders=None, at=None, start="model", inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn campbell<'py>(
        &self,
        py: Python<'py>,
        by: &str,
        scene: Option<String>,
        points: usize,
        orders: Option<Vec<f64>>,
        at: Option<f64>,
        start: &str,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let asked = asked(scene, set, inputs, start, parameters)?;
        let found = interruptible(py, |_| {
            let program = (self.program)();
            let found = calls::campbell(&program, &asked, by, points, orders.as_deref(), at)?;
            let scene = asked.scene.clone().unwrap_or_default();
            Ok::<_, calls::Refused>((found.drawn(&scene), found))
        });
        let (drawn, found) = found?.map_err(refused)?;
        let all = PyDict::new(py);
        all.set_item("modes", with_heads(py, found.modes())?)?;
        all.set_item("critical_speeds", with_heads(py, found.critical_speeds())?)?;
        // No mode swings where one could be drawn.
        all.set_item("picture", drawn.ok().map(|svg| Bound::new(py, Picture { svg })).transpose()?)?;
        Ok(all)
    }

    /// Linearise where the run is at `at` s, or at the equilibrium near the start.
    ///
    /// Gives a dict: the matrices `a`, `b`, `c`, `d`, names with units of `states`, `inputs`, `outputs`, the `modes`
    /// and the `point`.
    #[pyo3(signature = (scene=None, *, at=None, inputs=None, set=None, **parameters))]
    fn linearize<'py>(
        &self,
        py: Python<'py>,
        scene: Option<String>,
        at: Option<f64>,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = asked(scene, set, inputs, "model", parameters)?;
        let space = interruptible(py, |_| calls::linearize(&(self.program)(), &asked, at))?.map_err(refused)?;
        let linear = py.import("json")?.call_method1("loads", (space.json(),))?;
        for (name, matrix) in [("a", &space.a), ("b", &space.b), ("c", &space.c), ("d", &space.d)] {
            linear.set_item(name, array(py, matrix)?)?;
        }
        Ok(linear)
    }

    /// Run the model and differentiate: how outputs change with parameters, exactly and through events.
    ///
    /// Gives a table with the time `t` in s and a column `d(output)/d(parameter)` for each of the `outputs` and each
    /// parameter in `by`; without them for all outputs, by all parameters of the scene. Raises ValueError where
    /// something cannot be.
    #[pyo3(signature = (scene=None, *, by=None, outputs=None, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn sensitivity(
        &self,
        py: Python<'_>,
        scene: Option<String>,
        by: Option<Vec<String>>,
        outputs: Option<Vec<String>>,
        t_end: Option<f64>,
        step: Option<f64>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Table> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let (by, outputs) = (by.unwrap_or_default(), outputs.unwrap_or_default());
        let found = interruptible(py, |_| calls::sensitivity(&(self.program)(), &asked, &by, &outputs))?;
        let (ran, courses) = found.map_err(refused)?;
        let info = about_run(py, &ran)?;
        let t = ("t".to_owned(), "s".to_owned(), Values::Real(ran.run.recording.times));
        let courses = courses.into_iter().map(|course| (course.name, course.unit, Values::Real(course.values)));
        Table::new(py, std::iter::once(t).chain(courses), info)
    }

    /// Differentiate one number of a run by all parameters at once, by the run followed backwards.
    ///
    /// The number is the output `of` at the end, or at `at` s, or with `integral` its integral over the run. Gives its
    /// value and a dict of its derivatives by the parameters in `by`, or by all of the scene: what a search by gradients
    /// asks for (`scipy.optimize.minimize(.., jac=True)`, a JAX function with `custom_vjp`). Raises ValueError where
    /// there are none.
    #[pyo3(signature = (of, scene=None, *, at=None, integral=false, by=None, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        of: String,
        scene: Option<String>,
        at: Option<f64>,
        integral: bool,
        by: Option<Vec<String>>,
        t_end: Option<f64>,
        step: Option<f64>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<(f64, Bound<'py, PyDict>)> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        if at.is_some() && integral {
            return Err(PyValueError::new_err("at and integral: an integral is over the whole run; give one of them"));
        }
        let of = Number { output: of, at, is_integral: integral };
        let by = by.unwrap_or_default();
        let found = interruptible(py, |_| calls::gradient(&(self.program)(), &asked, &of, &by))?.map_err(refused)?;
        let slopes = PyDict::new(py);
        for (name, slope) in found.by {
            slopes.set_item(name, slope)?;
        }
        Ok((found.value, slopes))
    }

    /// Fit parameters to what was measured, with what is known of them.
    ///
    /// `data` is the path of a CSV file, or columns by name: `t` in s, the others named as outputs, or as `columns` says,
    /// "name=output". `fit` are names, `bounds` narrower ranges, "k=1e3..1e5". Gives a dict: `parameters` with value and
    /// interval, `converged`, what each of the `columns` leaves. Raises ValueError where nothing can be fitted.
    #[pyo3(signature = (data, fit, scene=None, *, bounds=None, columns=None, method=None, rtol=None, inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn identify<'py>(
        &self,
        py: Python<'py>,
        data: &Bound<'py, PyAny>,
        fit: Texts,
        scene: Option<String>,
        bounds: Option<Texts>,
        columns: Option<Texts>,
        method: Option<&str>,
        rtol: Option<f64>,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, None, None, method, None, rtol, None)?;
        let all = |texts: Option<Texts>| texts.map(Texts::all).unwrap_or_default();
        let fit = Fit { data: measured(data)?, parameters: fit.all(), bounds: all(bounds), columns: all(columns) };
        let found = interruptible(py, |_| calls::identify(&(self.program)(), &asked, &fit))?.map_err(refused)?;
        py.import("json")?.call_method1("loads", (found.to_string(),))
    }

    /// Find the parameters with which a number of a run is least or largest, by exact derivatives.
    ///
    /// `minimize` and `maximize` are numbers such as "max |pin.force|", `subject` what has to be fulfilled, such as
    /// "mean(speed) > 30"; `by` are names, each with bounds where they are narrower, "length=0.5..0.9". Two goals give
    /// their front in `points`. Gives a dict: `best`, `searches` and `front`, each with `parameters`, `goals`, `subjects`,
    /// `feasible`, `converged`, `end`; `trials`, a table of all runs. Raises ValueError where nothing can be sought.
    #[pyo3(signature = (scene=None, *, minimize=None, maximize=None, subject=None, by=None, starts=1, points=9, steps=50, threads=0, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn optimize<'py>(
        &self,
        py: Python<'py>,
        scene: Option<String>,
        minimize: Option<Texts>,
        maximize: Option<Texts>,
        subject: Option<Texts>,
        by: Option<Texts>,
        starts: u32,
        points: u32,
        steps: u64,
        threads: usize,
        t_end: Option<f64>,
        step: Option<f64>,
        method: Option<&str>,
        hint: Option<PathBuf>,
        rtol: Option<f64>,
        atol: Option<f64>,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<BTreeMap<String, f64>>,
        parameters: Option<BTreeMap<String, f64>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let [minimize, maximize, subject, by] =
            [minimize, maximize, subject, by].map(|texts| texts.map_or_else(Vec::new, Texts::all));
        let goals = optimize::Asked { minimize, maximize, subject, by, starts, points, steps, threads };
        let found = interruptible(py, |seen| calls::optimize(&(self.program)(), &asked, &goals, &|| seen.goes_on()))?;
        let (sought, found) = found.map_err(refused)?;
        let told = py.import("json")?.call_method1("loads", (optimize::report::json(&sought, &found).to_string(),))?;
        told.set_item("trials", of_parquet(py, optimize::report::trials(&sought, &found), PyDict::new(py))?)?;
        Ok(told)
    }

    /// The parameters by name, each a dict of default, unit, lower and upper end of its range, doc; those of a scene,
    /// or all.
    #[pyo3(signature = (scene=None))]
    fn parameters<'py>(&self, py: Python<'py>, scene: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for info in calls::parameters(&(self.program)(), scene).map_err(refused)? {
            let one = PyDict::new(py);
            one.set_item("default", info.default)?;
            one.set_item("unit", info.unit)?;
            one.set_item("lower", info.range.lower)?;
            one.set_item("upper", info.range.upper)?;
            one.set_item("range", info.range.to_string())?;
            one.set_item("doc", info.doc.split_whitespace().collect::<Vec<_>>().join(" "))?;
            all.set_item(info.name, one)?;
        }
        Ok(all)
    }

    /// The scenes by name, with what they are.
    fn scenes(&self) -> BTreeMap<String, String> {
        calls::scenes(&(self.program)()).into_iter().collect()
    }

    /// The outputs of a scene by name, with their units.
    #[pyo3(signature = (scene=None))]
    fn outputs<'py>(&self, py: Python<'py>, scene: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        let outputs = calls::outputs(&(self.program)(), scene).map_err(refused)?;
        outputs.into_iter().try_for_each(|(name, unit)| all.set_item(name, unit))?;
        Ok(all)
    }

    /// Make the runs of a plan into the folder `out`: a path of a TOML file, or the same as a dict.
    ///
    /// What is there is not made again; `shard=(i, n)` makes the i-th of n parts, counted from 1. Gives a dict of
    /// counts: `runs` of the whole sweep, `made` and `failed` ones now, `files` made now and `found` before.
    /// `read_sweep` gives the rows.
    #[pyo3(signature = (plan, out, *, shard=(1, 1), threads=0))]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        plan: &Bound<'py, PyAny>,
        out: PathBuf,
        shard: (usize, usize),
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let none =
            || PyValueError::new_err(format!("shard {shard:?}: give (i, n), the i-th of n parts, counted from 1"));
        let share = Share::new(shard.0, shard.1).ok_or_else(none)?;
        let work = Work { plan: source(plan)?, out, share, threads };
        let outcome = interruptible(py, |seen| work.done(&(self.program)(), seen))?.map_err(refused)?;
        let counts = PyDict::new(py);
        counts.set_item("runs", outcome.runs)?;
        counts.set_item("made", outcome.made_runs)?;
        counts.set_item("failed", outcome.failed)?;
        counts.set_item("files", outcome.made)?;
        counts.set_item("found", outcome.found)?;
        Ok(counts)
    }

    /// How many shards, each some hundred runs, the sweep of a plan has.
    fn sweep_shards(&self, plan: &Bound<'_, PyAny>) -> PyResult<usize> {
        let program = (self.program)();
        let plan = source(plan)?.read(&program).map_err(refused)?;
        Ok(plan.design.runs.div_ceil(plan.shard))
    }

    /// The rows of a sweep's folder as far as it is done: one for each run, or with `trajectories` for each sample.
    #[pyo3(signature = (folder, *, trajectories=false))]
    fn read_sweep(&self, py: Python<'_>, folder: PathBuf, trajectories: bool) -> PyResult<Table> {
        let kind = if trajectories { Kind::Trajectories } else { Kind::Runs };
        let read = || -> Result<_, String> {
            let folder = Folder::open(&folder).map_err(|fault| fault.to_string())?;
            let table = shown::joined(&folder, kind).map_err(|fault| fault.to_string())?;
            Ok((table, folder.recipe().to_owned()))
        };
        let (table, recipe) = py.detach(read).map_err(PyValueError::new_err)?;
        let info = PyDict::new(py);
        info.set_item("sweep", recipe)?;
        of_parquet(py, table, info)
    }
}

/// A picture, which a notebook shows.
#[pyclass(frozen)]
pub struct Picture {
    /// The picture as SVG.
    #[pyo3(get)]
    svg: String,
}

#[pymethods]
impl Picture {
    /// What a notebook shows.
    fn _repr_svg_(&self) -> &str {
        &self.svg
    }

    /// Write it into a file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.svg)?)
    }

    fn __repr__(&self) -> String {
        format!("<Picture of {} characters; save(path) writes it>", self.svg.len())
    }
}

/// A page, which a notebook shows.
#[pyclass(frozen)]
pub struct Page {
    /// The page as HTML, in one text with all that it needs.
    #[pyo3(get)]
    html: String,
}

#[pymethods]
impl Page {
    /// What a notebook shows: the page in a frame of its own.
    fn _repr_html_(&self) -> String {
        let text = self.html.replace('&', "&amp;").replace('"', "&quot;");
        format!("<iframe srcdoc=\"{text}\" style=\"width: 100%; height: 40em; border: 0\"></iframe>")
    }

    /// Write it into a file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.html)?)
    }

    fn __repr__(&self) -> String {
        format!("<Page of {} characters; save(path) writes it>", self.html.len())
    }
}

/// A text, or several.
#[derive(FromPyObject)]
enum Texts {
    One(String),
    Several(Vec<String>),
}

impl Texts {
    fn all(self) -> Vec<String> {
        match self {
            Self::One(text) => vec![text],
            Self::Several(texts) => texts,
        }
    }
}

/// A table with the units that its metadata have.
fn of_parquet(py: Python<'_>, table: parquet::Table, info: Bound<'_, PyDict>) -> PyResult<Table> {
    let units = table.texts.iter().find(|(name, _)| name == "units").map(|(_, text)| text.as_str());
    let units: BTreeMap<String, String> = serde_json::from_str(units.unwrap_or("{}")).unwrap_or_default();
    let unit = |column: parquet::Column| {
        let unit = units.get(&column.name).cloned().unwrap_or_default();
        (column.name, unit, of_column(column.values))
    };
    Table::new(py, table.columns.into_iter().map(unit), info)
}

/// A table with the units that its heads have.
fn with_heads(py: Python<'_>, table: parquet::Table) -> PyResult<Table> {
    let columns = table.columns.into_iter().map(|parquet::Column { name, values }| {
        let (name, unit) = name_and_unit(&name);
        (name.to_owned(), unit.unwrap_or_default().to_owned(), of_column(values))
    });
    Table::new(py, columns, PyDict::new(py))
}

fn of_column(values: parquet::Values) -> Values {
    match values {
        parquet::Values::Real(values) => Values::Real(values),
        parquet::Values::Whole(values) => Values::Whole(values),
        parquet::Values::Text(values) => Values::Text(values),
    }
}

/// A plan from a path or a dict.
fn source(plan: &Bound<'_, PyAny>) -> PyResult<Source> {
    if !plan.is_instance_of::<PyDict>() {
        return Ok(Source::File(plan.extract()?));
    }
    let text: String = plan.py().import("json")?.call_method1("dumps", (plan,))?.extract()?;
    calls::toml_of_json(&text).map(Source::Text).map_err(refused)
}

/// What was measured, as the text of a CSV file: read from a path, or of columns by name.
fn measured(data: &Bound<'_, PyAny>) -> PyResult<String> {
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

/// A run that stopped before its end, with what was reached.
fn run_failed(py: Python<'_>, failure: &str, table: Table) -> PyResult<PyErr> {
    let failed = RunFailed::new_err(format!("the run failed: {failure}"));
    failed.value(py).setattr("run", table)?;
    Ok(failed)
}

/// How a run was integrated, what it cost, where it ended, what its inputs were.
fn about_run<'py>(py: Python<'py>, Ran { run, inputs, .. }: &Ran) -> PyResult<Bound<'py, PyDict>> {
    let info = PyDict::new(py);
    info.set_item("inputs", named(py, inputs)?)?;
    let statistics = &run.statistics;
    info.set_item("methods", PyList::new(py, run.methods.iter().map(|change| (change.t, change.method)))?)?;
    info.set_item("hint", run.hint().map(Integrator::name))?;
    info.set_item("rtol", run.request.rtol)?;
    info.set_item("atol", run.request.atol)?;
    info.set_item("steps", statistics.steps)?;
    info.set_item("rejected", statistics.rejected)?;
    info.set_item("rate_evaluations", statistics.rate_evaluations)?;
    info.set_item("wall_time", run.wall.as_secs_f64())?;
    info.set_item("state", run.last.to_json().map_err(refused)?)?;
    info.set_item("events", PyArray1::from_slice(py, &run.recording.events))?;
    Ok(info)
}

/// The inputs by name, each a dict as the command line writes it into a summary's JSON.
fn named<'py>(py: Python<'py>, inputs: &[Named]) -> PyResult<Bound<'py, PyDict>> {
    let loads = py.import("json")?.getattr("loads")?;
    let all = PyDict::new(py);
    for input in inputs {
        let text = serde_json::to_string(input).map_err(refused)?;
        let one = loads.call1((text,))?;
        one.del_item("name")?;
        all.set_item(input.name, one)?;
    }
    Ok(all)
}

/// A run as columns.
fn table(py: Python<'_>, ran: Ran) -> PyResult<Table> {
    let info = about_run(py, &ran)?;
    let recording = ran.run.recording;
    let columns = recording.columns.into_iter().map(|column| (column.name, column.unit, Values::Real(column.values)));
    let t = ("t".to_owned(), "s".to_owned(), Values::Real(recording.times));
    Table::new(py, std::iter::once(t).chain(columns), info)
}

/// A matrix as an array; its columns stand one after the other, as they do here.
fn array<'py>(py: Python<'py>, matrix: &DMatrix<f64>) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray1::from_slice(py, matrix.as_slice());
    let shape = [matrix.nrows(), matrix.ncols()];
    Ok(flat.reshape_with_order(shape, numpy::npyffi::NPY_ORDER::NPY_FORTRANORDER)?.into_any())
}
