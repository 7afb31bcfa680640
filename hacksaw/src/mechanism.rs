//! The mechanism: the five-link power hacksaw of the paper, described in `hacksaw.bond`.
//!
//! The model types [`Hacksaw`] and those of its scenes are generated from this description, which `bond` runs as it is.
//! Another graph, of this crate or another, begins with `part hacksaw::Mechanism;`.

use bg_model::bond_graph;

bond_graph!(file "hacksaw.bond");
