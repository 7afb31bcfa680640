//! The paper's five-link power hacksaw: the mechanism, its run, and what is made of it.
//!
//! | module | question |
//! |---|---|
//! | [`mechanism`] | what the hacksaw is: its multibond graph, compiled |
//! | [`scenes`] | which of its models a run takes: the literal one, or one with only what a scene needs |
//! | [`agreement`] | how far a scene is from the literal model |
//! | [`report`] | what a scene consists of and what it left out |
//! | [`parameters`] | which values its parameters have in this run |
//! | [`methods`] | which integrator a run takes |
//! | [`run`](mod@run) | how it moves: integration and samples |
//! | [`trajectory`] | what was sampled, and the CSV file of it |
//! | [`checks`] | does the motion show what the paper says of it |
//! | [`precision`] | how exact a run is and what that costs |
//! | [`figures`] | what the paper's figures 4 to 19 look like |
//! | [`summary`] | what the run comes to in numbers |
//! | [`overview`] | all of it on one page |
//! | [`output`] | which files a run writes, and where |
//! | [`files`] | how results reach disk and terminal: whole, or not at all |
//! | [`command`] | what the user asks for |

pub mod agreement;
pub mod checks;
pub mod command;
pub mod figures;
pub mod files;
pub mod mechanism;
pub mod methods;
pub mod output;
pub mod overview;
pub mod parameters;
pub mod precision;
pub mod report;
pub mod run;
pub mod scenes;
pub mod summary;
pub mod trajectory;
