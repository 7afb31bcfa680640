//! What mechanisms do at joints, contacts, stops, brakes and orifices, and how they start.

mod all_reactions;
mod brakes;
mod bricard;
mod friction;
mod immobile;
mod impacts;
mod loops;
mod orifice;
#[path = "../problems/mod.rs"]
mod problems;
#[path = "../random/mod.rs"]
mod random;
mod redundant;
mod start;
