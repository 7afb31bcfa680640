//! The runs recorded in `hacksaw/golden` are reproduced: `cargo run --release -- golden check --out hacksaw/golden`.

use bg_workbench::golden::{GoldenError, check_of};
use hacksaw::command::program;

#[test]
fn golden() -> Result<(), GoldenError> {
    check_of(&program(), concat!(env!("CARGO_MANIFEST_DIR"), "/golden"))
}
