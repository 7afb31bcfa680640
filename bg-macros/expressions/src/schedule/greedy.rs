//! Greedy elimination of pairs that several lines have in common, lines being sums or products.
//!
//! In: an [`Elimination`] and the pairs to begin with. Out: the same with no pair left that saves an operation.
//! Method: Hosangadi, Fallah, Kastner 2006 (Optimizing polynomial expressions by algebraic factorization and common
//! subexpression elimination), two-term elimination; the pair with the largest saving first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::hash::Hash;

use rustc_hash::FxHashMap;

use super::table::number;

/// The number of neighbours with which a term or factor forms pairs.
pub(super) const LONGEST: usize = 32;

/// What pairs are eliminated from.
pub(super) trait Elimination {
    /// Two terms or two factors.
    type Pair: Copy + Ord + Hash;
    /// A pair in one line.
    type Occurrence;

    /// Where the pair still is.
    fn places(&mut self, pair: Self::Pair) -> Vec<Self::Occurrence>;

    /// The operations that a line of this pair alone saves.
    fn saving(&mut self, pair: Self::Pair, places: &[Self::Occurrence]) -> i64;

    /// Replaces the pair by a line of its own. Returns the pairs that this makes.
    fn replace(&mut self, pair: Self::Pair, places: &[Self::Occurrence]) -> Vec<Self::Pair>;
}

/// Eliminates pairs until none saves an operation.
pub(super) fn eliminate<E: Elimination>(from: &mut E, pairs: Vec<E::Pair>) {
    let mut queue = BinaryHeap::new();
    enqueue(from, pairs, &mut queue);
    while let Some((stated, Reverse(pair))) = queue.pop() {
        let places = from.places(pair);
        let saving = from.saving(pair, &places);
        if saving < 1 {
            continue;
        }
        if saving < stated {
            queue.push((saving, Reverse(pair)));
            continue;
        }
        let found = from.replace(pair, &places);
        enqueue(from, found, &mut queue);
    }
}

fn enqueue<E: Elimination>(from: &mut E, mut found: Vec<E::Pair>, queue: &mut BinaryHeap<(i64, Reverse<E::Pair>)>) {
    found.sort_unstable();
    found.dedup();
    for pair in found {
        let places = from.places(pair);
        let saving = from.saving(pair, &places);
        if saving > 0 {
            queue.push((saving, Reverse(pair)));
        }
    }
}

/// In which lines each pair was seen.
#[derive(Debug)]
pub(super) struct Seen<P> {
    lines: FxHashMap<P, Vec<u32>>,
    /// In how many lines each member was initially; a member of one line forms no common pair. Members beyond the end
    /// are new.
    members: Vec<u32>,
}

impl<P: Copy + Eq + Hash> Seen<P> {
    /// Nothing seen of lines with these members, which are less than `end`.
    pub(super) fn new(members: impl Iterator<Item = u32>, end: usize) -> Self {
        let mut counts = vec![0; end];
        members.for_each(|member| counts[member as usize] += 1);
        Self { lines: FxHashMap::default(), members: counts }
    }

    /// Whether a member stands in one line only.
    pub(super) fn is_single(&self, member: u32) -> bool {
        self.members.get(member as usize).is_some_and(|&lines| lines < 2)
    }

    /// A member stands in so many more lines.
    pub(super) fn add_lines(&mut self, member: u32, lines: usize) {
        if let Some(members) = self.members.get_mut(member as usize) {
            *members += number(lines);
        }
    }

    /// Notes a pair in a line. Returns how often it has been noted.
    pub(super) fn note(&mut self, pair: P, line: usize) -> usize {
        let lines = self.lines.entry(pair).or_default();
        lines.push(number(line));
        lines.len()
    }

    /// The lines in which a pair was seen, in ascending order.
    pub(super) fn lines(&self, pair: P) -> Vec<usize> {
        let mut lines = self.lines.get(&pair).cloned().unwrap_or_default();
        lines.sort_unstable();
        lines.dedup();
        lines.into_iter().map(|line| line as usize).collect()
    }
}
