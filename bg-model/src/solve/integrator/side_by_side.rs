//! Calculations that are the same for each state, several states side by side.
//!
//! In: what is calculated of some states. Out: it is done for all of them. A group's numbers are read into arrays of a known length before
//! any is written, so that they become vectors of the machine however many states there are, and whatever lies beside what is written.

/// What is calculated of each state.
pub(super) trait OfEach {
    /// Calculates it of `W` states from `first` on.
    fn of<const W: usize>(&mut self, first: usize);
}

/// Calculates it of the states `from`..`to`, whose numbers are of type `S`: of those that are vectors already one after the other.
#[inline(always)]
pub(super) fn for_each<S>(from: usize, to: usize, calculation: &mut impl OfEach) {
    let mut first = from;
    if size_of::<S>() == size_of::<f64>() {
        while first + 8 <= to {
            calculation.of::<8>(first);
            first += 8;
        }
        if first + 4 <= to {
            calculation.of::<4>(first);
            first += 4;
        }
        if first + 2 <= to {
            calculation.of::<2>(first);
            first += 2;
        }
    }
    while first < to {
        calculation.of::<1>(first);
        first += 1;
    }
}

/// The numbers from `first` on.
#[inline(always)]
pub(super) fn some<S: Copy, const W: usize>(of: &[S], first: usize) -> [S; W] {
    *of[first..].first_chunk().expect("there is a number for each state")
}

/// Writes numbers from `first` on.
#[inline(always)]
pub(super) fn put<S: Copy, const W: usize>(to: &mut [S], first: usize, numbers: [S; W]) {
    *to[first..].first_chunk_mut().expect("there is a number for each state") = numbers;
}
