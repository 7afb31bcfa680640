//! Long straight-line code in blocks.
//!
//! In: the assignments of a long routine in groups. Out: for each group the code that stands before and behind its `let`s. What a
//! block hands to later ones, or as a result, is in the array `v`; all else are its own `let`s. Each `let` is a scope inside the
//! one before, and LLVM's stack overflows over some thousands of them; places of an array take rustc's check ten times as long as
//! `let`s.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::TokenStream;
use quote::quote;

use super::routine::{self, Names, operand};
use crate::program::{Assignment, Operand};

/// Assignments of a block.
pub(super) const BLOCK: usize = 1000;

/// What blocks hand on.
pub(super) struct Blocks {
    /// The places in the array of the temporaries that are handed on; those of one group stand side by side.
    places: BTreeMap<u32, usize>,
}

impl Blocks {
    /// The blocks of these groups, in their order.
    pub(super) fn of<'a>(groups: impl Iterator<Item = &'a [Assignment]> + Clone, results: &[Operand]) -> Self {
        let results = results.iter().filter_map(temporary);
        let read = groups.clone().flat_map(read_from_others);
        let handed: BTreeSet<u32> = results.chain(read).collect();
        let targets = groups.flatten().map(|assignment| assignment.target).filter(|target| handed.contains(target));
        Self { places: targets.zip(0..).collect() }
    }

    /// The array.
    pub(super) fn array(&self) -> TokenStream {
        let count = self.places.len();
        quote!(let v = &mut [S::from_f64(0.0); #count];)
    }

    /// The array's type.
    pub(super) fn array_type(&self) -> TokenStream {
        let count = self.places.len();
        quote!([S; #count])
    }

    /// The `definitions` of a group's temporaries between what they read from `v` and what they hand on in it.
    pub(super) fn block(&self, group: &[Assignment], definitions: &str, names: &Names) -> String {
        let reads: String = read_from_others(group)
            .into_iter()
            .map(|temporary| routine::definition(temporary, &self.place(temporary)))
            .collect();
        let written: Vec<u32> = group
            .iter()
            .map(|assignment| assignment.target)
            .filter(|target| self.places.contains_key(target))
            .collect();
        let writes = written.first().map(|first| {
            let values: Vec<String> =
                written.iter().map(|&temporary| operand(&Operand::Temporary(temporary), names)).collect();
            format!("::bg_model::__private::store(v, {}, [{}]);", self.places[first], values.join(", "))
        });
        reads + definitions + &writes.unwrap_or_default()
    }

    /// A result of the routine, behind its blocks.
    pub(super) fn result(&self, result: &Operand, names: &Names) -> String {
        temporary(result).map_or_else(|| operand(result, names), |temporary| self.place(temporary))
    }

    fn place(&self, temporary: u32) -> String {
        format!("v[{}]", self.places[&temporary])
    }
}

fn temporary(operand: &Operand) -> Option<u32> {
    if let Operand::Temporary(temporary) = operand { Some(*temporary) } else { None }
}

/// The temporaries of other groups that the assignments of a group read.
fn read_from_others(group: &[Assignment]) -> BTreeSet<u32> {
    let own: BTreeSet<u32> = group.iter().map(|assignment| assignment.target).collect();
    let read = group.iter().flat_map(|assignment| assignment.operation.operands());
    read.filter_map(|operand| temporary(&operand)).filter(|read| !own.contains(read)).collect()
}
