//! From a plan to assignments of one operation each.
//!
//! In: a [`Plan`]. Out: a [`Routine`] whose assignments stand in depth-first order from the results, and the constants that
//! it uses, in a table.
//! Method: long sums and products are combined in pairs, the two operands that are ready first at first (Huffman 1952, with
//! the depth as weight), which gives the shortest chain of dependent operations.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::graph::number;
use super::plan::{Cell, Plan, Signed};
use super::signs::Signs;
use super::statics::Statics;
use super::table::Table;
use super::{Assignment, Counts, Operand, Operation, Routine};
use crate::expr::{Function, Id, Symbol};

/// Where a value is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
enum Place {
    Static(Id),
    Symbol(Symbol),
    Step(u32),
}

/// One operation.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Step {
    Add(Place, Place),
    Subtract(Place, Place),
    Multiply(Place, Place),
    Divide(Place, Place),
    Negate(Place),
    Call(Function, Vec<Place>),
    Select(u32, Place, Place),
}

/// The constants of a program in the order of their numbers.
#[derive(Debug, Default)]
pub(super) struct Constants {
    /// The constants.
    pub(super) ids: Vec<Id>,
    index: Table<Id, u32>,
}

impl Constants {
    fn operand(&mut self, statics: &Statics, id: Id) -> Operand {
        if let Some(value) = statics.pool.as_number(id) {
            return Operand::Number(value);
        }
        let next = number(self.ids.len());
        let index = *self.index.entry(id).or_insert(next);
        if index == next {
            self.ids.push(id);
        }
        Operand::Constant(index)
    }
}

/// The routine of a plan.
pub(super) fn flatten(statics: &mut Statics, plan: &Plan, name: &str, constants: &mut Constants) -> Routine {
    let order = plan.post_order();
    let signs = Signs::new(plan, &order);
    let places = vec![Place::Static(statics.one); plan.cells.len()];
    let mut lowering =
        Lowering { statics, plan, signs, places, steps: Vec::new(), depths: Vec::new(), index: Table::default() };
    for cell in order {
        let place = lowering.cell(cell);
        lowering.places[cell as usize] = place;
    }
    let results: Vec<Place> = plan.roots.iter().map(|&root| lowering.wanted(root)).collect();
    let steps = lowering.steps;
    number_steps(lowering.statics, &steps, &results, name, constants)
}

struct Lowering<'l, 'p> {
    statics: &'l mut Statics<'p>,
    plan: &'l Plan,
    signs: Signs,
    places: Vec<Place>,
    steps: Vec<Step>,
    depths: Vec<u32>,
    index: Table<Step, u32>,
}

impl Lowering<'_, '_> {
    fn cell(&mut self, cell: u32) -> Place {
        let plan = self.plan;
        match &plan.cells[cell as usize] {
            Cell::Static(id) => Place::Static(*id),
            Cell::Symbol(symbol) => Place::Symbol(*symbol),
            Cell::Sum(terms) => self.sum(cell, terms),
            Cell::Product(factors) => self.product(cell, factors),
            Cell::Call(function, arguments) => {
                let arguments = arguments.iter().map(|&argument| self.wanted(argument)).collect();
                self.step(Step::Call(*function, arguments))
            }
            Cell::Select { switch, negative, positive } => {
                let (negative, positive) = (self.wanted(*negative), self.wanted(*positive));
                self.step(Step::Select(*switch, negative, positive))
            }
        }
    }

    /// The place of an operand with its true sign.
    fn wanted(&mut self, operand: Signed) -> Place {
        let place = self.places[operand.cell as usize];
        if !self.signs.of(operand) {
            return place;
        }
        match place {
            Place::Static(id) => Place::Static(self.statics.pool.neg(id)),
            _ => self.step(Step::Negate(place)),
        }
    }

    fn sum(&mut self, cell: u32, terms: &[Signed]) -> Place {
        let turned = self.signs.negative[cell as usize];
        let mut items: Vec<(bool, Place)> =
            terms.iter().map(|&term| (self.signs.of(term) ^ turned, self.places[term.cell as usize])).collect();
        if items.iter().all(|item| item.0)
            && let Some(item) = items.iter_mut().find(|item| matches!(item.1, Place::Static(_)))
            && let Place::Static(id) = item.1
        {
            *item = (false, Place::Static(self.statics.pool.neg(id)));
        }
        let (negative, place) = self.combine(items, |left, right| match (left.0, right.0) {
            (false, true) => (false, Step::Subtract(left.1, right.1)),
            (true, false) => (false, Step::Subtract(right.1, left.1)),
            (negative, _) => (negative, Step::Add(left.1, right.1)),
        });
        debug_assert!(!negative, "a sum has its terms' sign");
        place
    }

    fn product(&mut self, cell: u32, factors: &[(u32, i32)]) -> Place {
        let mut negative = self.signs.negative[cell as usize];
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for &(factor, exponent) in factors {
            negative ^= exponent % 2 != 0 && self.signs.negative[factor as usize];
            let side = if exponent > 0 { &mut above } else { &mut below };
            side.extend((0..exponent.unsigned_abs()).map(|_| (false, self.places[factor as usize])));
        }
        if negative
            && let Some(item) = above.iter_mut().find(|item: &&mut (bool, Place)| matches!(item.1, Place::Static(_)))
            && let Place::Static(id) = item.1
        {
            item.1 = Place::Static(self.statics.pool.neg(id));
        }
        if above.is_empty() {
            above.push((false, Place::Static(self.statics.one)));
        }
        let multiply = |left: (bool, Place), right: (bool, Place)| (false, Step::Multiply(left.1, right.1));
        let (_, dividend) = self.combine(above, multiply);
        if below.is_empty() {
            return dividend;
        }
        let (_, divisor) = self.combine(below, multiply);
        self.step(Step::Divide(dividend, divisor))
    }

    /// Combines items in pairs, the two that are ready first at first.
    fn combine(
        &mut self,
        items: Vec<(bool, Place)>,
        join: impl Fn((bool, Place), (bool, Place)) -> (bool, Step),
    ) -> (bool, Place) {
        let mut queue = BinaryHeap::with_capacity(items.len());
        for item in items {
            queue.push(Reverse((self.depth(item.1), queue.len(), item)));
        }
        let mut next = queue.len();
        loop {
            let Some(Reverse((_, _, first))) = queue.pop() else { return (false, Place::Static(self.statics.one)) };
            let Some(Reverse((_, _, second))) = queue.pop() else { return first };
            let (negative, step) = join(first, second);
            let place = self.step(step);
            queue.push(Reverse((self.depth(place), next, (negative, place))));
            next += 1;
        }
    }

    fn depth(&self, place: Place) -> u32 {
        if let Place::Step(step) = place { self.depths[step as usize] } else { 0 }
    }

    fn step(&mut self, step: Step) -> Place {
        let key = match step {
            Step::Add(left, right) => Step::Add(left.min(right), left.max(right)),
            Step::Multiply(left, right) => Step::Multiply(left.min(right), left.max(right)),
            ref other => other.clone(),
        };
        if let Some(&known) = self.index.get(&key) {
            return Place::Step(known);
        }
        let mut depth = 0;
        step.operands(|operand| depth = depth.max(self.depth(operand)));
        let index = number(self.steps.len());
        self.steps.push(step);
        self.depths.push(depth + 1);
        self.index.insert(key, index);
        Place::Step(index)
    }
}

impl Step {
    fn operands(&self, mut visit: impl FnMut(Place)) {
        match self {
            Self::Add(left, right)
            | Self::Subtract(left, right)
            | Self::Multiply(left, right)
            | Self::Divide(left, right)
            | Self::Select(_, left, right) => {
                visit(*left);
                visit(*right);
            }
            Self::Negate(operand) => visit(*operand),
            Self::Call(_, operands) => operands.iter().for_each(|&operand| visit(operand)),
        }
    }

    fn operation(&self, mut operand: impl FnMut(Place) -> Operand) -> Operation {
        match self {
            Self::Add(left, right) => Operation::Add(operand(*left), operand(*right)),
            Self::Subtract(left, right) => Operation::Subtract(operand(*left), operand(*right)),
            Self::Multiply(left, right) => Operation::Multiply(operand(*left), operand(*right)),
            Self::Divide(left, right) => Operation::Divide(operand(*left), operand(*right)),
            Self::Negate(only) => Operation::Negate(operand(*only)),
            Self::Call(function, all) => Operation::Call(*function, all.iter().map(|&place| operand(place)).collect()),
            Self::Select(switch, negative, positive) => {
                let (negative, positive) = (operand(*negative), operand(*positive));
                Operation::Select { switch: *switch, negative, positive }
            }
        }
    }
}

/// The steps under the results as assignments, in depth-first order.
fn number_steps(
    statics: &Statics,
    steps: &[Step],
    results: &[Place],
    name: &str,
    constants: &mut Constants,
) -> Routine {
    let mut targets: Vec<Option<u32>> = vec![None; steps.len()];
    let mut assignments = Vec::new();
    let mut pending: Vec<(Place, bool)> = results.iter().rev().map(|&result| (result, false)).collect();
    while let Some((place, finished)) = pending.pop() {
        let Place::Step(step) = place else { continue };
        if targets[step as usize].is_some() {
            continue;
        }
        if finished {
            let operation = steps[step as usize].operation(|place| operand(statics, constants, &targets, place));
            let target = number(assignments.len());
            targets[step as usize] = Some(target);
            assignments.push(Assignment { target, operation });
        } else {
            pending.push((place, true));
            let first = pending.len();
            steps[step as usize].operands(|operand| pending.push((operand, false)));
            pending[first..].reverse();
        }
    }
    let results = results.iter().map(|&place| operand(statics, constants, &targets, place)).collect();
    let counts = Counts::of(&assignments);
    Routine { name: name.to_owned(), assignments, results, counts }
}

fn operand(statics: &Statics, constants: &mut Constants, targets: &[Option<u32>], place: Place) -> Operand {
    match place {
        Place::Static(id) => constants.operand(statics, id),
        Place::Symbol(symbol) => Operand::Symbol(symbol),
        Place::Step(step) => Operand::Temporary(targets[step as usize].expect("operands are assigned first")),
    }
}
