//! What mechanisms do at rigid joints and in loops, how they start, and orifices at rest.

mod all_reactions;
mod bricard;
mod closed_loops;
mod immobile;
mod loops;
mod orifice;
#[path = "../problems/mod.rs"]
mod problems;
mod redundant;
mod start;
