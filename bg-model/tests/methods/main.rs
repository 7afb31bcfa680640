//! Integrators: orders, errors, counts, stiff problems, the choice between methods.

mod accuracy;
mod ark5;
mod auto;
mod conservation;
mod explicit;
mod fixed_step;
mod implicit;
mod nystrom;
#[path = "../problems/mod.rs"]
mod problems;
mod reuse;
mod rosenbrock;
mod stiff;
mod taylor;
