//! From a plan to assignments of one operation each.
//!
//! In: a [`Plan`]. Out: a [`Routine`] whose assignments stand in depth-first order from the results, and the constants
//! that it uses, in a table.
//! Method: long sums and products are combined in pairs, the two operands that are ready first (Huffman 1952, with
//! the depth as weight), which gives the shortest chain of dependent operations.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::plan::{Cell, Plan, Signed};
use super::signs::Signs;
use super::statics::Statics;
use super::table::{Store, number};
use super::{Assignment, Counts, Operand, Operation, Routine};
use crate::expr::{Id, Symbol};

/// Where a value is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
enum Location {
    Static(Id),
    Symbol(Symbol),
    Step(u32),
}

impl Location {
    fn step(self) -> Option<u32> {
        if let Self::Step(step) = self { Some(step) } else { None }
    }
}

/// One operation.
type Step = Operation<Location>;

/// The constants of a program in the order of their numbers.
pub(super) type Constants = Store<Id>;

/// The routine of a plan.
pub(super) fn flatten(statics: &mut Statics, plan: &Plan, name: &str, constants: &mut Constants) -> Routine {
    let order = plan.post_order();
    let signs = Signs::new(plan, &order);
    let places = vec![Location::Static(statics.one); plan.cells.len()];
    let mut lowering = Lowering { statics, plan, signs, places, steps: Store::default(), depths: Vec::new() };
    for cell in order {
        let place = lowering.cell(cell);
        lowering.places[cell as usize] = place;
    }
    let results: Vec<Location> = plan.roots.iter().map(|&root| lowering.wanted(root)).collect();
    let steps = lowering.steps;
    number_steps(lowering.statics, &steps, &results, name, constants)
}

struct Lowering<'l, 'p> {
    statics: &'l mut Statics<'p>,
    plan: &'l Plan,
    signs: Signs,
    places: Vec<Location>,
    steps: Store<Step>,
    depths: Vec<u32>,
}

impl Lowering<'_, '_> {
    fn cell(&mut self, cell: u32) -> Location {
        let plan = self.plan;
        match &plan.cells[cell] {
            Cell::Static(id) => Location::Static(*id),
            Cell::Symbol(symbol) => Location::Symbol(*symbol),
            Cell::Sum(terms) => self.sum(cell, terms),
            Cell::Product(factors) => self.product(cell, factors),
            Cell::Call(function, arguments) => {
                let arguments = arguments.iter().map(|&argument| self.wanted(argument)).collect();
                self.step(Step::Call(*function, arguments))
            }
            Cell::Select { switch, negative, positive } => {
                let (negative, positive) = (self.wanted(*negative), self.wanted(*positive));
                self.step(Step::Select { switch: *switch, negative, positive })
            }
        }
    }

    /// The place of an operand with its true sign.
    fn wanted(&mut self, operand: Signed) -> Location {
        let place = self.places[operand.cell as usize];
        if !self.signs.of(operand) {
            return place;
        }
        match place {
            Location::Static(id) => Location::Static(self.statics.pool.neg(id)),
            _ => self.step(Step::Negate(place)),
        }
    }

    fn sum(&mut self, cell: u32, terms: &[Signed]) -> Location {
        let turned = self.signs.negative[cell as usize];
        let mut items: Vec<(bool, Location)> =
            terms.iter().map(|&term| (self.signs.of(term) ^ turned, self.places[term.cell as usize])).collect();
        if items.iter().all(|item| item.0)
            && let Some(item) = items.iter_mut().find(|item| matches!(item.1, Location::Static(_)))
            && let Location::Static(id) = item.1
        {
            *item = (false, Location::Static(self.statics.pool.neg(id)));
        }
        let (negative, place) = self.combine(items, |left, right| match (left.0, right.0) {
            (false, true) => (false, Step::Subtract(left.1, right.1)),
            (true, false) => (false, Step::Subtract(right.1, left.1)),
            (negative, _) => (negative, Step::Add(left.1, right.1)),
        });
        debug_assert!(!negative, "a sum has its terms' sign");
        place
    }

    fn product(&mut self, cell: u32, factors: &[(u32, i32)]) -> Location {
        let mut negative = self.signs.negative[cell as usize];
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for &(factor, exponent) in factors {
            negative ^= exponent % 2 != 0 && self.signs.negative[factor as usize];
            let side = if exponent > 0 { &mut above } else { &mut below };
            side.extend((0..exponent.unsigned_abs()).map(|_| (false, self.places[factor as usize])));
        }
        if negative
            && let Some(item) =
                above.iter_mut().find(|item: &&mut (bool, Location)| matches!(item.1, Location::Static(_)))
            && let Location::Static(id) = item.1
        {
            item.1 = Location::Static(self.statics.pool.neg(id));
        }
        if above.is_empty() {
            above.push((false, Location::Static(self.statics.one)));
        }
        let multiply = |left: (bool, Location), right: (bool, Location)| (false, Step::Multiply(left.1, right.1));
        let (_, dividend) = self.combine(above, multiply);
        if below.is_empty() {
            return dividend;
        }
        let (_, divisor) = self.combine(below, multiply);
        self.step(Step::Divide(dividend, divisor))
    }

    /// Combines items in pairs, the two that are ready first.
    fn combine(
        &mut self,
        items: Vec<(bool, Location)>,
        join: impl Fn((bool, Location), (bool, Location)) -> (bool, Step),
    ) -> (bool, Location) {
        let mut queue = BinaryHeap::with_capacity(items.len());
        for item in items {
            queue.push(Reverse((self.depth(item.1), queue.len(), item)));
        }
        let mut next = queue.len();
        loop {
            let Some(Reverse((_, _, first))) = queue.pop() else { return (false, Location::Static(self.statics.one)) };
            let Some(Reverse((_, _, second))) = queue.pop() else { return first };
            let (negative, step) = join(first, second);
            let place = self.step(step);
            queue.push(Reverse((self.depth(place), next, (negative, place))));
            next += 1;
        }
    }

    fn depth(&self, place: Location) -> u32 {
        place.step().map_or(0, |step| self.depths[step as usize])
    }

    fn step(&mut self, step: Step) -> Location {
        let key = match step {
            Step::Add(left, right) => Step::Add(left.min(right), left.max(right)),
            Step::Multiply(left, right) => Step::Multiply(left.min(right), left.max(right)),
            ref other => other.clone(),
        };
        let depth = step.operands().into_iter().map(|operand| self.depth(operand)).max().unwrap_or(0);
        let index = self.steps.intern_as(key, step);
        if self.depths.len() < self.steps.len() {
            self.depths.push(depth + 1);
        }
        Location::Step(index)
    }
}

/// The steps under the results as assignments, in depth-first order.
fn number_steps(
    statics: &Statics,
    steps: &Store<Step>,
    results: &[Location],
    name: &str,
    constants: &mut Constants,
) -> Routine {
    let mut targets: Vec<Option<u32>> = vec![None; steps.len()];
    let mut assignments = Vec::new();
    let order = steps.post_order(results.iter().copied().filter_map(Location::step), |step, visit| {
        step.operands().into_iter().filter_map(Location::step).for_each(visit);
    });
    for step in order {
        let operation = steps[step].map(|place| operand(statics, constants, &targets, place));
        let target = number(assignments.len());
        targets[step as usize] = Some(target);
        assignments.push(Assignment { target, operation });
    }
    let results = results.iter().map(|&place| operand(statics, constants, &targets, place)).collect();
    let counts = Counts::of(&assignments);
    Routine { name: name.to_owned(), assignments, results, counts }
}

fn operand(statics: &Statics, constants: &mut Constants, targets: &[Option<u32>], place: Location) -> Operand {
    match place {
        Location::Static(id) => {
            statics.pool.as_number(id).map_or_else(|| Operand::Constant(constants.intern(id)), Operand::Number)
        }
        Location::Symbol(symbol) => Operand::Symbol(symbol),
        Location::Step(step) => Operand::Temporary(targets[step as usize].expect("operands are assigned first")),
    }
}
