//! The compiler behind `bond_graph!`.

pub mod ast;
pub mod causality;
pub mod equations;
pub mod expr;
pub mod fault;
pub mod graph;
pub mod mechanism;
pub mod print;
pub mod syntax;
pub mod units;
