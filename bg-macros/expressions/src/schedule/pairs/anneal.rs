//! A better choice of pairs, by trial and error.
//!
//! In: a choice. Out: one with which less is to be done: fewer operations, values gathered, values taken out of pairs
//! and results written. Method: simulated annealing (Kirkpatrick, Gelatt, Vecchi, Science 220, 1983) from a low
//! temperature, with a fixed sequence of random numbers.

use super::Zeros;
use super::account::{Change, State};
use super::choose::{Choice, is_pairable};
use super::nodes::Nodes;
use crate::random::Random;

/// Changes tried for each operation, and at most: long routines take a compiler that is not optimised seconds.
const TRIALS: usize = 400;
const MOST_TRIALS: usize = 160_000;
/// The temperatures at the start and at the end, in operations.
const TEMPERATURES: [f64; 2] = [0.8, 0.1];

/// The choice improved.
pub(super) fn anneal(nodes: &Nodes, choice: Choice) -> Choice {
    let mut state = State::new(nodes, choice, Zeros::OfAnySign);
    let mut random = Random::new(1);
    let mut best = (state.cost, state.choice.clone());
    let trials = (TRIALS * nodes.all.len()).min(MOST_TRIALS);
    let [mut temperature, last] = TEMPERATURES;
    let cooling = (last / temperature).powf(1.0 / trials as f64);
    for _ in 0..trials {
        temperature *= cooling;
        let Some(change) = state.propose(&mut random) else { continue };
        let before = state.cost;
        let undo = state.apply(change);
        let worse = f64::from(state.cost - before);
        let is_kept = worse <= 0.0 || random.unit() < (-worse / temperature).exp();
        if !is_kept || state.is_circular(change) {
            state.replace(undo);
        } else if state.cost < best.0 {
            best = (state.cost, state.choice.clone());
        }
    }
    best.1
}

impl State<'_> {
    /// A random change that may help: partners are sought around the pairs of operands, users and states.
    fn propose(&self, random: &mut Random) -> Option<Change> {
        let node = random.below(self.nodes.all.len());
        let kind = self.nodes.all[node].kind;
        if !is_pairable(kind) {
            return None;
        }
        if let Some((other, half)) = self.choice.partner(node)
            && random.below(4) == 0
        {
            let pair = if half == 0 { [node, other] } else { [other, node] };
            return Some(if random.below(2) == 0 { Change::Part(pair) } else { Change::Join([pair[1], pair[0]]) });
        }
        let other = self.neighbour(node, random)?;
        let is_fit = other != node && self.nodes.all[other].kind == kind;
        is_fit.then(|| Change::Join(if random.below(2) == 0 { [node, other] } else { [other, node] }))
    }

    /// An operation beside this one: it uses what is paired with an operand, or is used by what is paired with a user,
    /// or is the next result.
    fn neighbour(&self, node: usize, random: &mut Random) -> Option<usize> {
        let super::account::Values { states, operands, users } = &self.values;
        let pick = |from: &[usize], random: &mut Random| {
            if from.is_empty() { None } else { Some(from[random.below(from.len())]) }
        };
        match random.below(5) {
            0 | 1 => {
                let operand = operands[node][random.below(2)];
                let beside = if operand < states.start {
                    self.choice.partner(operand)?.0
                } else if !states.contains(&operand) {
                    return None;
                } else if random.below(2) == 0 {
                    operand + 1
                } else if operand > states.start {
                    operand - 1
                } else {
                    return None;
                };
                pick(users[beside], random)
            }
            2 | 3 => {
                let (other, _) = self.choice.partner(pick(users[node], random)?)?;
                Some(operands[other][random.below(2)]).filter(|&operand| operand < states.start)
            }
            _ => {
                let result = *self.results[node].first()?;
                let next = if random.below(2) == 0 { result + 1 } else { result.checked_sub(1)? };
                self.nodes.results.get(next)?.node()
            }
        }
    }
}
