//! What Python is given: tables, dicts, arrays, exceptions.

use std::collections::BTreeMap;

use bg_model::integrator::Integrator;
use bg_model::nalgebra::DMatrix;
use bg_workbench::calls::Ran;
use bg_workbench::files::head::name_and_unit;
use bg_workbench::files::parquet;
use bg_workbench::inputs::Named;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::table::{Table, Values};
use crate::worded::{all_in_python, in_python};

pyo3::create_exception!(
    bg_python,
    RunFailed,
    PyValueError,
    "A run that stopped before its end; `run` has what was reached."
);

/// What cannot be done, as Python raises it: a sentence, in which options of the command line become arguments.
pub fn refused(fault: impl ToString) -> PyErr {
    PyValueError::new_err(in_python(&fault.to_string()))
}

/// A value of JSON, whose sentences are in Python's words.
pub(crate) fn told<'py>(py: Python<'py>, value: serde_json::Value) -> PyResult<Bound<'py, PyAny>> {
    loaded(py, &all_in_python(value).to_string())
}

/// What stands in a text of JSON.
pub(crate) fn loaded<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// A run that stopped before its end, with what was reached.
pub(crate) fn run_failed(py: Python<'_>, failure: &str, table: Table) -> PyResult<PyErr> {
    let failed = RunFailed::new_err(in_python(&format!("the run failed: {failure}")));
    failed.value(py).setattr("run", table)?;
    Ok(failed)
}

/// How a run was integrated, what it cost, where it ended, what its inputs were.
pub(crate) fn about_run<'py>(py: Python<'py>, Ran { run, inputs, .. }: &Ran) -> PyResult<Bound<'py, PyDict>> {
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
    let all = PyDict::new(py);
    for input in inputs {
        let one = loaded(py, &serde_json::to_string(input).map_err(refused)?)?;
        one.del_item("name")?;
        all.set_item(input.name, one)?;
    }
    Ok(all)
}

/// A run as columns.
pub(crate) fn table(py: Python<'_>, ran: Ran) -> PyResult<Table> {
    let info = about_run(py, &ran)?;
    let recording = ran.run.recording;
    let columns = recording.columns.into_iter().map(|column| (column.name, column.unit, Values::Real(column.values)));
    let t = ("t".to_owned(), "s".to_owned(), Values::Real(recording.times));
    Table::new(py, std::iter::once(t).chain(columns), info)
}

/// A matrix as an array; its columns stand one after the other, as they do here.
pub(crate) fn array<'py>(py: Python<'py>, matrix: &DMatrix<f64>) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray1::from_slice(py, matrix.as_slice());
    let shape = [matrix.nrows(), matrix.ncols()];
    Ok(flat.reshape_with_order(shape, numpy::npyffi::NPY_ORDER::NPY_FORTRANORDER)?.into_any())
}

/// A table with the units that its metadata have.
pub(crate) fn of_parquet(py: Python<'_>, table: parquet::Table, info: Bound<'_, PyDict>) -> PyResult<Table> {
    let units = table.texts.iter().find(|(name, _)| name == "units").map(|(_, text)| text.as_str());
    let units: BTreeMap<String, String> = serde_json::from_str(units.unwrap_or("{}")).unwrap_or_default();
    let unit = |column: parquet::Column| {
        let unit = units.get(&column.name).cloned().unwrap_or_default();
        (column.name, unit, of_column(column.values))
    };
    Table::new(py, table.columns.into_iter().map(unit), info)
}

/// A table with the units that its heads have.
pub(crate) fn with_heads(py: Python<'_>, table: parquet::Table) -> PyResult<Table> {
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
