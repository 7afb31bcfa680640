//! The functions of a model's module.
//!
//! In: keyword arguments. Out: tables; or `ValueError` with the sentence that the command line would say.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use bg_workbench::Program;
use bg_workbench::calls::{self, Asked, Fit, Number, Ran, Refused};
use bg_workbench::optimize;
use bg_workbench::sweep::folder::{Folder, ShardFile};
use bg_workbench::sweep::{Share, shown};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::asked::{Numbers, Question, Texts, Work, asked, integrated, measured, source};
use crate::given::{about_run, array, loaded, of_parquet, refused, run_failed, table, told, with_heads};
use crate::shown::{Page, Picture};
use crate::table::{Table, Values};
use crate::waiting::{Seen, interruptible};

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

/// A model, whose methods are the functions of its module.
#[pyclass(frozen)]
pub struct Model {
    program: Arc<dyn Fn() -> Program + Send + Sync>,
}

impl Model {
    /// Of a program, which is made for each question.
    pub fn new(program: impl Fn() -> Program + Send + Sync + 'static) -> Self {
        Self { program: Arc::new(program) }
    }

    /// Does what is asked for, as long as who waits for it says so.
    fn done<T: Send + 'static>(
        &self,
        py: Python<'_>,
        question: Question,
        work: impl FnOnce(&Program, &Asked, &Seen) -> Result<T, Refused> + Send + 'static,
    ) -> PyResult<T> {
        let (program, (asked, raised)) = (Arc::clone(&self.program), question.parts());
        let done = move |seen: &Seen| {
            let (interrupt, progress) = (seen.interrupt(), seen.progress());
            work(&program(), &Asked { interrupt, progress, ..asked }, seen)
        };
        let found = interruptible(py, done)?;
        raised.nothing()?;
        found.map_err(refused)
    }

    /// Makes a run, as far as it goes.
    fn ran(&self, py: Python<'_>, asked: Question) -> PyResult<Ran> {
        self.done(py, asked, move |program, asked, seen| calls::run(program, asked, &|part| seen.done(part)))
    }
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

    /// Run the model; parameters are keyword arguments.
    ///
    /// An input is a number, a text such as "12 kN", the path of a CSV file, a pair of arrays `(t, values)`, rows
    /// `[[t, value], ..]` joined by straight lines, or a function of t in s. That is called several times a step, not
    /// in order of time, and gives the same for the same t; what it raises ends the run and is raised.
    ///
    /// Gives a table with the time `t` in s every `step` s until `t_end` s, and all outputs of the scene. `set` takes
    /// parameters whose names are no Python names. `hint` is what `auto` begins with: a method's name, the
    /// `info["hint"]` of a run like this, which is the method that made most of it, or a `summary.json`.
    /// `info["inputs"]` has of each input its `unit`, whether it was given, and its `value` or the `table` that it
    /// follows: file, CRC-32, rows, first and last row; neither of a function. Raises ValueError where something cannot
    /// be, RunFailed where the run stops before its end.
    #[pyo3(signature = (scene=None, *, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None,
        fixed_step=None, start="model", inputs=None, set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Table> {
        let mut asked = asked(scene, set, inputs, start, parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        asked.integration.fixed_step = fixed_step.unwrap_or(asked.integration.fixed_step);
        let mut ran = self.ran(py, asked)?;
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
    #[pyo3(signature = (state=None, dt=0.01, scene=None, *, method=None, hint=None, rtol=None, atol=None,
        fixed_step=None, inputs=None, set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<(String, Bound<'py, PyDict>)> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(PyValueError::new_err(format!("dt {dt}: must be a finite number above 0")));
        }
        let mut asked = asked(scene, set, inputs, state.unwrap_or("model"), parameters)?;
        let t_end = asked.start.time() + dt;
        integrated(&mut asked, Some(t_end), Some(dt), method, hint, rtol, atol)?;
        asked.integration.fixed_step = fixed_step.unwrap_or(asked.integration.fixed_step);
        let mut ran = self.ran(py, asked)?;
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
    #[pyo3(signature = (picture, scene=None, *, others=None, t_end=None, step=None, method=None, hint=None, rtol=None,
        atol=None, start="model", inputs=None, set=None, **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn plot(
        &self,
        py: Python<'_>,
        picture: String,
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Picture> {
        let mut asked = asked(scene, set, inputs, start, parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let others = others.unwrap_or_default();
        let svg = self.done(py, asked, move |program, asked, seen| {
            calls::plot(program, asked, &picture, &others, &|part| seen.done(part))
        })?;
        Ok(Picture { svg })
    }

    /// The bond graph of a scene, with its causal strokes: a picture, which a notebook shows.
    #[pyo3(signature = (scene=None))]
    fn graph(&self, py: Python<'_>, scene: Option<String>) -> PyResult<Picture> {
        let mut asked = Question::default();
        asked.scene = scene;
        let svg = self.done(py, asked, |program, asked, _| calls::graph(program, asked.scene.as_deref()))?;
        Ok(Picture { svg })
    }

    /// Run the model and show all of it: the machine in motion, charts, energy balance, the bond graph.
    ///
    /// Gives a page, which a notebook shows: its HTML is `html`, and `save(path)` writes it. A run that stops before
    /// its end has a page that says so.
    #[pyo3(signature = (scene=None, *, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None,
        start="model", inputs=None, set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Page> {
        let mut asked = asked(scene, set, inputs, start, parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let html =
            self.done(py, asked, move |program, asked, seen| calls::page(program, asked, &|part| seen.done(part)))?;
        Ok(Page { html })
    }

    /// Follow natural frequencies over a parameter, "speed=0..12000": a Campbell diagram.
    ///
    /// Modes are those about the model's start, at `points` values; `start="equilibrium"` takes the machine at rest,
    /// `at` where its run is, s. Gives a dict: `modes`, a table with a row for each mode at each value,
    /// `critical_speeds`, a table of where the `orders` of a speed meet modes, and `picture`. Raises ValueError where
    /// there are none.
    #[pyo3(signature = (by, scene=None, *, points=61, orders=None, at=None, start="model", inputs=None, set=None,
        **parameters))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
    fn campbell<'py>(
        &self,
        py: Python<'py>,
        by: String,
        scene: Option<String>,
        points: usize,
        orders: Option<Vec<f64>>,
        at: Option<f64>,
        start: &str,
        inputs: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let asked = asked(scene, set, inputs, start, parameters)?;
        let (drawn, found) = self.done(py, asked, move |program, asked, seen| {
            let found = calls::campbell(program, asked, &by, points, orders.as_deref(), at, &|part| seen.done(part))?;
            Ok((found.drawn(asked.scene.as_deref().unwrap_or_default()), found))
        })?;
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = asked(scene, set, inputs, "model", parameters)?;
        let space = self.done(py, asked, move |program, asked, _| calls::linearize(program, asked, at))?;
        let linear = loaded(py, &space.json())?;
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
    #[pyo3(signature = (scene=None, *, by=None, outputs=None, t_end=None, step=None, method=None, hint=None, rtol=None,
        atol=None, inputs=None, set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Table> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let (by, outputs) = (by.unwrap_or_default(), outputs.unwrap_or_default());
        let (ran, courses) =
            self.done(py, asked, move |program, asked, _| calls::sensitivity(program, asked, &by, &outputs))?;
        let info = about_run(py, &ran)?;
        let t = ("t".to_owned(), "s".to_owned(), Values::Real(ran.run.recording.times));
        let courses = courses.into_iter().map(|course| (course.name, course.unit, Values::Real(course.values)));
        Table::new(py, std::iter::once(t).chain(courses), info)
    }

    /// Differentiate one number of a run by all parameters at once, by the run followed backwards.
    ///
    /// The number is the output `of` at the end, or at `at` s, or with `integral` its integral over the run. Gives its
    /// value and a dict of its derivatives by the parameters in `by`, or by all of the scene: what a search by
    /// gradients asks for (`scipy.optimize.minimize(.., jac=True)`, a JAX function with `custom_vjp`). Raises
    /// ValueError where there are none.
    #[pyo3(signature = (of, scene=None, *, at=None, integral=false, by=None, t_end=None, step=None, method=None,
        hint=None, rtol=None, atol=None, inputs=None, set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<(f64, Bound<'py, PyDict>)> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        if at.is_some() && integral {
            return Err(PyValueError::new_err("at and integral: an integral is over the whole run; give one of them"));
        }
        let of = Number { output: of, at, is_integral: integral };
        let by = by.unwrap_or_default();
        let found = self.done(py, asked, move |program, asked, _| calls::gradient(program, asked, &of, &by))?;
        let slopes = PyDict::new(py);
        for (name, slope) in found.by {
            slopes.set_item(name, slope)?;
        }
        Ok((found.value, slopes))
    }

    /// Fit parameters to what was measured, with what is known of them.
    ///
    /// `data` is the path of a CSV file, or columns by name: `t` in s, the others named as outputs, or as `columns`
    /// says, "name=output". `fit` are names, `bounds` narrower ranges, "k=1e3..1e5". Gives a dict: `parameters` with
    /// value and interval, `converged`, what each of the `columns` leaves. Raises ValueError where nothing can be
    /// fitted.
    #[pyo3(signature = (data, fit, scene=None, *, bounds=None, columns=None, method=None, rtol=None, inputs=None,
        set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, None, None, method, None, rtol, None)?;
        let all = |texts: Option<Texts>| texts.map(Texts::all).unwrap_or_default();
        let fit = Fit { data: measured(data)?, parameters: fit.all(), bounds: all(bounds), columns: all(columns) };
        let found = self.done(py, asked, move |program, asked, seen| {
            calls::identify(program, asked, &fit, &|| {
                seen.counted();
            })
        })?;
        told(py, found)
    }

    /// Find the parameters with which a number of a run is least or largest, by exact derivatives.
    ///
    /// `minimize` and `maximize` are numbers such as "max |pin.force|", `subject` what has to be fulfilled, such as
    /// "mean(speed) > 30"; `by` are names, each with bounds where they are narrower, "length=0.5..0.9". Two goals give
    /// their front in `points`. Gives a dict: `best`, `searches` and `front`, each with `parameters`, `goals`,
    /// `subjects`, `feasible`, `converged`, `end`; `trials`, a table of all runs. Raises ValueError where nothing can
    /// be sought.
    #[pyo3(signature = (scene=None, *, minimize=None, maximize=None, subject=None, by=None, starts=1, points=9,
        steps=50, threads=0, t_end=None, step=None, method=None, hint=None, rtol=None, atol=None, inputs=None,
        set=None, **parameters))]
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
        set: Option<Numbers>,
        parameters: Option<Numbers>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut asked = asked(scene, set, inputs, "model", parameters)?;
        integrated(&mut asked, t_end, step, method, hint, rtol, atol)?;
        let [minimize, maximize, subject, by] =
            [minimize, maximize, subject, by].map(|texts| texts.map_or_else(Vec::new, Texts::all));
        let goals = optimize::Asked { minimize, maximize, subject, by, starts, points, steps, threads };
        let (sought, found) = self
            .done(py, asked, move |program, asked, seen| calls::optimize(program, asked, &goals, &|| seen.counted()))?;
        let told = told(py, optimize::report::json(&sought, &found))?;
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
        let program = Arc::clone(&self.program);
        let outcome = interruptible(py, move |seen| work.done(&program(), seen))?.map_err(refused)?;
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
        let kind = if trajectories { ShardFile::Trajectories } else { ShardFile::Runs };
        let read = move |_: &Seen| -> Result<_, String> {
            let folder = Folder::open(&folder).map_err(|fault| fault.to_string())?;
            let table = shown::joined(&folder, kind).map_err(|fault| fault.to_string())?;
            Ok((table, folder.recipe().to_owned()))
        };
        let (table, recipe) = interruptible(py, read)?.map_err(refused)?;
        let info = PyDict::new(py);
        info.set_item("sweep", recipe)?;
        of_parquet(py, table, info)
    }
}
