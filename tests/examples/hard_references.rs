//! Makes the references of the hacksaw's hard cases anew: `tests/hard_hacksaw/cases/references.csv`.
//!
//! `cargo run --release -p bond-graph-tests --example hard_references`

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("hard_hacksaw/cases/references.csv");
    let text = bond_graph_tests::hard_hacksaw::references::make(|name| eprintln!("{name}"))?;
    std::fs::write(path, text)?;
    Ok(())
}
