//! Long straight-line code in blocks.
//!
//! In: the assignments of a long routine. Out: groups of them, of which those that repeat themselves are loops, and
//! each group as it is written. What a group hands to others, or as a result, is in the array `v`; all else are its own
//! `let`s. Each `let` is a scope inside the one before, and LLVM's stack overflows over some thousands of them; places
//! of an array take rustc's check ten times as long as `let`s.
//!
//! An iteration reads windows: places of an array side by side, whose first one goes on in even steps or stands in a
//! table. So bounds are checked once for a window, if at all, and what stands in it has no place to calculate.

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

    /// The groups of assignments, with loops where they repeat themselves. Operands of which one is of a kind and the
    /// other is not do not stand at the same place of an iteration.
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
pub(super) struct Chunk<'a> {
    /// Its assignments; of a loop those that all iterations have in common.
    pub(super) assignments: Cow<'a, [Assignment]>,
    /// What the temporaries of a loop are in its first iteration: the targets, then what it reads. Of no loop: nothing.
    pub(super) first: Vec<Operand>,
    /// The places that the iterations of a loop have elsewhere.
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
    pub(super) fn part<'a>(&self, group: &Group<'a>) -> Chunk<'a> {
        if group.period == group.assignments.len() { self.straight(group.assignments) } else { self.repeated(group) }
    }

    fn straight<'a>(&self, assignments: &'a [Assignment]) -> Chunk<'a> {
        let reads = read_from_others(assignments)
            .into_iter()
            .map(|temporary| routine::definition(temporary, &self.place(temporary)))
            .collect();
        let first = self.handed(assignments).next();
        let writes =
            first.map(|first| store(&self.places[&first].to_string(), self.handed(assignments).map(temporary)));
        Chunk { assignments: assignments.into(), reads, writes: writes.unwrap_or_default(), ..Chunk::default() }
    }

    fn repeated<'a>(&self, group: &Group<'a>) -> Chunk<'a> {
        let Piece { assignments, inputs } = repetition::piece(group.assignments, group.period);
        let targets = group.assignments[..group.period].iter().map(|assignment| assignment.target);
        let read = inputs.iter().map(|input| input.array.operand(input.entries[0]));
        let first = targets.clone().map(Operand::Temporary).chain(read).collect();
        let mut part = Chunk { assignments: assignments.into(), first, ..Chunk::default() };
        for window in Window::of(self, &inputs, group.period) {
            let at = part.column(window.begins());
            part.reads += &window.definition(&at);
        }
        let handed = (0..).zip(targets).filter(|(_, target)| self.places.contains_key(target));
        let handed: Vec<u32> = handed.map(|(index, _)| index).collect();
        let begins = group.iterations().filter_map(|iteration| self.handed(iteration).next());
        let at = part.column(begins.map(|temporary| self.places[&temporary]).collect());
        part.writes = store(&at, handed.into_iter().map(temporary));
        part
    }

    /// The temporaries of these that are handed on.
    fn handed(&self, assignments: &[Assignment]) -> impl Iterator<Item = u32> {
        let targets = assignments.iter().map(|assignment| assignment.target);
        targets.filter(|target| self.places.contains_key(target))
    }

    /// A result of the routine, after its blocks.
    pub(super) fn result(&self, result: &Operand, names: &Names) -> String {
        as_temporary(result).map_or_else(|| operand(result, names), |temporary| self.place(temporary))
    }

    fn place(&self, temporary: u32) -> String {
        format!("v[{}]", self.places[&temporary])
    }
}

impl Chunk<'_> {
    /// The name of a place that each iteration has elsewhere.
    pub(super) fn column(&mut self, of_iterations: Vec<usize>) -> String {
        self.columns.push(of_iterations);
        column(self.columns.len() - 1)
    }

    /// The names of the next columns.
    pub(super) fn next_columns<const K: usize>(&self) -> [String; K] {
        std::array::from_fn(|index| column(self.columns.len() + index))
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
        let places: String =
            columns.iter().enumerate().map(|(index, places)| places_of(&column(index), places)).collect();
        format!("for i in 0..{iterations} {{ {places}{body} }}")
    }
}

/// The definition of a place in iteration `i`: in even steps, from which LLVM knows that it is in bounds, or from a
/// table.
fn places_of(name: &str, places: &[usize]) -> String {
    let first = places[0];
    let step = places[1].checked_sub(first);
    let is_even = |step: &usize| places.iter().enumerate().all(|(index, place)| *place == first + index * step);
    match step.filter(is_even) {
        Some(0) => format!("let {name} = {first};\n"),
        Some(step) => format!("let {name} = {first} + {step} * i;\n"),
        None => {
            format!("let {name} = {{ static PLACES: [usize; {}] = {places:?}; PLACES[i] }};\n", places.len())
        }
    }
}

/// What an iteration reads side by side from one array.
struct Window {
    array: &'static str,
    /// Temporaries of the loop, each with its place in the array in each iteration. Their distances are always the
    /// same.
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
        format!("let [{}] = *::bg_model::__private::window({}, {at});\n", pattern.join(", "), self.array)
    }
}

/// The name of a column of a loop's table.
fn column(index: usize) -> String {
    format!("a{index}")
}

/// The code that hands on values side by side.
fn store(at: &str, values: impl Iterator<Item = String>) -> String {
    format!("::bg_model::__private::store(v, {at}, [{}]);", values.collect::<Vec<_>>().join(", "))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Symbol;
    use crate::program::Operation;

    /// Iterations of 150 assignments, each of which reads two states and what the one before gives.
    fn chain(count: u32) -> Vec<Assignment> {
        let state = |index| Operand::Symbol(Symbol::State(index));
        let operation = |index: u32| match (index / 150, index % 150) {
            (iteration, 0) => Operation::Multiply(state(2 * iteration + 1), state(2 * iteration + 3)),
            (0, 1) => Operation::Add(Operand::Temporary(0), Operand::Temporary(0)),
            (iteration, 1) => Operation::Add(Operand::Temporary(index - 1), Operand::Temporary(150 * iteration - 1)),
            _ => Operation::Multiply(Operand::Temporary(index - 1), Operand::Temporary(index - 2)),
        };
        (0..150 * count).map(|target| Assignment { target, operation: operation(target) }).collect()
    }

    #[test]
    fn a_loop_reads_windows_and_hands_on_side_by_side() {
        let assignments = chain(5);
        let groups = Group::of(&assignments, &|_| false);
        let lengths: Vec<_> = groups.iter().map(|group| (group.assignments.len(), group.period)).collect();
        assert_eq!(lengths, [(1, 1), (600, 150), (149, 149)]);
        let blocks = Blocks::of(&groups, &[Operand::Temporary(749)]);
        let [first, part, last] = [0, 1, 2].map(|index| blocks.part(&groups[index]).code(""));
        assert_eq!(first, "::bg_model::__private::store(v, 0, [v0]);");
        let expected = "for i in 0..4 { let a0 = 0 + 2 * i;\n\
                        let a1 = { static PLACES: [usize; 4] = [0, 1, 3, 5]; \
                        PLACES[i] };\nlet a2 = 3 + 2 * i;\nlet a3 = 1 + 2 * i;\n\
                        let [v150] = *::bg_model::__private::window(v, a0);\nlet [v151] = \
                        *::bg_model::__private::window(v, a1);\n\
                        let [v152, _, v153] = *::bg_model::__private::window(x, a2);\n\
                        ::bg_model::__private::store(v, a3, [v148, v149]); }";
        assert_eq!(part, expected);
        assert_eq!(last, "let v599 = v[7];\nlet v600 = v[8];\n::bg_model::__private::store(v, 9, [v749]);");
    }

    #[test]
    fn places_go_on_in_steps_or_stand_in_a_table() {
        assert_eq!(places_of("a3", &[5, 5, 5]), "let a3 = 5;\n");
        assert_eq!(places_of("a3", &[5, 8, 11]), "let a3 = 5 + 3 * i;\n");
        let table = "let a3 = { static PLACES: [usize; 3] = [5, 8, 12]; PLACES[i] };\n";
        assert_eq!(places_of("a3", &[5, 8, 12]), table);
        assert_eq!(places_of("a3", &[5, 4, 3]), table.replace("[5, 8, 12]", "[5, 4, 3]"));
    }
}
