//! What mechanisms do at rigid joints and in loops, how they start and turn, and orifices at rest.

mod all_reactions;
mod angles;
mod ball_balancer;
mod ball_on_plate;
mod bricard;
mod closed_loops;
mod controllers;
mod delays;
mod double_wishbone;
mod governor;
mod hand;
mod immobile;
mod library;
mod loops;
mod loops_in_space;
mod orifice;
#[path = "../problems/mod.rs"]
mod problems;
mod redundant;
mod samples;
mod shapes;
mod space;
mod spatial_slider_crank;
mod start;
mod stewart_platform;
mod tables;
mod tasks;
mod text;
mod walls;
