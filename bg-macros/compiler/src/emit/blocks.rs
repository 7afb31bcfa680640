//! Long straight-line code in blocks.
//!
//! In: the assignments of a long routine. Out: groups of them, of which those that repeat themselves are loops, and each group as it is written.
//! What a group hands to others, or as a result, is in the array `v`; all else are its own `let`s. Each `let` is a scope inside the one
//! before, and LLVM's stack overflows over some thousands of them; places of an array take rustc's check ten times as long as `let`s.
//!
//! An iteration reads windows: places of an array side by side, of which a table has the first one. So bounds are checked once for a
//! window, and what stands in it has no place to calculate.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::slice::Chunks;

use proc_macro2::TokenStream;
use quote::quote;

use super::routine::{self, Names, operand, temporary};
use crate::program::repetition::{self, Array, Input, Piece};
use crate::program::{Assignment, Operand};

/// Assignments of a block.
const BLOCK: usize = 1000;

/// Assignments that stand together.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    assignments: &'a [Assignment],
    /// How many of them an iteration has; all where they are no loop.
    period: usize,
}

impl<'a> Group<'a> {
    /// The groups of assignments, none of them a loop.
    pub(super) fn straight(assignments: &'a [Assignment]) -> impl Iterator<Item = Self> {
        assignments.chunks(BLOCK).map(|assignments| Self { assignments, period: assignments.len() })
    }

    /// The groups of assignments, with loops where they repeat themselves. Operands of which one is of a kind and the other is not do not
    /// stand at the same place of an iteration.
    pub(super) fn of(assignments: &'a [Assignment], kind: &dyn Fn(&Operand) -> bool) -> Vec<Self> {
        let (mut groups, mut from) = (Vec::new(), 0);
        for repetition::Run { start, period, count } in repetition::runs(assignments, kind) {
            groups.extend(Self::straight(&assignments[from..start]));
            from = start + period * count;
            groups.push(Self { assignments: &assignments[start..from], period });
        }
        groups.extend(Self::straight(&assignments[from..]));
        groups
    }

    fn iterations(&self) -> Chunks<'a, Assignment> {
        self.assignments.chunks(self.period)
    }
}

/// What groups hand on.
pub(super) struct Blocks {
    /// The places in the array of the temporaries that are handed on; those of one iteration stand side by side.
    places: BTreeMap<u32, usize>,
}

/// A group as it is written.
#[derive(Default)]
pub(super) struct Part<'a> {
    /// Its assignments; of a loop those that all iterations have in common.
    pub(super) assignments: Cow<'a, [Assignment]>,
    /// What the temporaries of a loop are in its first iteration: the targets, then what it reads. Of no loop: nothing.
    pub(super) first: Vec<Operand>,
    /// What the iterations of a loop read from its table.
    columns: Vec<Vec<usize>>,
    /// The code that reads what others hand on.
    reads: String,
    /// The code that hands on what others read.
    writes: String,
}

impl Blocks {
    /// What these groups, in their order, hand on, and as results.
    pub(super) fn of(groups: &[Group], results: &[Operand]) -> Self {
        let read = groups.iter().flat_map(Group::iterations).flat_map(read_from_others);
        let handed: BTreeSet<u32> = results.iter().filter_map(as_temporary).chain(read).collect();
        let mut places = BTreeMap::new();
        for group in groups {
            // What one iteration hands on has a place in all of them.
            let is_handed = |at: &usize| group.iterations().any(|iteration| handed.contains(&iteration[*at].target));
            let positions: Vec<usize> = (0..group.period).filter(is_handed).collect();
            for iteration in group.iterations() {
                for &at in &positions {
                    places.insert(iteration[at].target, places.len());
                }
            }
        }
        Self { places }
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

    /// A group as it is written.
    pub(super) fn part<'a>(&self, group: &Group<'a>) -> Part<'a> {
        if group.period == group.assignments.len() { self.straight(group.assignments) } else { self.repeated(group) }
    }

    fn straight<'a>(&self, assignments: &'a [Assignment]) -> Part<'a> {
        let reads = read_from_others(assignments)
            .into_iter()
            .map(|temporary| routine::definition(temporary, &self.place(temporary)))
            .collect();
        let first = self.handed(assignments).next();
        let writes = first.map(|first| store("v", &self.places[&first].to_string(), self.handed(assignments).map(temporary)));
        Part { assignments: assignments.into(), reads, writes: writes.unwrap_or_default(), ..Part::default() }
    }

    fn repeated<'a>(&self, group: &Group<'a>) -> Part<'a> {
        let Piece { assignments, inputs } = repetition::piece(group.assignments, group.period);
        let targets = group.assignments[..group.period].iter().map(|assignment| assignment.target);
        let read = inputs.iter().map(|input| input.array.operand(input.entries[0]));
        let first = targets.clone().map(Operand::Temporary).chain(read).collect();
        let mut part = Part { assignments: assignments.into(), first, ..Part::default() };
        for window in Window::of(self, &inputs, group.period) {
            let at = part.column(window.begins());
            part.reads += &window.definition(&at);
        }
        let handed = (0..).zip(targets).filter(|(_, target)| self.places.contains_key(target));
        let handed: Vec<u32> = handed.map(|(index, _)| index).collect();
        let begins = group.iterations().filter_map(|iteration| self.handed(iteration).next());
        let at = part.column(begins.map(|temporary| self.places[&temporary]).collect());
        part.writes = store("v", &at, handed.into_iter().map(temporary));
        part
    }

    /// The temporaries of these that are handed on.
    fn handed(&self, assignments: &[Assignment]) -> impl Iterator<Item = u32> {
        let targets = assignments.iter().map(|assignment| assignment.target);
        targets.filter(|target| self.places.contains_key(target))
    }

    /// A result of the routine, behind its blocks.
    pub(super) fn result(&self, result: &Operand, names: &Names) -> String {
        as_temporary(result).map_or_else(|| operand(result, names), |temporary| self.place(temporary))
    }

    fn place(&self, temporary: u32) -> String {
        format!("v[{}]", self.places[&temporary])
    }
}

impl Part<'_> {
    /// The column of the table with what each iteration reads.
    pub(super) fn column(&mut self, of_iterations: Vec<usize>) -> String {
        self.columns.push(of_iterations);
        column(self.columns.len() - 1)
    }

    /// How many iterations it has, if it is a loop.
    pub(super) fn iterations(&self) -> Option<usize> {
        self.columns.first().map(Vec::len)
    }

    /// Its code with the definitions of its assignments.
    pub(super) fn code(&self, definitions: &str) -> String {
        let Self { reads, writes, columns, .. } = self;
        let body = format!("{reads}{definitions}{writes}");
        let Some(iterations) = self.iterations() else { return body };
        let rows = (0..iterations).map(|iteration| format!("{:?}", columns.iter().map(|column| column[iteration]).collect::<Vec<_>>()));
        let (rows, names) = (rows.collect::<Vec<_>>().join(", "), (0..columns.len()).map(column).collect::<Vec<_>>().join(", "));
        let width = columns.len();
        format!("static TABLE: [[usize; {width}]; {iterations}] = [{rows}];\nfor &[{names}] in &TABLE {{ {body} }}")
    }
}

/// What an iteration reads side by side from one array.
struct Window {
    array: &'static str,
    /// Temporaries of the loop, each with its place in the array in each iteration. Their distances are always the same.
    inputs: Vec<(u32, Vec<usize>)>,
}

impl Window {
    /// The windows of a loop's inputs, whose temporaries are numbered from `first` on.
    fn of(blocks: &Blocks, inputs: &[Input], first: usize) -> Vec<Self> {
        let mut windows: Vec<Self> = Vec::new();
        for (temporary, input) in (first..).zip(inputs) {
            let array = match input.array {
                Array::States => "x",
                Array::Rates => "r",
                Array::Constants => "c",
                Array::Temporaries => "v",
            };
            let place = |entry: &u32| if array == "v" { blocks.places[entry] } else { *entry as usize };
            let read: (u32, Vec<usize>) = (number(temporary), input.entries.iter().map(place).collect());
            match windows.iter_mut().find(|window| window.array == array && window.has_beside(&read.1)) {
                Some(window) => window.inputs.push(read),
                None => windows.push(Self { array, inputs: vec![read] }),
            }
        }
        windows.iter_mut().for_each(|window| window.inputs.sort_by_key(|(_, places)| places[0]));
        windows
    }

    /// Whether these places have the same distance from those of the window in all iterations.
    fn has_beside(&self, places: &[usize]) -> bool {
        let mut pairs = self.inputs[0].1.iter().zip(places);
        pairs.all(|(own, place)| own + places[0] == place + self.inputs[0].1[0])
    }

    /// The first place in each iteration.
    fn begins(&self) -> Vec<usize> {
        self.inputs[0].1.clone()
    }

    /// The definitions of what is read from the place `at` on.
    fn definition(&self, at: &str) -> String {
        let begin = self.inputs[0].1[0];
        let mut pattern = Vec::new();
        for (input, places) in &self.inputs {
            pattern.resize(places[0] - begin, "_".to_owned());
            pattern.push(temporary(*input));
        }
        window(pattern, self.array, at)
    }
}

/// The definitions of values that stand side by side in an array.
pub(super) fn window(names: impl IntoIterator<Item = String>, array: &str, at: &str) -> String {
    let names = names.into_iter().collect::<Vec<_>>().join(", ");
    format!("let [{names}] = *::bg_model::__private::window({array}, {at});\n")
}

/// The name of a column of a loop's table.
fn column(index: usize) -> String {
    format!("a{index}")
}

/// The code that writes values side by side into an array.
pub(super) fn store(array: &str, at: &str, values: impl IntoIterator<Item = String>) -> String {
    let values = values.into_iter().collect::<Vec<_>>().join(", ");
    format!("::bg_model::__private::store({array}, {at}, [{values}]);")
}

fn number(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 temporaries")
}

fn as_temporary(operand: &Operand) -> Option<u32> {
    if let Operand::Temporary(temporary) = operand { Some(*temporary) } else { None }
}

/// The temporaries of other groups that the assignments of a group read.
fn read_from_others(group: &[Assignment]) -> BTreeSet<u32> {
    let own: BTreeSet<u32> = group.iter().map(|assignment| assignment.target).collect();
    let read = group.iter().flat_map(|assignment| assignment.operation.operands());
    read.filter_map(|operand| as_temporary(&operand)).filter(|read| !own.contains(read)).collect()
}
