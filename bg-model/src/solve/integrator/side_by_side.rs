//! Numbers of all states in groups side by side.
//!
//! In: how many states there are. Out: numbers for each of them, and groups of these as arrays of a length that is
//! known when this is compiled: what is calculated of a group becomes vectors of the machine however many states there
//! are.

use alloc::vec;
use alloc::vec::Vec;
use core::iter::once;
use core::ops::{Deref, DerefMut, Range};

/// Numbers of a run in a group.
pub(crate) const SIDE_BY_SIDE: usize = 8;

/// A number for each state, with room behind them for a group that begins at the last one.
#[derive(Clone, Debug)]
pub(crate) struct Padded<S, const W: usize> {
    numbers: Vec<S>,
    states: usize,
}

impl<S: Copy, const W: usize> Padded<S, W> {
    /// This number for each of so many states.
    pub fn new(states: usize, number: S) -> Self {
        Self { numbers: vec![number; states + W - 1], states }
    }

    /// The group that begins at a state.
    #[inline(always)]
    pub fn group(&self, first: usize) -> [S; W] {
        some(&self.numbers, first)
    }

    /// The numbers with the room behind them, of `N` that have the same room: slices of one length, so that one look
    /// at where a group is serves for all of them.
    #[inline(always)]
    pub fn with_room<const N: usize>(all: [&mut Self; N]) -> [&mut [S]; N] {
        let length = all.iter().map(|numbers| numbers.numbers.len()).min().unwrap_or(0);
        all.map(|numbers| &mut numbers.numbers[..length])
    }

    /// Writes the group that begins at a state, and what lies behind the last state with it.
    #[inline(always)]
    pub fn set_group(&mut self, first: usize, group: [S; W]) {
        put(&mut self.numbers, first, group);
    }
}

impl<S, const W: usize> Deref for Padded<S, W> {
    type Target = [S];

    #[inline(always)]
    fn deref(&self) -> &[S] {
        &self.numbers[..self.states]
    }
}

impl<S, const W: usize> DerefMut for Padded<S, W> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [S] {
        &mut self.numbers[..self.states]
    }
}

/// `R` rows of numbers for each state, as those of the stages of a step: of each group all rows stand together, so that
/// a sum over rows finds them by one look at where the group is.
#[derive(Clone, Debug)]
pub(crate) struct Stack<S, const W: usize, const R: usize> {
    /// The first state of each group, and its rows.
    groups: Vec<(usize, [[S; W]; R])>,
}

impl<S: Copy, const W: usize, const R: usize> Stack<S, W, R> {
    /// This number everywhere, in room for so many states and further groups.
    pub fn new(states: usize, further: usize, number: S) -> Self {
        let mut stack = Self { groups: Vec::with_capacity(states.div_ceil(W) + further) };
        stack.arrange(once(0..states), number);
        stack
    }

    /// Makes groups of these states, none of which has states of two of the ranges; with this number everywhere.
    pub fn arrange(&mut self, ranges: impl IntoIterator<Item = Range<usize>>, number: S) {
        self.groups.clear();
        let firsts = ranges.into_iter().flat_map(|states| states.step_by(W));
        self.groups.extend(firsts.map(|first| (first, [[number; W]; R])));
    }

    /// The groups, each with its first state.
    #[inline(always)]
    pub fn groups(&self) -> &[(usize, [[S; W]; R])] {
        &self.groups
    }

    /// The same, to be changed.
    #[inline(always)]
    pub fn groups_mut(&mut self) -> &mut [(usize, [[S; W]; R])] {
        &mut self.groups
    }

    /// Writes a row.
    #[inline(always)]
    pub fn set_row(&mut self, row: usize, numbers: &Padded<S, W>) {
        for (first, rows) in &mut self.groups {
            rows[row] = numbers.group(*first);
        }
    }

    /// The numbers of a row, each with its state, of groups of this many states or fewer: up to the first state of the
    /// next one.
    pub fn row(&self, row: usize, states: usize) -> impl Iterator<Item = (usize, S)> {
        let ends = self.groups[1.min(self.groups.len())..].iter().map(|(first, _)| *first).chain([states]);
        self.groups.iter().zip(ends).flat_map(move |((first, rows), end)| (*first..end).zip(rows[row]))
    }
}

/// A calculation for each state.
pub(crate) trait OfEach {
    /// Whether it gives the same where it is done of a state twice, as it does where it reads nothing that it writes.
    const CAN_REPEAT: bool;

    /// Calculates it of `W` states from `first` on.
    fn of<const W: usize>(&mut self, first: usize);
}

/// Calculates it of so many states.
#[inline(always)]
pub(crate) fn for_each<C: OfEach>(states: usize, calculation: &mut C) {
    let mut first = 0;
    while first + SIDE_BY_SIDE <= states {
        calculation.of::<SIDE_BY_SIDE>(first);
        first += SIDE_BY_SIDE;
    }
    if C::CAN_REPEAT && first > 0 && first < states {
        return calculation.of::<SIDE_BY_SIDE>(states - SIDE_BY_SIDE);
    }
    while first < states {
        calculation.of::<1>(first);
        first += 1;
    }
}

/// The numbers from `first` on.
#[inline(always)]
pub(crate) fn some<S: Copy, const W: usize>(of: &[S], first: usize) -> [S; W] {
    *of[first..].first_chunk().expect("there is a number for each state")
}

/// Writes numbers from `first` on.
#[inline(always)]
pub(crate) fn put<S: Copy, const W: usize>(to: &mut [S], first: usize, numbers: [S; W]) {
    *to[first..].first_chunk_mut().expect("there is a number for each state") = numbers;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Doubles numbers, and counts how often it does of each.
    struct Doubled<'a> {
        of: &'a [f64],
        to: Vec<f64>,
        times: Vec<u32>,
    }

    impl OfEach for Doubled<'_> {
        const CAN_REPEAT: bool = true;

        fn of<const W: usize>(&mut self, first: usize) {
            put(&mut self.to, first, some::<_, W>(self.of, first).map(|number| 2.0 * number));
            self.times[first..first + W].iter_mut().for_each(|times| *times += 1);
        }
    }

    #[test]
    fn each_state_is_calculated_whatever_their_number() {
        for states in 0..40 {
            let of: Vec<f64> = (0..states).map(|state| state as f64).collect();
            let mut doubled = Doubled { of: &of, to: vec![-1.0; states], times: vec![0; states] };
            for_each(states, &mut doubled);
            assert!(doubled.to.iter().zip(&of).all(|(to, of)| *to == 2.0 * of), "{states} states: {:?}", doubled.to);
            // Beyond whole groups one more group, not one state after the other.
            let most = if states > SIDE_BY_SIDE && !states.is_multiple_of(SIDE_BY_SIDE) { 2 } else { 1 };
            assert_eq!(doubled.times.iter().max().copied().unwrap_or(1), most, "{states} states");
        }
    }
}
