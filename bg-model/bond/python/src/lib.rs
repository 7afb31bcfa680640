//! Mechanisms as text in Python, without a toolchain.
//!
//! In: text in the language of `bond_graph!`, or a file that `bond` takes. Out: a model with the functions of
//! `bg-python`; or `FaultError`, which says all faults at their places.

use std::io::ErrorKind;
use std::path::PathBuf;

use bg_loaded::Fault;
use bg_python::model::Model;
use bg_python::waiting::interruptible;
use bg_python::{in_python, refused};
use bg_workbench::Program;
use bond_graph::file::{self, Text, Wanted};
use bond_graph::text::Points;
use bond_graph::{faults, maker};
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

pyo3::create_exception!(
    _bond_graph,
    FaultError,
    PyValueError,
    "Faults of a text; `faults` has each as a dict: file, line, column, code, message, help."
);

/// The model of a file: a text with graphs, a Rust file with calls of `bond_graph!`, a robot in URDF or MJCF.
#[pyfunction]
#[pyo3(signature = (path, *, graph=None, limit_statements=None, tables=None))]
fn load(
    py: Python<'_>,
    path: PathBuf,
    graph: Option<&str>,
    limit_statements: Option<usize>,
    tables: Option<&Bound<'_, PyDict>>,
) -> PyResult<Model> {
    let text = interruptible(py, move |_| file::read(&path))?.map_err(|fault| match fault {
        file::FileFault::Unreadable { ref source, .. } if source.kind() == ErrorKind::NotFound => {
            PyFileNotFoundError::new_err(fault.to_string())
        }
        file::FileFault::Unreadable { .. } => PyOSError::new_err(fault.to_string()),
        fault => refused(fault),
    })?;
    model(py, with_tables(text, tables)?, graph, limit_statements)
}

/// The model of a text. Files that it uses are sought in `folder`.
#[pyfunction]
#[pyo3(signature = (text, *, graph=None, folder=PathBuf::new(), limit_statements=None, tables=None))]
fn compile(
    py: Python<'_>,
    text: String,
    graph: Option<&str>,
    folder: PathBuf,
    limit_statements: Option<usize>,
    tables: Option<&Bound<'_, PyDict>>,
) -> PyResult<Model> {
    let text = Text { path: folder.join("<text>"), text };
    if text.is_deep() {
        return Err(PyValueError::new_err("brackets in brackets, deeper than any mechanism has them"));
    }
    model(py, with_tables(text, tables)?, graph, limit_statements)
}

/// The text where tables have other points: a file's, or rows of numbers in the units of the table.
fn with_tables(text: Text, tables: Option<&Bound<'_, PyDict>>) -> PyResult<Text> {
    let Some(tables) = tables else { return Ok(text) };
    tables.iter().try_fold(text, |text, (name, given)| {
        let name: String = name.extract()?;
        text.with_table(&name, &points(&name, &given)?).map_err(refused)
    })
}

fn points(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Points> {
    if let Ok(path) = given.extract::<PathBuf>() {
        return Ok(Points::File(path.canonicalize()?));
    }
    let row = |row: Bound<'_, PyAny>| -> PyResult<Vec<f64>> {
        row.try_iter()?.map(|value| value?.extract::<f64>()).collect()
    };
    let rows = given.try_iter().and_then(|rows| rows.map(|of| row(of?)).collect::<PyResult<Vec<_>>>());
    rows.map(Points::Rows).map_err(|_| {
        PyValueError::new_err(format!(
            "the table `{name}`: give the path of a CSV file, or rows such as [[0, 12], [100, 15]]"
        ))
    })
}

fn model(py: Python<'_>, text: Text, graph: Option<&str>, most: Option<usize>) -> PyResult<Model> {
    let wanted = Wanted { most, ..Wanted::default() };
    let read = text.clone();
    let graphs = interruptible(py, move |_| file::graphs(&read, &wanted))?
        .or_else(|faults| Err(fault_error(py, &text, &faults)?))?;
    let loaded = maker::Loaded::of(graphs, graph).map_err(refused)?;
    Ok(Model::new(move || Program::with(loaded.clone())))
}

/// All faults of a text as Python raises them.
fn fault_error(py: Python<'_>, text: &Text, all: &[Fault]) -> PyResult<PyErr> {
    let in_python = |fault: &Fault| Fault { help: in_python(&fault.help), ..fault.clone() };
    let all: Vec<Fault> = all.iter().map(in_python).collect();
    let told: Vec<String> = all.iter().map(|fault| faults::plain(text, fault)).collect();
    let raised = FaultError::new_err(format!("\n{}", told.join("\n\n")));
    let listed = PyList::empty(py);
    for fault in &all {
        let Fault { code, message, help, place: [line, column], .. } = fault;
        let one = PyDict::new(py);
        one.set_item("file", faults::place(text, fault).0.display().to_string())?;
        one.set_item("line", line)?;
        one.set_item("column", column)?;
        one.set_item("code", code)?;
        one.set_item("message", message)?;
        one.set_item("help", help)?;
        listed.append(one)?;
    }
    raised.value(py).setattr("faults", listed)?;
    Ok(raised)
}

/// The module.
#[pymodule]
fn _bond_graph(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(load, module)?)?;
    module.add_function(wrap_pyfunction!(compile, module)?)?;
    module.add_class::<Model>()?;
    bg_python::classes(module)?;
    module.add("FaultError", module.py().get_type::<FaultError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))
}
