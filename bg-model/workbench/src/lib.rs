//! A program for every model of `bond_graph!`.
