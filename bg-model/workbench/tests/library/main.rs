//! What a package with models of its own calls: golden outputs, linear models, sweeps in lanes and by many
//! processes, models of another maker.

mod floors;
mod golden;
mod lanes;
mod linear;
mod maker;
mod traffic;
