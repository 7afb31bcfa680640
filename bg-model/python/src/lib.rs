//! A Python module of any mechanism: runs, linear models and sweeps, with columns as NumPy arrays.
//!
//! In a crate of the type `cdylib` one line makes the module `_pendulum`, which maturin puts into a package `pendulum`
//! ([`hacksaw/python`](../../../hacksaw/python) is an example):
//!
//! ```ignore
//! bg_python::python_module!(_pendulum, bg_workbench::Program::of::<Pendulum>);
//! ```
//!
//! | module | question |
//! |---|---|
//! | [`model`] | what the module's functions are |
//! | `asked`, `given` | what they are asked and give, in Python's words |
//! | `signal` | what an input is set to |
//! | [`shown`] | pictures and pages that they give |
//! | [`table`] | what they give: columns by name |
//! | `worded` | how sentences of the command line are said in Python |
//! | [`waiting`] | how Ctrl-C reaches what runs without Python, and how far it is |
//!
//! Numbers are moved into NumPy arrays, not copied. While a model runs, other Python threads do.

mod asked;
mod given;
pub mod model;
pub mod shown;
mod signal;
pub mod table;
pub mod waiting;
mod worded;

use bg_workbench::Program;
pub use given::refused;
use pyo3::prelude::*;
pub use worded::in_python;

#[doc(hidden)]
pub use pyo3;

/// Makes the Python module `$name` of the program that the function `$program` gives.
#[macro_export]
macro_rules! python_module {
    ($name:ident, $program:expr) => {
        /// The module.
        #[$crate::pyo3::pymodule(crate = "bg_python::pyo3")]
        fn $name(module: &$crate::pyo3::Bound<'_, $crate::pyo3::types::PyModule>) -> $crate::pyo3::PyResult<()> {
            $crate::fill(module, $program)
        }
    };
}

/// Puts the functions of a model into `module`; `program` makes its program.
///
/// # Errors
/// Python's.
pub fn fill(module: &Bound<'_, PyModule>, program: impl Fn() -> Program + Send + Sync + 'static) -> PyResult<()> {
    let model = Bound::new(module.py(), model::Model::new(program))?;
    for name in model::FUNCTIONS {
        module.add(name, model.getattr(name)?)?;
    }
    classes(module)?;
    module.add("__doc__", model.getattr("about")?)?;
    module.add("__version__", model.getattr("version")?)
}

/// Puts the classes of what a model's functions give into `module`, as classes of that module: pickle finds them there.
///
/// # Errors
/// Python's.
pub fn classes(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let classes = [py.get_type::<table::Table>(), py.get_type::<shown::Picture>(), py.get_type::<shown::Page>()];
    for class in classes.into_iter().chain([py.get_type::<given::RunFailed>()]) {
        class.setattr("__module__", module.name()?)?;
        module.add(class.name()?.to_str()?, class)?;
    }
    Ok(())
}
