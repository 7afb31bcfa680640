//! Models of `bond_graph!` text that run without rustc: the text is compiled by the compiler of the macro, its programs
//! are interpreted.
//!
//! In: text in the language of the macro, with the files that it uses. Out: [`Graph`]s, of whose models [`Interpreted`]
//! makes machines for [`bg_model::run::Simulation::over`]. They have the bits of generated code.

mod blueprint;
mod bundle;
mod code;
mod interpreted;
mod machine;
mod series;
mod statics;
mod swept;
mod text;

pub use bg_compiler::source::syntax::files::{Open, Opened};
pub use bg_compiler::source::syntax::points::with_points;
pub use bg_compiler::source::syntax::told::Told;
pub use bg_compiler::source::{functions, vocabulary};
pub use blueprint::Blueprint;
pub use bundle::{Bundle, Chosen};
pub use code::BackEnd;
pub use interpreted::Interpreted;
pub use text::{
    Counted, Fault, Graph, Model, UsedFile, Wanted, check_file, load, load_file, load_wanted, macro_calls,
    on_a_large_stack, syntax_faults, told,
};
