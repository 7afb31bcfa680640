//! Models in the macro language, one file each. The suite `physics` tests every one against an independent truth; the
//! suite `laws` tests what holds for all of them.

pub mod contact;
pub mod dc_motor;
pub mod double_pendulum;
pub mod drives;
pub mod free_body;
pub mod hacksaw_with_motor;
pub mod hydraulic_cylinder;
pub mod joints;
pub mod mass_spring_damper;
pub mod modulated;
pub mod nonlinear;
pub mod orbit;
pub mod permuted;
pub mod rlc_circuit;
pub mod slider_crank;
pub mod sources;
pub mod spinning_top;
