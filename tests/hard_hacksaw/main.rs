//! The hacksaw made hard, in short: what its integrators reach, and that nothing is wrong without an error.
//!
//! The cases and what they are held against are in `cases`. `cargo bench -p bond-graph-tests --bench stability --
//! --only hacksaw` runs all of it at full length and at four tolerances.

mod extremes;
mod run;
mod verdicts;

fn snapshot(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}
