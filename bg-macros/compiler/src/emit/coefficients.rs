//! The coefficients of a series: the steps of a routine at the start and at an order.
//!
//! In: steps that change. Out: their definitions.

use super::blocks::Chunk;
use super::pairs;
use super::routine::{self, Names};
use crate::expr::Function;
use crate::program::pairs::{Half, Step, Value};
use crate::program::series::places;
use crate::program::{Assignment, Changes, Operand, Operation};

/// The coefficient at an order of what does not change.
const ZERO: &str = "S::from_f64(0.0)";

/// Writes them.
pub(super) struct Writer<'w, 'n> {
    names: &'w Names<'n>,
    changes: &'w Changes,
    /// Whether the order is 0.
    is_start: bool,
    /// The places of products, one for each number: their sums are made in fours.
    pub(super) products: usize,
    /// The products written so far.
    pub(super) product: usize,
    /// The places after those of the products.
    others: usize,
    /// In a loop: where an iteration's places of products begin, and those after the places of all products.
    begins: Option<[String; 2]>,
}

impl<'w, 'n> Writer<'w, 'n> {
    pub(super) fn new<'a>(
        names: &'w Names<'n>,
        changes: &'w Changes,
        is_start: bool,
        steps: impl Iterator<Item = &'a Step>,
    ) -> Self {
        let products = |step: &Step| match step {
            Step::Single(assignment) => usize::from(changes.is_product(&assignment.operation)),
            Step::Half { .. } => 0,
            Step::Pair(_, value) => 2 * usize::from(changes.is_product_of_pairs(value)),
        };
        let products = steps.map(products).sum::<usize>().next_multiple_of(4);
        Self { names, changes, is_start, products, product: 0, others: 0, begins: None }
    }

    /// How many numbers each order takes, after all steps.
    pub(super) fn places(&self) -> usize {
        (2 * self.products + self.others).next_multiple_of(4)
    }

    fn is_changing(&self, operand: &Operand) -> bool {
        self.changes.operand(operand)
    }

    /// The coefficient of an operand.
    fn value(&self, operand: &Operand) -> String {
        if self.is_start || self.is_changing(operand) { routine::operand(operand, self.names) } else { ZERO.to_owned() }
    }

    /// The value of an operand at the start, which is its value at all times if it does not change.
    fn fixed(&self, operand: &Operand) -> String {
        routine::operand(operand, self.names)
    }

    /// The definitions of a group.
    pub(super) fn group(&mut self, group: &[Step]) -> String {
        group.iter().map(|step| self.step(step)).collect()
    }

    /// The definitions of a long routine's part.
    pub(super) fn part(&mut self, part: &mut Chunk) -> String {
        let Some(iterations) = part.iterations() else { return self.singles(&part.assignments) };
        let changes = self.changes.of_loop(&part.first);
        let begins = Some(part.next_columns());
        let mut iteration = Writer { changes: &changes, product: 0, others: 0, begins, ..*self };
        let definitions = iteration.singles(&part.assignments);
        let (product, others) = (iteration.product, iteration.others);
        let places = |from: usize, each: usize| (0..iterations).map(|iteration| from + iteration * each).collect();
        part.column(places(self.product, product));
        part.column(places(2 * self.products + self.others, others));
        self.product += iterations * product;
        self.others += iterations * others;
        definitions
    }

    fn singles(&mut self, assignments: &[Assignment]) -> String {
        assignments.iter().map(|assignment| self.single(assignment)).collect()
    }

    fn single(&mut self, of: &Assignment) -> String {
        routine::definition(of.target, &self.operation(&of.operation))
    }

    fn step(&mut self, step: &Step) -> String {
        match step {
            Step::Single(of) => self.single(of),
            Step::Half { .. } => pairs::step(step, self.names),
            Step::Pair(index, value) => pairs::definition(*index, &self.pair_value(value)),
        }
    }

    fn operation(&mut self, operation: &Operation) -> String {
        match operation {
            Operation::Multiply(a, b) if self.changes.is_product(operation) => self.product(a, b),
            Operation::Divide(a, b) if self.is_changing(b) => {
                let at = self.reserve(2);
                let (a, b) = (self.value(a), self.value(b));
                format!("::bg_model::series::quotient(rows, k, {at}, {a}, {b})")
            }
            Operation::Call(function, arguments) => self.call(*function, arguments),
            // In the loop only what changes is left of a sum.
            Operation::Add(a, b) if !self.is_start && !self.is_changing(a) => self.value(b),
            Operation::Add(a, b) | Operation::Subtract(a, b) if !self.is_start && !self.is_changing(b) => self.value(a),
            Operation::Subtract(a, b) if !self.is_start && !self.is_changing(a) => {
                let b = self.value(b);
                format!("-{b}")
            }
            Operation::Multiply(..) | Operation::Divide(..) => {
                routine::operation(operation, self.names, &|operand| self.fixed(operand))
            }
            _ => routine::operation(operation, self.names, &|operand| self.value(operand)),
        }
    }

    fn product(&mut self, a: &Operand, b: &Operand) -> String {
        let (a, b) = (self.value(a), self.value(b));
        self.product_of("product", 1, &a, &b)
    }

    /// A product of so many numbers, by the functions of this name.
    fn product_of(&mut self, name: &str, numbers: usize, a: &str, b: &str) -> String {
        let at = self.product;
        self.product += numbers;
        let [left, right] = [at, self.products + at].map(|at| match &self.begins {
            Some([products, _]) => format!("{products} + {at}"),
            None => at.to_string(),
        });
        if self.is_start {
            format!("first_{name}(rows, {left}, {right}, {a}, {b})")
        } else {
            format!("next_{name}(inner, rows, k, {left}, {a}, {b})")
        }
    }

    /// The first of `count` places.
    fn reserve(&mut self, count: usize) -> String {
        let at = self.others;
        self.others += count;
        match &self.begins {
            Some([_, others]) => format!("{others} + {at}"),
            None => (2 * self.products + at).to_string(),
        }
    }

    fn call(&mut self, function: Function, arguments: &[Operand]) -> String {
        let is_fixed_power = function == Function::Pow && !self.is_changing(&arguments[1]);
        let name = if is_fixed_power { "powf" } else { method_of_series(function) };
        let places = places(function, is_fixed_power);
        let at = self.reserve(places);
        let first = self.value(&arguments[0]);
        let second = arguments.get(1).map(|second| {
            let second = if is_fixed_power { self.fixed(second) } else { self.value(second) };
            format!(", {second}")
        });
        format!("::bg_model::series::{name}(rows, k, {at}, {first}{})", second.unwrap_or_default())
    }

    /// The coefficient of a number.
    pub(super) fn half(&self, half: &Half) -> String {
        match half {
            Half::Of(operand) => self.value(operand),
            Half::In(..) if self.is_start || self.changes.half(half) => pairs::half(half, self.names),
            Half::In(..) => ZERO.to_owned(),
        }
    }

    /// The coefficients of a pair that changes.
    fn pair_value(&mut self, value: &Value) -> String {
        let is_changing = |index: &u32| self.is_start || self.changes.pair(*index);
        match value {
            Value::Gather([first, second]) => pairs::new(&self.half(first), &self.half(second)),
            Value::Multiply(a, b) if self.changes.is_product_of_pairs(value) => {
                self.product_of("products", 2, &pairs::name(*a), &pairs::name(*b))
            }
            Value::Divide(a, b) if self.changes.pair(*b) => {
                let [first, second] = [0, 1].map(|half| {
                    let at = self.reserve(2);
                    let [a, b] = [a, b].map(|index| self.half(&Half::In(*index, half)));
                    format!("::bg_model::series::quotient(rows, k, {at}, {a}, {b})")
                });
                pairs::new(&first, &second)
            }
            // In the loop only what changes is left of a sum.
            Value::Add(a, b) if !is_changing(a) => pairs::name(*b),
            Value::Add(a, b) | Value::Subtract(a, b) if !is_changing(b) => pairs::name(*a),
            Value::Subtract(a, b) if !is_changing(a) => pairs::value(&Value::Turn(*b, [true; 2]), self.names),
            _ => pairs::value(value, self.names),
        }
    }
}

/// The function of a series.
fn method_of_series(function: Function) -> &'static str {
    match function {
        Function::Pow => "power",
        other => other.name(),
    }
}
