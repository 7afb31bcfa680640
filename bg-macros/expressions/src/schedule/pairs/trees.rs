//! Which operations go together, found in little time.
//!
//! In: the operations. Out: pairs of them. Method: superword level parallelism as compilers seek it (S. Larsen, S.
//! Amarasinghe, PLDI 2000; V. Porpodas, R. Rocha, L. Goes, PACT 2018 for looking ahead): from neighbours among the
//! results and the states, and from the users of pairs, whole trees of operands are joined as far as they are alike.
//! What of a tree does not pay is parted again, from the leaves on, and the tree is left where nothing of it pays.

use super::Zeros;
use super::account::{Change, State};
use super::choose::{Choice, is_pairable};
use super::nodes::{Kind, Nodes};

/// How often all beginnings of trees are tried: later ones find pairs of earlier ones.
const ROUNDS: usize = 3;
/// How many operations ahead two operands are compared.
const AHEAD: u32 = 2;

/// Pairs of these operations, with which zeros keep their signs.
pub(super) fn trees(nodes: &Nodes) -> Choice {
    let count = nodes.all.len();
    let none = Choice { partners: vec![None; count], swapped: vec![false; count] };
    let mut state = State::new(nodes, none, Zeros::OfTheirSign);
    for _ in 0..ROUNDS {
        let before = state.cost;
        state.grow_from_results();
        state.grow_from_pairs();
        state.grow_from_states();
        if state.cost == before {
            break;
        }
    }
    state.choice
}

impl State<'_> {
    fn grow_from_results(&mut self) {
        let nodes = self.nodes;
        for pair in nodes.results.windows(2) {
            if let [Some(first), Some(second)] = [pair[0].node(), pair[1].node()] {
                self.grow([first, second]);
            }
        }
    }

    fn grow_from_pairs(&mut self) {
        for first in (0..self.nodes.all.len()).rev() {
            if let Some((second, 0)) = self.choice.partner(first) {
                self.grow_from_users([first, second]);
            }
        }
    }

    fn grow_from_states(&mut self) {
        for state in self.values.states.clone() {
            self.grow_from_users([state, state + 1]);
        }
    }

    fn grow_from_users(&mut self, pair: [usize; 2]) {
        let [first, second] = pair.map(|value| self.values.users[value]);
        for &first in first {
            second.iter().for_each(|&second| self.grow([first, second]));
        }
    }

    /// Joins what pays of the tree of two operations.
    fn grow(&mut self, pair: [usize; 2]) {
        let before = self.cost;
        let mut joined = Vec::new();
        self.join_tree(pair, &mut joined);
        for at in (0..joined.len()).rev() {
            let with = self.cost;
            let undo = self.apply(Change::Part(joined[at]));
            if self.cost > with {
                self.replace(undo);
            } else {
                joined.remove(at);
            }
        }
        if self.cost >= before {
            joined.iter().rev().for_each(|&pair| _ = self.apply(Change::Part(pair)));
        }
    }

    /// Joins two operations and, as far as they are alike, what they need; enters the pairs, users first.
    fn join_tree(&mut self, pair: [usize; 2], joined: &mut Vec<[usize; 2]>) {
        let mut open = vec![pair];
        while let Some(pair) = open.pop() {
            if !self.may_join(pair) || self.is_circular(Change::Join(pair)) {
                continue;
            }
            self.apply(Change::Join(pair));
            joined.push(pair);
            let [first, second] = self.best_meeting(pair, AHEAD).0;
            open.extend([second, first]);
        }
    }

    fn may_join(&self, [first, second]: [usize; 2]) -> bool {
        let count = self.nodes.all.len();
        let is_free = |node: usize| node < count && self.choice.partner(node).is_none();
        let kind = |node: usize| self.nodes.all[node].kind;
        first != second && is_free(first) && is_free(second) && kind(first) == kind(second) && is_pairable(kind(first))
    }

    /// The operands that meet where they are more alike, and how much they are.
    fn best_meeting(&self, pair: [usize; 2], ahead: u32) -> ([[usize; 2]; 2], u32) {
        let scored = |is_swapped: bool| {
            let meeting = self.values.meeting(pair, is_swapped);
            (meeting, meeting.iter().map(|&values| self.likeness(values, ahead)).sum())
        };
        let straight = scored(false);
        if self.nodes.all[pair[0]].kind == Kind::Quotient {
            return straight;
        }
        let swapped = scored(true);
        if swapped.1 > straight.1 { swapped } else { straight }
    }

    /// How alike two values are: pairs most, then operations that can be joined, with what they need as far as one
    /// looks ahead.
    fn likeness(&self, values: [usize; 2], ahead: u32) -> u32 {
        if self.is_pair(values) {
            4
        } else if values[0] == values[1] {
            1
        } else if !self.may_join(values) {
            0
        } else if ahead == 0 {
            2
        } else {
            2 + self.best_meeting(values, ahead - 1).1
        }
    }
}
