//! Where the damped states are among all.
//!
//! In: the states. Out: groups of them as they stand side by side in their block, and what is read and written of a
//! state by groups.

use alloc::vec::Vec;

/// States side by side in a group.
pub(super) const LANES: usize = 4;
pub(super) type Lanes = [f64; LANES];

/// The states of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    /// From this one on.
    Run(usize),
    /// These, of which so many count.
    Apart([usize; LANES], usize),
}

/// The damped states in the order of their block.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    pub states: Vec<usize>,
    pub groups: Vec<Group>,
    /// Those that stand apart; work space.
    apart: Vec<usize>,
}

impl Places {
    /// Takes these states, ascending: first what stands side by side.
    pub fn take(&mut self, mut states: &[usize]) {
        let Self { states: order, groups, apart } = self;
        order.clear();
        groups.clear();
        apart.clear();
        while let Some((&first, others)) = states.split_first() {
            if states.get(LANES - 1) == Some(&(first + LANES - 1)) {
                groups.push(Group::Run(first));
                order.extend(first..first + LANES);
                states = &states[LANES..];
            } else {
                apart.push(first);
                states = others;
            }
        }
        order.extend(&*apart);
        let group = |of: &[usize]| Group::Apart(core::array::from_fn(|lane| of[lane.min(of.len() - 1)]), of.len());
        groups.extend(apart.chunks(LANES).map(group));
        // Few of them, or blocks of four.
        let length = groups.len();
        groups.resize(if length > 4 { length.next_multiple_of(4) } else { length }, Group::Apart([0; LANES], 0));
    }

    /// The groups of a matrix of these states.
    pub fn entries(&self) -> usize {
        self.states.len() * self.groups.len()
    }
}

impl Group {
    /// The states of the group.
    #[inline(always)]
    pub fn read(self, x: &[f64]) -> Lanes {
        match self {
            Self::Run(first) => {
                let mut lanes = Lanes::default();
                lanes.copy_from_slice(&x[first..first + LANES]);
                lanes
            }
            Self::Apart(states, _) => states.map(|state| x[state]),
        }
    }

    /// Writes the states of the group.
    #[inline(always)]
    pub fn write(self, lanes: &Lanes, x: &mut [f64]) {
        match self {
            Self::Run(first) => x[first..first + LANES].copy_from_slice(lanes),
            Self::Apart(states, count) => {
                for (state, from) in states.into_iter().zip(lanes).take(count) {
                    x[state] = *from;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_side_by_side_is_read_and_written_whole() {
        let mut places = Places::default();
        places.take(&[0, 1, 3, 4, 5, 6, 7, 9]);
        assert_eq!(places.states, [3, 4, 5, 6, 0, 1, 7, 9]);
        assert_eq!(places.groups, [Group::Run(3), Group::Apart([0, 1, 7, 9], 4)]);
        places.take(&[2, 3, 4, 5, 8]);
        assert_eq!(places.groups, [Group::Run(2), Group::Apart([8; 4], 1)]);
        let mut x: [f64; 10] = core::array::from_fn(|i| i as f64);
        let lanes: Vec<Lanes> = places.groups.iter().map(|group| group.read(&x)).collect();
        assert_eq!(lanes, [[2.0, 3.0, 4.0, 5.0], [8.0; 4]]);
        for (group, lanes) in places.groups.iter().zip(lanes) {
            group.write(&lanes.map(|lane| -lane), &mut x);
        }
        assert_eq!(x, [0.0, 1.0, -2.0, -3.0, -4.0, -5.0, 6.0, 7.0, -8.0, 9.0]);
    }

    #[test]
    fn many_groups_are_whole_blocks_of_four() {
        let mut places = Places::default();
        places.take(&(0..18).collect::<Vec<_>>());
        assert_eq!((places.states.len(), places.groups.len(), places.entries()), (18, 8, 144));
    }
}
