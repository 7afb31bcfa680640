//! Physics: every example model against a truth that does not come from this project: closed solutions, kinematics,
//! conserved quantities, rigid equations of motion written by hand.
//!
//! Tolerances: a run at relative tolerance 1e-11 whose solution is smooth is held to 1e-9 of the quantity's size; where
//! the truth itself is an approximation (rigid joints, small angles), the test says how its error falls.

mod contact;
mod dc_motor;
mod double_pendulum;
mod drives;
mod flat_poses;
mod forty_loops;
mod free_body;
mod gearbox;
mod hacksaw_with_motor;
mod hydraulic_cylinder;
mod joints;
mod long;
mod loops;
mod mass_spring_damper;
mod mechanisms;
mod modulated;
mod nonlinear;
mod orbit;
mod orifice;
mod rlc_circuit;
mod slider_crank;
mod sources;
mod spinning_top;
mod stick_slip;
mod train;
mod truth;
