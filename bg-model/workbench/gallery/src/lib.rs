//! The examples of the workbench, as their head comments tell of them.

pub mod example;
