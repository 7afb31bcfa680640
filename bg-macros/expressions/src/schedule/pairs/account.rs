//! What a choice of pairs costs, kept while it changes.
//!
//! In: the operations, a choice. Out: its cost and the changes that can be made to it and taken back. What counts:
//! operations, values gathered, values taken out of pairs, results written; where zeros keep their signs also terms
//! that get another sign. A change costs or saves only where its operations and their users are.

use std::collections::BTreeMap;
use std::ops::Range;

use rustc_hash::FxHashMap;

use super::Zeros;
use super::choose::{Choice, Needs, meeting};
use super::nodes::{Kind, Nodes, Place, Signed};

/// A change of a choice.
#[derive(Clone, Copy)]
pub(super) enum Change {
    /// Two operations become a pair; pairs that they were in are given up.
    Join([usize; 2]),
    /// A pair is given up.
    Part([usize; 2]),
}

/// New partners of some operations, of each the last one said.
#[derive(Default)]
pub(super) struct Partners {
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
pub(super) struct State<'n> {
    pub nodes: &'n Nodes,
    pub values: Values<'n>,
    /// By operation: the results that are its value.
    pub results: Vec<Vec<usize>>,
    pub choice: Choice,
    pub cost: i32,
    zeros: Zeros,
    needs: Needs,
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
pub(super) struct Values<'n> {
    pub states: Range<usize>,
    /// By operation: its first two operands.
    pub operands: Vec<[usize; 2]>,
    /// By value: the operations that use it. The number after the states has none.
    pub users: Vec<&'n [usize]>,
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
    pub fn meeting(&self, [first, second]: [usize; 2], is_swapped: bool) -> [[usize; 2]; 2] {
        let ([a, b], [c, d]) = (self.operands[first], self.operands[second]);
        if is_swapped { [[a, d], [b, c]] } else { [[a, c], [b, d]] }
    }
}

impl<'n> State<'n> {
    pub fn new(nodes: &'n Nodes, choice: Choice, zeros: Zeros) -> Self {
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
            cost: 0,
            zeros,
            needs: Needs::new(count),
            gathered: FxHashMap::default(),
            taken: vec![0; count],
            sites: Vec::new(),
            named: vec![0; sites + 1],
            changes: 0,
        };
        (0..sites).for_each(|site| state.count(site, 1));
        state
    }

    /// Whether a new pair's operations need each other.
    pub fn is_circular(&mut self, change: Change) -> bool {
        matches!(change, Change::Join(pair) if self.needs.is_circular(self.nodes, &self.choice, pair))
    }

    /// Makes a change; gives the partners to go back to.
    pub fn apply(&mut self, change: Change) -> Partners {
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
    pub fn replace(&mut self, partners: Partners) {
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
                    let cost =
                        |is_swapped: bool, meeting| self.to_gather(meeting) + self.to_turn([node, other], is_swapped);
                    self.choice.swapped[node] = kind != Kind::Quotient && cost(true, swapped) < cost(false, straight);
                }
                self.cost += by * self.to_turn([node, other], self.choice.swapped[node]);
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
    fn to_gather(&self, [first, second]: [[usize; 2]; 2]) -> i32 {
        i32::from(!self.is_pair(first)) + i32::from(!self.is_pair(second))
    }

    /// How many terms of a pair of sums have to get another sign: where it cannot be that of a constant or a product.
    fn to_turn(&self, pair: [usize; 2], is_swapped: bool) -> i32 {
        if self.zeros == Zeros::OfAnySign || self.nodes.all[pair[0]].kind != Kind::Sum {
            return 0;
        }
        let has_free_sign =
            |of: Signed| of.is_constant() || of.node().is_some_and(|node| self.nodes.all[node].kind == Kind::Product);
        let operands = meeting(self.nodes, pair, is_swapped).operands;
        let is_turned = |[a, b]: &[Signed; 2]| a.negative != b.negative && !(has_free_sign(*a) && has_free_sign(*b));
        i32::from(is_turned(&operands[0])) + i32::from(is_turned(&operands[1]))
    }

    /// As [`Choice::is_pair`].
    pub fn is_pair(&self, [first, second]: [usize; 2]) -> bool {
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
