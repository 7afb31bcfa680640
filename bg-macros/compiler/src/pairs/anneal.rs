//! A better choice of pairs, by trial and error.
//!
//! In: a choice. Out: one with which less is to be done: fewer operations, values gathered, values taken out of pairs and
//! results written. Method: simulated annealing (Kirkpatrick, Gelatt, Vecchi, Science 220, 1983) from a low temperature, with a
//! fixed sequence of random numbers; a change costs or saves only where its operations and their users are.

use super::choose::{Choice, is_circular, is_pairable, meeting, places};
use super::nodes::{Kind, Nodes, Place, Signed};
use crate::program::table::Table;
use crate::random::Random;

/// Changes tried for each operation.
const TRIALS: usize = 200;
/// The temperatures at the start and at the end, in operations.
const TEMPERATURES: [f64; 2] = [0.8, 0.1];

/// The choice improved.
pub(super) fn anneal(nodes: &Nodes, choice: Choice) -> Choice {
    let mut state = State::new(nodes, choice);
    let mut random = Random::new(1);
    let mut best = (state.cost, state.choice.clone());
    let trials = TRIALS * nodes.all.len();
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
            state.replace(&undo);
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

/// The partners of some operations.
type Partners = Vec<(usize, Option<(usize, usize)>)>;

/// A choice with its cost.
struct State<'n> {
    nodes: &'n Nodes,
    /// By operation: the results that are its value.
    results: Vec<Vec<usize>>,
    choice: Choice,
    cost: i32,
    /// How often two values are gathered.
    gathered: Table<[Place; 2], u32>,
    /// By operation: how often it is taken out of a pair whose second half it is.
    taken: Vec<u32>,
}

/// A place where cost arises.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Site {
    /// An operation by itself, or the pair whose first half it is.
    Operation(usize),
    Result(usize),
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
        let mut state = Self { nodes, results, choice, cost: 0, gathered: Table::default(), taken: vec![0; count] };
        let sites = (0..count).map(Site::Operation).chain((0..nodes.results.len()).map(Site::Result));
        sites.for_each(|site| state.count(site, 1));
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

    /// An operation beside this one: it uses what is paired with an operand, or is used by what is paired with a user, or is
    /// the next result.
    fn neighbour(&self, node: usize, random: &mut Random) -> Option<usize> {
        let pick = |from: &[usize], random: &mut Random| {
            if from.is_empty() { None } else { Some(from[random.below(from.len())]) }
        };
        match random.below(5) {
            0 | 1 => {
                let operands = &self.nodes.all[node].operands;
                let beside = match operands[random.below(operands.len())].place() {
                    Place::Node(operand) => Place::Node(self.choice.partner(operand)?.0),
                    Place::State(index) if random.below(2) == 0 => Place::State(index + 1),
                    Place::State(index) => Place::State(index.checked_sub(1)?),
                    _ => return None,
                };
                pick(self.nodes.users(beside), random)
            }
            2 | 3 => {
                let (other, _) = self.choice.partner(pick(self.nodes.users(Place::Node(node)), random)?)?;
                let operands = &self.nodes.all[other].operands;
                operands[random.below(operands.len())].node()
            }
            _ => {
                let result = *self.results[node].first()?;
                let next = if random.below(2) == 0 { result + 1 } else { result.checked_sub(1)? };
                self.nodes.results.get(next)?.node()
            }
        }
    }

    /// Whether a new pair's operations need each other.
    fn is_circular(&self, change: Change) -> bool {
        matches!(change, Change::Join(pair) if is_circular(self.nodes, &self.choice, pair))
    }

    /// Makes a change; gives the partners to go back to.
    fn apply(&mut self, change: Change) -> Partners {
        let (Change::Join(pair) | Change::Part(pair)) = change;
        let mut now: Partners = Vec::with_capacity(4);
        for node in pair {
            if let Some((other, _)) = self.choice.partner(node) {
                now.extend([(node, None), (other, None)]);
            }
        }
        if matches!(change, Change::Join(_)) {
            now.extend([(pair[0], Some((pair[1], 0))), (pair[1], Some((pair[0], 1)))]);
        }
        let before = now.iter().map(|&(node, _)| (node, self.choice.partner(node))).collect();
        self.replace(&now);
        before
    }

    /// Gives operations these partners, the last of each, and keeps the account.
    fn replace(&mut self, partners: &Partners) {
        let touched: Vec<usize> = partners.iter().map(|&(node, _)| node).collect();
        // The same before and after: every operation whose partner changes is among them.
        let sites = self.sites(&touched);
        sites.iter().for_each(|&site| self.count(site, -1));
        for &(node, partner) in partners {
            self.choice.partners[node] = partner;
        }
        sites.into_iter().for_each(|site| self.count(site, 1));
    }

    /// Where these operations' partners matter.
    fn sites(&self, nodes: &[usize]) -> Vec<Site> {
        let mut sites = Vec::new();
        for &node in nodes {
            for &user in self.nodes.users(Place::Node(node)).iter().chain([&node]) {
                sites.push(Site::Operation(user));
                sites.extend(self.choice.partner(user).map(|(other, _)| Site::Operation(other)));
            }
            for &result in &self.results[node] {
                sites.extend([Site::Result(result), Site::Result(result + 1)]);
                sites.extend(result.checked_sub(1).map(Site::Result));
            }
        }
        sites.sort_unstable();
        sites.dedup();
        sites
    }

    /// Adds the cost of a site, or takes it away.
    fn count(&mut self, site: Site, by: i32) {
        match site {
            Site::Operation(node) => self.count_operation(node, by),
            Site::Result(result) => self.count_result(result, by),
        }
    }

    fn count_operation(&mut self, index: usize, by: i32) {
        let nodes = self.nodes;
        let node = &nodes.all[index];
        match self.choice.partners[index] {
            _ if node.kind == Kind::Negation => {}
            Some((_, 1)) => {}
            Some((other, _)) => {
                self.cost += by;
                if by > 0 {
                    self.choice.swapped[index] = self.is_better_swapped([index, other]);
                }
                for operands in meeting(nodes, [index, other], self.choice.swapped[index]).operands.map(places) {
                    if !self.choice.is_pair(operands) {
                        self.count_gathered(operands, by);
                    }
                }
            }
            None => {
                self.cost += by;
                node.operands.iter().for_each(|&operand| self.count_taken(operand, by));
            }
        }
    }

    /// Whether fewer operand pairs have to be gathered if the second operation's operands change places.
    fn is_better_swapped(&self, pair: [usize; 2]) -> bool {
        let gathered = |is_swapped: bool| {
            let operands = meeting(self.nodes, pair, is_swapped).operands.map(places);
            operands.iter().filter(|&&operands| !self.choice.is_pair(operands)).count()
        };
        self.nodes.all[pair[0]].kind != Kind::Quotient && gathered(true) < gathered(false)
    }

    fn count_result(&mut self, result: usize, by: i32) {
        let results = &self.nodes.results;
        let Some(&value) = results.get(result) else { return };
        let is_pair = |first: usize| {
            results
                .get(first..first + 2)
                .is_some_and(|pair| pair[0].node().is_some() && self.choice.is_pair(places([pair[0], pair[1]])))
        };
        // A pair of results is written at once, with the first of them.
        if result > 0 && is_pair(result - 1) {
            return;
        }
        self.cost += by;
        if !is_pair(result) {
            self.count_taken(value, by);
        }
    }

    fn count_gathered(&mut self, operands: [Place; 2], by: i32) {
        let count = self.gathered.entry(operands).or_insert(0);
        let before = *count;
        *count = count.checked_add_signed(by).expect("what was counted");
        if before == 0 || *count == 0 {
            self.cost += by;
        }
    }

    /// A use of a number that is, if anywhere, in the second half of a pair.
    fn count_taken(&mut self, operand: Signed, by: i32) {
        let Some(node) = operand.node() else { return };
        if matches!(self.choice.partners[node], Some((_, 1))) {
            let before = self.taken[node];
            self.taken[node] = before.checked_add_signed(by).expect("what was counted");
            if before == 0 || self.taken[node] == 0 {
                self.cost += by;
            }
        }
    }
}
