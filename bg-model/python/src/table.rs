//! Columns by name, as NumPy arrays, and what is said of them.

use bg_workbench::markup::escaped;
use numpy::PyArray1;
use pyo3::exceptions::{PyImportError, PyKeyError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyList, PyType};

/// Columns of the same length by name: `table["force_x"]` is a NumPy array.
///
/// A run has the time `t` in s first, then the outputs; `info` says how it was made, with which inputs, and what it
/// took. A sweep has a row for each run.
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

/// What a table is restored from: columns, units, what else is known.
type Parts = (Py<PyDict>, Py<PyDict>, Py<PyDict>);

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

    fn rows(&self, py: Python<'_>) -> PyResult<usize> {
        self.columns.bind(py).values().iter().next().map_or(Ok(0), |values| values.len())
    }
}

#[pymethods]
impl Table {
    /// Of columns, their units and what else is known, as another table has them.
    #[new]
    fn restored(columns: Py<PyDict>, units: Py<PyDict>, info: Py<PyDict>) -> Self {
        Self { columns, units, info }
    }

    /// For pickle, and so for processes and other machines.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, Parts) {
        let (py, of) = (slf.py(), slf.get());
        (slf.get_type(), (of.columns.clone_ref(py), of.units.clone_ref(py), of.info.clone_ref(py)))
    }

    /// The columns as a stream of Arrow's C interface, by pyarrow or polars, whichever is there.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let columns = self.columns.bind(py);
        let frame = match (py.import("pyarrow"), py.import("polars")) {
            (Ok(pyarrow), _) => pyarrow.call_method1("table", (columns,))?,
            (_, Ok(polars)) => polars.call_method1("DataFrame", (columns,))?,
            (Err(_), Err(_)) => {
                return Err(PyImportError::new_err(
                    "a stream of Arrow is made by pyarrow or polars; install one of them",
                ));
            }
        };
        frame.call_method1("__arrow_c_stream__", (requested_schema,))
    }

    /// Names and values of the columns.
    fn items<'py>(&self, py: Python<'py>) -> Bound<'py, PyList> {
        self.columns.bind(py).items()
    }

    /// The values of the columns.
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyList> {
        self.columns.bind(py).values()
    }

    /// What a notebook shows: names with units, the first rows and the last ones.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        /// Rows at each end.
        const ROWS: usize = 5;
        let (columns, units) = (self.columns.bind(py), self.units.bind(py));
        let rows = self.rows(py)?;
        let shown = (0..rows).filter(|&row| row < ROWS || row + ROWS >= rows);
        let mut html = "<div style=\"overflow-x: auto\"><table><thead><tr>".to_owned();
        for name in columns.keys() {
            let (name, unit): (String, Option<Bound<'_, PyAny>>) = (name.extract()?, units.get_item(&name)?);
            let unit = unit.map(|unit| unit.extract::<String>()).transpose()?.filter(|unit| !unit.is_empty());
            let unit = unit.map_or_else(String::new, |unit| format!("<br><small>{}</small>", escaped(&unit)));
            html += &format!("<th>{}{unit}</th>", escaped(&name));
        }
        html += "</tr></thead><tbody>";
        for row in shown {
            if row + ROWS == rows && rows > 2 * ROWS {
                html += &format!("<tr><td colspan=\"{}\">\u{2026}</td></tr>", columns.len());
            }
            html += "<tr>";
            for values in columns.values() {
                let value = values.get_item(row)?;
                let text = match value.extract::<f64>() {
                    Ok(number) => format!("{}", PyFloat::new(py, number).call_method1("__format__", (".6g",))?),
                    Err(_) => value.str()?.to_string(),
                };
                html += &format!("<td>{}</td>", escaped(&text));
            }
            html += "</tr>";
        }
        html += &format!("</tbody></table></div><small>{} columns, {rows} rows</small>", columns.len());
        Ok(html)
    }

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
        Ok(format!("<Table of {} columns, {} rows>", self.columns.bind(py).len(), self.rows(py)?))
    }
}
