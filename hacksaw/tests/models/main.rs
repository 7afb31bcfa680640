//! What the models of the scenes calculate: golden outputs, their literal model, errors and counts, derivatives.

mod golden;
mod gradients;
mod precision;
mod scenes;
mod sensitivity;
