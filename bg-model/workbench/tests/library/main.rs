//! What a package with models of its own calls: golden outputs, linear models, sweeps in lanes.

mod golden;
mod lanes;
mod linear;
