//! Hard cases: what every integrator makes of published problems on which integrators break.
//!
//! The cases and what they are held against are in `cases`. Three things are held: the integrators made for a case
//! reach its reference; no integrator gives a wrong answer without an error, but for the exceptions named here; the
//! work of the default and of one fitting integrator is exactly what it was. `cargo bench -p bond-graph-tests --bench
//! stability` prints all of it at four tolerances.

mod andrews;
mod compliance;
mod orders;
mod verdicts;
mod work;
