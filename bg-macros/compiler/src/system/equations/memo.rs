//! What has been calculated of bonds and lets.
//!
//! In: values as they are found. Out: the same, so that each is calculated once.

use crate::graph::BondGraph;
use crate::system::Value;

/// A memo of bond variables and lets.
#[derive(Clone, Debug)]
pub(super) struct Memo {
    pub(super) efforts: Vec<Entry>,
    pub(super) flows: Vec<Entry>,
    pub(super) lets: Vec<Option<Value>>,
}

/// A bond variable's state in the memo.
#[derive(Clone, Debug)]
pub(super) enum Entry {
    Open,
    /// Being calculated, with the symbols that stand for it where it needs itself.
    Entered(Option<Value>),
    Done(Value),
}

impl Memo {
    pub(super) fn new(graph: &BondGraph) -> Self {
        let open = vec![Entry::Open; graph.bonds.len()];
        Self { efforts: open.clone(), flows: open, lets: vec![None; graph.lets.len()] }
    }
}
