//! The module in Python: runs the tests beside this file by pytest, where Python with NumPy and pytest is there.
//!
//! `PYTHON` may name the interpreter; else it is `python3`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Its own tests are run here: `bg-python` alone cannot be linked with Python's functions.
#[path = "../../../python/src/worded.rs"]
#[allow(dead_code)]
mod worded;

/// The interpreter, if it has what the tests need.
fn python() -> Option<PathBuf> {
    let python = PathBuf::from(std::env::var_os("PYTHON").unwrap_or_else(|| "python3".into()));
    let found = Command::new(&python).args(["-c", "import numpy, pytest"]).output();
    found.is_ok_and(|output| output.status.success()).then_some(python)
}

/// A folder with the package as a wheel would install it.
fn installed() -> tempfile::TempDir {
    let test = std::env::current_exe().expect("the test has a path");
    let built = test.parent().expect("in `deps` of the target's folder");
    let library = |name: &str| format!("{}{name}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let end = if cfg!(windows) { "pyd" } else { "abi3.so" };
    let (folder, here) = (tempfile::tempdir().expect("a folder"), Path::new(env!("CARGO_MANIFEST_DIR")));
    let package = folder.path().join("bond_graph");
    std::fs::create_dir(&package).expect("a folder");
    for file in std::fs::read_dir(here.join("python/bond_graph")).expect("the package") {
        let path = file.expect("a file").path();
        if path.is_file() {
            std::fs::copy(&path, package.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
    std::fs::copy(built.join(library("_bond_graph")), package.join(format!("_bond_graph.{end}")))
        .expect("cargo built the library");
    folder
}

#[test]
fn what_python_sees() {
    let Some(python) = python() else {
        println!("skipped: no Python with numpy and pytest; PYTHON names one");
        return;
    };
    let folder = installed();
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut command = Command::new(python);
    command.args(["-m", "pytest", "-q", "-p", "no:cacheprovider"]).arg(tests).current_dir(&folder);
    command.env("PYTHONPATH", folder.path()).env("PYTHONDONTWRITEBYTECODE", "1");
    assert!(command.status().expect("Python runs").success(), "pytest failed");
}
