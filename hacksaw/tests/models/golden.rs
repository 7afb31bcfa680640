//! The runs recorded in `hacksaw/golden` are reproduced: `cargo run --release -- golden check --out hacksaw/golden`.

use bg_workbench::golden::GoldenError;
use hacksaw::mechanism::Hacksaw;

#[test]
fn golden() -> Result<(), GoldenError> {
    bg_workbench::golden::check::<Hacksaw>(concat!(env!("CARGO_MANIFEST_DIR"), "/golden"))
}
