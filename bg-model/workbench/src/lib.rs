//! A program for every model of `bond_graph!`: command line, trajectories, figures, golden outputs, linearisation.
//!
//! ```no_run
//! use bg_model::bond_graph;
//!
//! bond_graph! {
//!     /// A steel rod that swings about a pin.
//!     pub graph Pendulum {
//!         /// Angle at the start, from the horizontal.
//!         param angle: rad = 0.5;
//!         /// Length of the rod.
//!         param length: m = 0.6, above 0;
//!
//!         gravity [0, -9.81, 0];
//!         ground { point pivot = [0, 1, 0]; }
//!
//!         body rod {
//!             cuboid [length, 0.03, 0.03] density 7850;
//!             point end = [-length / 2, 0, 0];
//!             start end at [0, 1, 0];
//!             start turned rotation_z(angle);
//!         }
//!
//!         joint pin: revolute z (ground.pivot -> rod.end) {
//!             stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1;
//!         }
//!
//!         observe {
//!             angle: rad = rod.angle;
//!             force_x: N = pin.force.x;
//!             force_y: N = pin.force.y;
//!             stored: J = stored_energy;
//!             lost: J = integral(dissipated_power);
//!         }
//!     }
//! }
//!
//! fn main() -> std::process::ExitCode {
//!     bg_workbench::main::<Pendulum>()
//! }
//! ```
//!
//! | module | question |
//! |---|---|
//! | [`program`] | how a program is made of the models of a graph |
//! | [`maker`] | what makes these, compiled or not |
//! | [`compiled`] | the models of a mechanism that `bond_graph!` made |
//! | [`machine`] | what one of them is asked, whatever its type |
//! | [`extras`] | what it adds: figures, lines, checks |
//! | [`command`] | what the user asks for |
//! | [`calls`] | the same for another program: runs and linear models as values |
//! | [`scenes`] | which models there are, by name |
//! | [`parameters`] | which values the parameters have in this run |
//! | [`inputs`] | which inputs: numbers, or tables from files |
//! | [`request`] | how it is integrated |
//! | [`tables`] | what a scene consists of and what it left out |
//! | [`picture`] | what its graph looks like |
//! | [`samples`] | which samples a CSV file has |
//! | [`compare`] | how far two runs are apart |
//! | [`golden`] | whether a recorded run is reproduced |
//! | [`precision`] | how exact a run is and what that costs |
//! | [`figures`] | what the outputs look like |
//! | [`linear`] | where the mechanism is in equilibrium, and how it moves near a state |
//! | [`sensitivity`] | which parameter moves which output |
//! | [`gradient`] | how one number of a run depends on all parameters |
//! | [`identify`] | which parameters come nearest to what was measured |
//! | [`optimize`] | which parameters make a number of a run least |
//! | [`recipe`] | what a run was made with, so that it can be made again |
//! | [`summary`] | what a run results in, in numbers |
//! | [`page`] | all of it on one page that needs nothing else, in motion where there is a machine |
//! | [`live`] | the same with the model inside, so that the page can run it again |
//! | [`markup`] | texts as HTML |
//! | [`shown`] | which page shows a run, and with which files |
//! | [`sweep`] | what many runs with many values give |
//! | [`output`] | which files a run writes, and where |
//! | [`files`] | how results reach disk and terminal: whole, or not at all |
//! | [`cookbook`] | short programs for what follows the first run |

// In a page a program answers orders, see `live`: what that has no use for is not built there.
#![cfg_attr(
    target_arch = "wasm32",
    allow(dead_code, reason = "what is shared is also for reports, which a page does not write")
)]

mod ask;
#[cfg(not(target_arch = "wasm32"))]
pub mod command;
#[cfg(not(target_arch = "wasm32"))]
pub mod files;
pub mod live;
pub mod program;
mod run;
mod show;
mod studies;

#[cfg(not(target_arch = "wasm32"))]
pub use ask::hint;
pub use ask::{compiled, inputs, machine, maker, parameters, request, scenes, table_file};
pub use bg_analysis::linear;
#[cfg(not(target_arch = "wasm32"))]
pub use command::calls;
#[cfg(not(target_arch = "wasm32"))]
pub use run::{compare, samples};
pub use run::{recipe, summary};
pub use show::{extras, figures, markup, page, picture};
#[cfg(not(target_arch = "wasm32"))]
pub use show::{output, shown, tables};
pub use studies::precision;
#[cfg(not(target_arch = "wasm32"))]
pub use studies::{golden, gradient, identify, optimize, sensitivity, sweep};

#[doc = include_str!("../cookbook.md")]
pub mod cookbook {}

use std::process::ExitCode;

use bg_model::mechanism::Scenes;

pub use bg_model;
pub use compiled::Compiled;
pub use program::Program;

/// Does what the program's arguments ask for of the mechanism `Me`, and gives the exit code: 0 done, 1 the run or an
/// output failed, 2 the input cannot be used. In WebAssembly it answers a page from then on, see [`live`].
#[must_use]
pub fn main<Me: Scenes>() -> ExitCode {
    Program::of::<Me>().main(std::env::args_os())
}
