//! What is asked: values of parameters and inputs, how a run is integrated, which models there are and what each can be
//! asked.

pub mod compiled;
#[cfg(not(target_arch = "wasm32"))]
pub mod hint;
pub mod inputs;
pub mod machine;
pub mod maker;
pub mod parameters;
pub mod quantity;
pub mod reference;
pub mod request;
pub mod scenes;
pub mod table_file;
