//! Random linear bond graphs, and what they must give by means that have nothing of the compiler: all assignments of
//! strokes, and the dense system of all junction and element equations.

pub mod compare;
pub mod draw;
pub mod network;
pub mod solution;
pub mod strokes;
