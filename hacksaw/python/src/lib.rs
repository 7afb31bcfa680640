//! The paper's power hacksaw as a Python module.

bg_python::python_module!(_hacksaw, hacksaw::command::program);
