//! Code that bg-macros of another version wrote.

bg_model::__private::of_one_version! { "0.0.9" }

fn main() {}
