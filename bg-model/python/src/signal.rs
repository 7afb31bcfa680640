//! What Python gives for an input: a number, a text, a table, a function of time.
//!
//! In: an object. Out: what the workbench takes. A function is called where the run is made, with Python's lock; what
//! it raises is remembered and ends the run, since it has no value there.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bg_workbench::inputs::{Function, Setting};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// What a function has raised first.
#[derive(Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    fn locked(&self) -> MutexGuard<'_, Option<PyErr>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// That it has raised nothing.
    ///
    /// # Errors
    /// What it has raised.
    pub fn nothing(&self) -> PyResult<()> {
        self.locked().take().map_or(Ok(()), Err)
    }

    /// The value of `function` at `t` (s); none that is a number once it has raised something.
    fn value(&self, function: &Py<PyAny>, t: f64) -> f64 {
        if self.locked().is_some() {
            return f64::NAN;
        }
        let value = Python::attach(|py| function.bind(py).call1((t,))?.extract());
        value.unwrap_or_else(|raised| {
            self.locked().get_or_insert(raised);
            f64::NAN
        })
    }
}

/// What an input is set to.
pub(crate) enum Signal {
    /// To what a text says: a number, with a unit or without, or the name of a CSV file.
    Text(String),
    /// To the rows of a table, or a function.
    Setting(Setting),
}

/// What the input called `name` is set to by `value`.
pub(crate) fn input(name: &str, value: &Bound<'_, PyAny>, raised: &Raised) -> PyResult<Signal> {
    if value.is_callable() {
        let (function, raised) = (value.clone().unbind(), raised.clone());
        return Ok(Signal::Setting(Setting::Function(Function::new(move |t| raised.value(&function, t)))));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Signal::Text(format!("{number:?}")));
    }
    if let Ok(path) = value.extract::<PathBuf>() {
        return Ok(Signal::Text(path.display().to_string()));
    }
    let (times, values) = columns(value).map_err(|_| {
        PyValueError::new_err(format!(
            "inputs: `{name}`: give a number, a text such as \"12 kN\" or \"{name}.csv\", a pair of arrays (t, \
             values), rows such as [[0, 0], [1, 5]], or a function of t"
        ))
    })?;
    Ok(Signal::Setting(Setting::Table { times, values, cubic: false, source: None }))
}

/// The times and the values of a table: of a tuple of both, or of rows.
fn columns(value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<f64>)> {
    if value.is_instance_of::<PyTuple>() {
        if let Ok((times, values)) = value.extract::<(Vec<f64>, Vec<f64>)>()
            && times.len() == values.len()
        {
            return Ok((times, values));
        }
        return Err(PyValueError::new_err("no pair of columns"));
    }
    let row = |row: PyResult<Bound<'_, PyAny>>| -> PyResult<(f64, f64)> {
        let [t, value] = row?.extract::<[f64; 2]>()?;
        Ok((t, value))
    };
    value.try_iter()?.map(row).collect()
}
