//! Which operations go together.
//!
//! In: the operations. Out: pairs of them, of the same kind and independent of each other, so that few operations
//! remain. Method: pairs grow from neighbours among the states and the results along uses and operands, the one that
//! saves most at the time first.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::nodes::{Kind, Nodes, Place, Signed};

/// What an operation costs, in the units of the gains.
const OPERATION: i32 = 4;
/// What a pair of operands that may still become a pair is taken to cost.
const OPEN: i32 = 1;

/// The pairs chosen.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// By operation: the other one of its pair, and the half that it is itself.
    pub partners: Vec<Option<(usize, usize)>>,
    /// By the first operation of a pair: whether the second one's operands change places.
    pub swapped: Vec<bool>,
}

/// Two operations that are done as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub nodes: [usize; 2],
    /// The operands that meet.
    pub operands: [[Signed; 2]; 2],
}

/// What it takes to have two values as a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    /// They are one.
    Ready,
    /// They are not, but may become one.
    Open,
    /// They have to be gathered.
    Gathered,
}

impl Choice {
    /// The other operation of this one's pair, and the half that this one is.
    pub fn partner(&self, node: usize) -> Option<(usize, usize)> {
        self.partners[node]
    }

    /// All pairs.
    pub fn pairs<'a>(&'a self, nodes: &'a Nodes) -> impl Iterator<Item = Pair> + 'a {
        (0..self.partners.len()).filter_map(|node| self.pair_at(nodes, node))
    }

    /// The pair whose first operation this is.
    pub fn pair_at(&self, nodes: &Nodes, node: usize) -> Option<Pair> {
        match self.partners[node] {
            Some((other, 0)) => Some(meeting(nodes, [node, other], self.swapped[node])),
            _ => None,
        }
    }

    /// Whether these two values, in this order, are a pair.
    pub fn is_pair(&self, [first, second]: [Place; 2]) -> bool {
        match (first, second) {
            (Place::Constant, Place::Constant) => true,
            (Place::State(first), Place::State(second)) => second == first + 1,
            (Place::Node(first), Place::Node(second)) => self.partners[first] == Some((second, 0)),
            _ => false,
        }
    }
}

/// The operands that meet in a pair of operations.
pub(super) fn meeting(nodes: &Nodes, pair: [usize; 2], is_swapped: bool) -> Pair {
    let [first, second] = pair.map(|node| &nodes.all[node].operands);
    let other = |at: usize| second[if is_swapped { 1 - at } else { at }];
    Pair { nodes: pair, operands: [[first[0], other(0)], [first[1], other(1)]] }
}

/// The places of two operands.
pub(super) fn places(operands: [Signed; 2]) -> [Place; 2] {
    operands.map(Signed::place)
}

/// Whether an operation may be half of a pair with another one of its kind.
pub(super) fn is_pairable(kind: Kind) -> bool {
    matches!(kind, Kind::Sum | Kind::Product | Kind::Quotient)
}

/// Which operations need which, with the pairs chosen.
pub(super) struct Needs {
    /// By operation: the last search that has seen it.
    seen: Vec<u32>,
    searches: u32,
    pending: Vec<usize>,
}

impl Needs {
    pub fn new(operations: usize) -> Self {
        Self { seen: vec![0; operations], searches: 0, pending: Vec::new() }
    }

    /// Whether one of two operations needs the other one's value. The two themselves do not count as a pair.
    pub fn is_circular(&mut self, nodes: &Nodes, choice: &Choice, [first, second]: [usize; 2]) -> bool {
        self.needs(nodes, choice, first, second) || self.needs(nodes, choice, second, first)
    }

    fn needs(&mut self, nodes: &Nodes, choice: &Choice, node: usize, wanted: usize) -> bool {
        self.searches += 1;
        self.pending.clear();
        self.open(nodes, node);
        while let Some(node) = self.pending.pop() {
            if node == wanted {
                return true;
            }
            self.open(nodes, node);
            if let Some((other, _)) = choice.partners[node] {
                self.open(nodes, other);
            }
        }
        false
    }

    /// The operations whose values this one uses become pending, once in a search.
    fn open(&mut self, nodes: &Nodes, node: usize) {
        for operand in &nodes.all[node].operands {
            if let Some(operand) = operand.node()
                && self.seen[operand] != self.searches
            {
                self.seen[operand] = self.searches;
                self.pending.push(operand);
            }
        }
    }
}

/// Pairs of these operations.
pub(super) fn choose(nodes: &Nodes) -> Choice {
    let mut growth = Growth::new(nodes);
    growth.seed();
    growth.grow();
    growth.choice
}

struct Growth<'n> {
    nodes: &'n Nodes,
    choice: Choice,
    /// The operand pairs that the chosen pairs gather, each with their number.
    gathered: BTreeMap<[Place; 2], usize>,
    /// Pairs that might be chosen, by what they would gain when they were found.
    candidates: BinaryHeap<(i32, Reverse<[usize; 2]>)>,
    needs: Needs,
}

impl<'n> Growth<'n> {
    fn new(nodes: &'n Nodes) -> Self {
        let count = nodes.all.len();
        let choice = Choice { partners: vec![None; count], swapped: vec![false; count] };
        Self { nodes, choice, gathered: BTreeMap::new(), candidates: BinaryHeap::new(), needs: Needs::new(count) }
    }

    /// The users of neighbouring states, and neighbouring results.
    fn seed(&mut self) {
        for index in self.nodes.states() {
            self.propose_users([Place::State(index), Place::State(index + 1)]);
        }
        for pair in self.nodes.results.windows(2) {
            self.propose_operands([pair[0], pair[1]]);
        }
    }

    fn propose_users(&mut self, [first, second]: [Place; 2]) {
        let nodes = self.nodes;
        for &first in nodes.users(first) {
            nodes.users(second).iter().for_each(|&second| self.propose([first, second]));
        }
    }

    fn propose_operands(&mut self, [first, second]: [Signed; 2]) {
        if let (Some(first), Some(second)) = (first.node(), second.node()) {
            self.propose([first, second]);
        }
    }

    fn propose(&mut self, pair: [usize; 2]) {
        if self.may_pair(pair) {
            self.candidates.push((self.gain(pair).0, Reverse(pair)));
        }
    }

    fn may_pair(&self, [first, second]: [usize; 2]) -> bool {
        let kinds = [first, second].map(|node| self.nodes.all[node].kind);
        let is_free = [first, second].iter().all(|&node| self.choice.partners[node].is_none());
        first != second && is_free && kinds[0] == kinds[1] && is_pairable(kinds[0])
    }

    fn form(&self, pair: [Place; 2]) -> Form {
        if self.choice.is_pair(pair) {
            return Form::Ready;
        }
        match pair {
            [Place::Node(first), Place::Node(second)] if self.may_pair([first, second]) => Form::Open,
            _ => Form::Gathered,
        }
    }

    /// What a pair would save now, and whether its second operation's operands change places.
    fn gain(&self, pair: [usize; 2]) -> (i32, bool) {
        let cost = |is_swapped: bool| {
            let meeting = meeting(self.nodes, pair, is_swapped).operands.map(places);
            meeting
                .iter()
                .map(|&operands| match self.form(operands) {
                    Form::Ready => 0,
                    Form::Open => OPEN,
                    Form::Gathered if self.gathered.contains_key(&operands) => 0,
                    Form::Gathered => OPERATION,
                })
                .sum::<i32>()
        };
        let is_ordered = self.nodes.all[pair[0]].kind == Kind::Quotient;
        let (straight, swapped) = (cost(false), if is_ordered { i32::MAX } else { cost(true) });
        let values = pair.map(Place::Node);
        let ungathered = if self.gathered.contains_key(&values) { OPERATION } else { 0 };
        let stored = if self.is_stored(pair) { OPERATION } else { 0 };
        (OPERATION + ungathered + stored - straight.min(swapped), swapped < straight)
    }

    /// Whether the two values are neighbouring results.
    fn is_stored(&self, pair: [usize; 2]) -> bool {
        self.nodes.results.windows(2).any(|results| [results[0].node(), results[1].node()] == pair.map(Some))
    }

    /// Chooses candidates until none gains.
    fn grow(&mut self) {
        while let Some((gain, Reverse(pair))) = self.candidates.pop() {
            if gain <= 0 {
                return;
            }
            if !self.may_pair(pair) {
                continue;
            }
            let (now, is_swapped) = self.gain(pair);
            if now < gain {
                self.candidates.push((now, Reverse(pair)));
            } else if !self.needs.is_circular(self.nodes, &self.choice, pair) {
                self.join(pair, is_swapped);
            }
        }
    }

    fn join(&mut self, pair: [usize; 2], is_swapped: bool) {
        let values = pair.map(Place::Node);
        for half in 0..2 {
            self.choice.partners[pair[half]] = Some((pair[1 - half], half));
        }
        self.choice.swapped[pair[0]] = is_swapped;
        self.gathered.remove(&values);
        let meeting = meeting(self.nodes, pair, is_swapped).operands;
        for operands in meeting {
            if !self.choice.is_pair(places(operands)) {
                *self.gathered.entry(places(operands)).or_default() += 1;
            }
        }
        for operands in meeting {
            self.propose_operands(operands);
            self.propose_operands([operands[1], operands[0]]);
        }
        self.propose_users(values);
    }
}
