//! The paper's hacksaw for other programs: its scenes `paper` and `motion` as FMI units.
//!
//!     cargo build --release --target-dir target --manifest-path hacksaw/fmu/Cargo.toml
//!     cargo run --release -- fmu --scene motion

bg_fmi::export!(hacksaw::mechanism::Paper, hacksaw::mechanism::Motion);
