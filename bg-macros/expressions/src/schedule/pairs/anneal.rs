//! A better choice of pairs, by trial and error.
//!
//! In: a choice. Out: one with which less is to be done: fewer operations, values gathered, values taken out of pairs
//! and results written. Method: simulated annealing (Kirkpatrick, Gelatt, Vecchi, Science 220, 1983) from a low
//! temperature, with a fixed sequence of random numbers; a change costs or saves only where its operations and their
//! users are.

use std::collections::BTreeMap;
use std::ops::Range;

use rustc_hash::FxHashMap;

use super::choose::{Choice, Needs, is_pairable};
use super::nodes::{Kind, Nodes, Place};
use crate::random::Random;

/// Changes tried for each operation, and at most: long routines take a compiler that is not optimised seconds.
const TRIALS: usize = 400;
const MOST_TRIALS: usize = 160_000;
/// The temperatures at the start and at the end, in operations.
const TEMPERATURES: [f64; 2] = [0.8, 0.1];

/// The choice improved.
pub(super) fn anneal(nodes: &Nodes, choice: Choice) -> Choice {
    let mut state = State::new(nodes, choice);
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

/// What is tried.
#[derive(Clone, Copy)]
enum Change {
    /// Two operations become a pair; pairs that they were in are given up.
    Join([usize; 2]),
    /// A pair is given up.
    Part([usize; 2]),
}

/// New partners of some operations, of each the last one said.
#[derive(Default)]
struct Partners {
    all: [(usize, Option<(usize, usize)>); 6],
    count: usize,
}

impl Partners {
    fn push(&mut self, node: usize, partner: Option<(usize, usize)>) {
        self.all[self.count] = (node, partner);
        self.count += 1;
    }

    fn all(&self) -> &[(usize, Option<(usize, usize)>)] {
        &self.all[..self.count]
    }
}

/// A choice with its cost. As the compiler may itself be built without optimisation, values are plain numbers here.
struct State<'n> {
    nodes: &'n Nodes,
    values: Values<'n>,
    /// By operation: the results that are its value.
    results: Vec<Vec<usize>>,
    choice: Choice,
    needs: Needs,
    cost: i32,
    /// How often two values are gathered.
    gathered: FxHashMap<[usize; 2], u32>,
    /// By operation: how often it is taken out of a pair whose second half it is.
    taken: Vec<u32>,
    /// Where the change under way costs or saves: operations by themselves or the pairs whose first halves they are,
    /// then results.
    sites: Vec<usize>,
    /// By site: the last change that it was named in.
    named: Vec<u32>,
    changes: u32,
}

/// The number of all constants.
const CONSTANT: usize = usize::MAX;

/// Values by number: those of operations, of states side by side, of others.
struct Values<'n> {
    states: Range<usize>,
    /// By operation: its first two operands.
    operands: Vec<[usize; 2]>,
    /// By value: the operations that use it. The number after the states has none.
    users: Vec<&'n [usize]>,
}

impl<'n> Values<'n> {
    fn new(nodes: &'n Nodes) -> Self {
        let first = nodes.all.len();
        let states = first..first + nodes.states().last().map_or(0, |last| last as usize + 1);
        let of_states = (0..).map(Place::State).take(states.len() + 1);
        let mut users: Vec<&[usize]> = (0..first).map(Place::Node).chain(of_states).map(|of| nodes.users(of)).collect();
        let mut others: BTreeMap<Place, usize> = BTreeMap::new();
        let mut operands = vec![[CONSTANT; 2]; first];
        for (operands, node) in operands.iter_mut().zip(&nodes.all) {
            for (number, operand) in operands.iter_mut().zip(&node.operands) {
                *number = match operand.place() {
                    Place::Constant => CONSTANT,
                    Place::Node(node) => node,
                    Place::State(index) => first + index as usize,
                    other => *others.entry(other).or_insert_with(|| {
                        users.push(nodes.users(other));
                        users.len() - 1
                    }),
                }
            }
        }
        Self { states, operands, users }
    }

    /// The values that meet in a pair of operations.
    fn meeting(&self, [first, second]: [usize; 2], is_swapped: bool) -> [[usize; 2]; 2] {
        let ([a, b], [c, d]) = (self.operands[first], self.operands[second]);
        if is_swapped { [[a, d], [b, c]] } else { [[a, c], [b, d]] }
    }
}

impl<'n> State<'n> {
    fn new(nodes: &'n Nodes, choice: Choice) -> Self {
        let count = nodes.all.len();
        let mut results = vec![Vec::new(); count];
        for (index, result) in nodes.results.iter().enumerate() {
            if let Some(node) = result.node() {
                results[node].push(index);
            }
        }
        let sites = count + nodes.results.len();
        let mut state = Self {
            nodes,
            values: Values::new(nodes),
            results,
            choice,
            needs: Needs::new(count),
            cost: 0,
            gathered: FxHashMap::default(),
            taken: vec![0; count],
            sites: Vec::new(),
            named: vec![0; sites + 1],
            changes: 0,
        };
        (0..sites).for_each(|site| state.count(site, 1));
        state
    }

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
        let Values { states, operands, users } = &self.values;
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

    /// Whether a new pair's operations need each other.
    fn is_circular(&mut self, change: Change) -> bool {
        matches!(change, Change::Join(pair) if self.needs.is_circular(self.nodes, &self.choice, pair))
    }

    /// Makes a change; gives the partners to go back to.
    fn apply(&mut self, change: Change) -> Partners {
        let (Change::Join(pair) | Change::Part(pair)) = change;
        let mut now = Partners::default();
        for node in pair {
            if let Some((other, _)) = self.choice.partner(node) {
                now.push(node, None);
                now.push(other, None);
            }
        }
        if matches!(change, Change::Join(_)) {
            now.push(pair[0], Some((pair[1], 0)));
            now.push(pair[1], Some((pair[0], 1)));
        }
        let mut before = Partners::default();
        for &(node, _) in now.all() {
            before.push(node, self.choice.partner(node));
        }
        self.replace(now);
        before
    }

    /// Gives operations these partners and keeps the account.
    fn replace(&mut self, partners: Partners) {
        // The same sites before and after: every operation whose partner changes is among them.
        self.sites.clear();
        self.changes += 1;
        for &(node, _) in partners.all() {
            self.name_sites(node);
        }
        for at in 0..self.sites.len() {
            self.count(self.sites[at], -1);
        }
        for &(node, partner) in partners.all() {
            self.choice.partners[node] = partner;
        }
        for at in 0..self.sites.len() {
            self.count(self.sites[at], 1);
        }
    }

    /// Names the sites where this operation's partner matters.
    fn name_sites(&mut self, node: usize) {
        self.name_operation(node);
        for &user in self.values.users[node] {
            self.name_operation(user);
        }
        for at in 0..self.results[node].len() {
            let result = self.nodes.all.len() + self.results[node][at];
            self.name(result);
            self.name(result + 1);
            if self.results[node][at] > 0 {
                self.name(result - 1);
            }
        }
    }

    fn name_operation(&mut self, node: usize) {
        self.name(node);
        if let Some((other, _)) = self.choice.partner(node) {
            self.name(other);
        }
    }

    fn name(&mut self, site: usize) {
        if self.named[site] != self.changes {
            self.named[site] = self.changes;
            self.sites.push(site);
        }
    }

    /// Adds the cost of a site, or takes it away.
    fn count(&mut self, site: usize, by: i32) {
        match site.checked_sub(self.nodes.all.len()) {
            None => self.count_operation(site, by),
            Some(result) => self.count_result(result, by),
        }
    }

    fn count_operation(&mut self, node: usize, by: i32) {
        let kind = self.nodes.all[node].kind;
        match self.choice.partners[node] {
            _ if kind == Kind::Negation => {}
            Some((_, 1)) => {}
            Some((other, _)) => {
                self.cost += by;
                let [straight, swapped] =
                    [false, true].map(|is_swapped| self.values.meeting([node, other], is_swapped));
                if by > 0 {
                    let is_better = || self.to_gather(swapped) < self.to_gather(straight);
                    self.choice.swapped[node] = kind != Kind::Quotient && is_better();
                }
                for values in if self.choice.swapped[node] { swapped } else { straight } {
                    if !self.is_pair(values) {
                        self.count_gathered(values, by);
                    }
                }
            }
            None => {
                self.cost += by;
                for operand in self.values.operands[node] {
                    self.count_taken(operand, by);
                }
            }
        }
    }

    /// How many of two pairs of values have to be gathered.
    fn to_gather(&self, [first, second]: [[usize; 2]; 2]) -> usize {
        usize::from(!self.is_pair(first)) + usize::from(!self.is_pair(second))
    }

    /// As [`Choice::is_pair`].
    fn is_pair(&self, [first, second]: [usize; 2]) -> bool {
        let states = &self.values.states;
        if first < states.start {
            self.choice.partners[first] == Some((second, 0))
        } else if first == CONSTANT {
            second == CONSTANT
        } else {
            states.contains(&second) && second == first + 1
        }
    }

    fn count_result(&mut self, result: usize, by: i32) {
        let results = &self.nodes.results;
        let value = |result: usize| results.get(result).and_then(|value| value.node());
        let is_pair = |first: usize| match (value(first), value(first + 1)) {
            (Some(first), Some(second)) => self.is_pair([first, second]),
            _ => false,
        };
        // A pair of results is written at once, with the first of them.
        if result >= results.len() || result > 0 && is_pair(result - 1) {
            return;
        }
        let taken = value(result).filter(|_| !is_pair(result));
        self.cost += by;
        if let Some(value) = taken {
            self.count_taken(value, by);
        }
    }

    fn count_gathered(&mut self, values: [usize; 2], by: i32) {
        let count = self.gathered.entry(values).or_insert(0);
        let before = *count;
        *count = count.checked_add_signed(by).expect("what was counted");
        if before == 0 || *count == 0 {
            self.cost += by;
        }
    }

    /// A use of a number that is, if anywhere, in the second half of a pair.
    fn count_taken(&mut self, value: usize, by: i32) {
        if value < self.values.states.start
            && let Some((_, 1)) = self.choice.partners[value]
        {
            let before = self.taken[value];
            self.taken[value] = before.checked_add_signed(by).expect("what was counted");
            if before == 0 || self.taken[value] == 0 {
                self.cost += by;
            }
        }
    }
}
