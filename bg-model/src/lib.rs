//! Run time of `bond_graph!` models: the traits they implement, integrators that drive them, events, the assembly of
//! the start pose and the description of what a model consists of.
//!
//! This is the one crate that a program depends on. The macro comes from here, and its documentation is the reference
//! of the language: [`bond_graph!`](bond_graph). Generated code names this crate only, which re-exports [`nalgebra`]
//! and [`serde`] for it.
//!
//! | to | see |
//! |---|---|
//! | describe a model | [`bond_graph!`](bond_graph) |
//! | set parameters by name, from a file | [`parameters::Parameters`]; the generated struct is a serde struct |
//! | give an input, a function of time: a constant, a closure, a table | [`input::Input`], [`input::Table`] |
//! | get the start state, loops closed | [`system::Model::start`] |
//! | run it, get columns by name | [`run::Simulation`] |
//! | run it without allocations, with an observer | [`simulation::integrate`] with a method of [`integrator`], [`simulation::Settings`] |
//! | move it on by one step at a time, each at the same cost, as on a controller | [`fixed_step::FixedStep`] |
//! | end it where a condition passes through zero | [`simulation::integrate_until`] |
//! | end it from its observer | [`simulation::Observer::is_done`] |
//! | know why it ended | [`simulation::Ended`] of [`simulation::Finish`] |
//! | look at outputs, energies, powers | [`system::Model`] |
//! | drive a system whose size is not known at compile time | [`dynamics::Dynamics`], [`simulation::drive`] |
//! | look at the graph, strokes, states, equations | [`description::Description`] |
//! | know why it failed | [`failure::Failure`], with the last good state |
//! | know what it cost | [`statistics::Statistics`] |
//! | calculate in another number type | [`scalar::Scalar`] and the model's `in_scalar` |
//! | get exact derivatives by parameters and start values | [`sensitivity::sensitivities`] |
//! | get a reference solution beyond double precision | [`extended::integrate`] with [`scalar::DoubleDouble`] |
//!
//! A system that no macro has made can be run as well: implement [`system::System`].
//!
//! # Example
//!
//! A mass on a spring and a damper, released at 0.1 m, with its energy balance.
//!
//! ```
//! use bg_model::bond_graph;
//! use bg_model::integrator::{Dop853, Tolerances};
//! use bg_model::nalgebra::SVector;
//! use bg_model::simulation::{EachSample, Samples, Settings, Span, integrate};
//! use bg_model::system::{Model, switches, values};
//!
//! bond_graph! {
//!     pub graph Oscillator {
//!         param mass: kg = 2, above 0;
//!         param stiffness: N/m = 50, at least 0;
//!         param damping: N*s/m = 0.5, at least 0;
//!
//!         1 slide: translation;
//!         I body = mass; C spring = stiffness start 0.1; R damper = damping;
//!         slide -> body; slide -> spring; slide -> damper;
//!
//!         observe { x: m = spring.q; v: m/s = slide.flow; lost: J = integral(dissipated_power) }
//!     }
//! }
//!
//! let parameters = OscillatorParameters { mass: 1.0, ..OscillatorParameters::default() };
//! let model = Oscillator::new(parameters)?;
//! let start: SVector<f64, { Oscillator::STATES }> = model.start()?;
//!
//! let mut rows = Vec::new();
//! let mut observer = EachSample(|t: f64, x: &[f64], negative: &[bool]| {
//!     let (x, negative) = (values(x), switches(negative));
//!     let mut y = SVector::<f64, { Oscillator::OUTPUTS }>::zeros();
//!     model.outputs(t, x, negative, &mut y);
//!     rows.push((t, y, model.stored_energy(t, x, negative)));
//! });
//! let span = Span { t0: 0.0, t_end: 2.0 };
//! let settings = Settings {
//!     samples: Samples::Every(0.5),
//!     tolerances: Tolerances::new(1e-10, 1e-12),
//!     ..Settings::default()
//! };
//! let finish = integrate(&model, &mut Dop853::new(), &start, span, &settings, &mut observer)?;
//!
//! assert_eq!(rows.len(), 5);
//! assert_eq!(finish.statistics.events, 0);
//! let stored_at_start = 0.5 * 50.0 * 0.1 * 0.1;
//! let (t, y, stored) = rows[4];
//! assert_eq!(t, 2.0);
//! assert!((stored + y[2] - stored_at_start).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Without `std`
//!
//! With `default-features = false` and the feature `macros` the crate needs an allocator only, and lacks the modules
//! `extended`, `run` and `sensitivity`. A run has the same bits; a start that closes joints, and algebraic loops that
//! are not linear, are the same to rounding.
//!
//! # Conventions
//!
//! SI units. Power is positive along the half arrow. A guard below zero calls for the first branch of its `if`;
//! `negative[k]` says that switch `k` is in it. Steps and samples allocate nothing. Sums have a fixed order and
//! elementary functions come from `libm`, so debug and release builds give the same bytes.

#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(target_arch = "wasm32", allow(dead_code, reason = "a page follows one run at a time"))]

extern crate alloc;

#[macro_use]
mod sentence;

#[doc(hidden)]
#[path = "private.rs"]
pub mod __private;
#[cfg(all(doctest, feature = "macros"))]
mod language;
mod model;
mod solve;

#[doc(hidden)]
pub use model::tabled;
pub use model::{
    assembly, capability, clock, delay, description, drawing, dynamics, holding, input, iteration, linear, mechanism,
    parameters, requirement, sampled, scalar, series, standing, start, system,
};
#[cfg(feature = "std")]
pub use solve::{extended, run, sensitivity};
pub use solve::{failure, fixed_step, integrator, simulation, statistics};

#[cfg(feature = "macros")]
pub use bg_macros::bond_graph;
pub use nalgebra;
pub use serde;
