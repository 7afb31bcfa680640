//! The programs of the examples, which cargo builds with the tests of the package. A suite that is built alone takes
//! those built before.

use std::path::Path;
use std::process::Command;

/// The program of an example. Tests are in `deps`, examples in `examples` beside it.
pub fn program(example: &str) -> Command {
    let test = std::env::current_exe().expect("the test has a path");
    let folder = test.parent().and_then(Path::parent).expect("in `deps` of the target's folder");
    let program = folder.join("examples").join(format!("{example}{}", std::env::consts::EXE_SUFFIX));
    assert!(program.exists(), "{} is not built; run `cargo test -p bg-workbench`", program.display());
    Command::new(program)
}
