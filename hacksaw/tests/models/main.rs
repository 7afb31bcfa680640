//! What the models of the scenes calculate: golden outputs, their literal model, errors and counts, derivatives; and
//! what the program says and draws of a run.

mod checks;
mod figures;
mod golden;
mod gradients;
mod names;
mod precision;
mod references;
mod scenes;
mod sensitivity;
mod summary;
