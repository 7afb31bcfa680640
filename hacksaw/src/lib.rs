//! The paper's five-link power hacksaw: the mechanism, its run, and what is made of it.
//!
//! | module | question |
//! |---|---|
//! | [`mechanism`] | what the hacksaw is: its multibond graph, compiled |
//! | [`parameters`] | which values its parameters have in this run |
//! | [`run`](mod@run) | how it moves: integration and samples |
//! | [`trajectory`] | what was sampled, and the CSV file of it |
//! | [`checks`] | does the motion show what the paper says of it |
//! | [`figures`] | what the paper's figures 4 to 19 look like |
//! | [`summary`] | what the run comes to in numbers |
//! | [`overview`] | all of it on one page |
//! | [`output`] | where the files go |
//! | [`command`] | what the user asks for |

pub mod checks;
pub mod command;
pub mod figures;
pub mod mechanism;
pub mod output;
pub mod overview;
pub mod parameters;
pub mod run;
pub mod summary;
pub mod trajectory;
