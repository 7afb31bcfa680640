//! Columns by name, as NumPy arrays, and what is said of them.

use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Columns of the same length by name: `table["force_x"]` is a NumPy array.
///
/// A run has the time `t` in s first, then the outputs; `info` says how it was made, with which inputs, and what it took.
/// A sweep has a row for each run.
#[pyclass(frozen, mapping, name = "Table")]
pub struct Table {
    columns: Py<PyDict>,
    /// Units by column; empty where there is none.
    #[pyo3(get)]
    units: Py<PyDict>,
    /// What else is known, by name.
    #[pyo3(get)]
    info: Py<PyDict>,
}

/// Values of a column that become an array, or a list of texts.
pub enum Values {
    /// Real numbers.
    Real(Vec<f64>),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Texts.
    Text(Vec<String>),
}

impl Table {
    /// Of columns with their names and units. Their values are moved, not copied.
    ///
    /// # Errors
    /// Python's.
    pub fn new(
        py: Python<'_>,
        columns: impl IntoIterator<Item = (String, String, Values)>,
        info: Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let (named, units) = (PyDict::new(py), PyDict::new(py));
        for (name, unit, values) in columns {
            match values {
                Values::Real(values) => named.set_item(&name, PyArray1::from_vec(py, values))?,
                Values::Whole(values) => named.set_item(&name, PyArray1::from_vec(py, values))?,
                Values::Text(values) => named.set_item(&name, PyList::new(py, values)?)?,
            }
            units.set_item(name, unit)?;
        }
        Ok(Self { columns: named.unbind(), units: units.unbind(), info: info.unbind() })
    }
}

#[pymethods]
impl Table {
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let columns = self.columns.bind(py);
        columns.get_item(name)?.ok_or_else(|| {
            let known: Vec<String> = columns.keys().iter().map(|name| name.to_string()).collect();
            PyKeyError::new_err(format!("there is no column `{name}`; there are {}", known.join(", ")))
        })
    }

    fn __contains__(&self, py: Python<'_>, name: &str) -> PyResult<bool> {
        self.columns.bind(py).contains(name)
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        self.columns.bind(py).len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.columns.bind(py).try_iter()?.into_any())
    }

    /// The names of the columns.
    fn keys<'py>(&self, py: Python<'py>) -> Bound<'py, PyList> {
        self.columns.bind(py).keys()
    }

    /// The columns as a pandas frame, with the time as its index where there is one.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let options = PyDict::new(py);
        options.set_item("copy", false)?;
        let frame = py.import("pandas")?.call_method("DataFrame", (self.columns.bind(py),), Some(&options))?;
        if self.columns.bind(py).contains("t")? { frame.call_method1("set_index", ("t",)) } else { Ok(frame) }
    }

    /// The columns as a polars frame.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("polars")?.call_method1("DataFrame", (self.columns.bind(py),))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let columns = self.columns.bind(py);
        let rows = columns.values().iter().next().map_or(Ok(0), |values| values.len())?;
        Ok(format!("<Table of {} columns, {rows} rows>", columns.len()))
    }
}
