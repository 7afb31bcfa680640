//! What machine code does, step by step, with numbers and with pairs of them.
//!
//! In: a [`Program`]. Out: [`Steps`] with the same results in all bits: its operations, or what
//! [`bg_expressions::schedule::pairs`] makes of them, and an order in which machine code is short.

use std::collections::HashMap;

use bg_expressions::expr::{Function, Symbol};
use bg_expressions::schedule::pairs::{Half, Paired, Search, Step as PairedStep, Value, pair};
use bg_expressions::schedule::{self, Assignment, Counts, Operation, Routine};

use crate::program::{Operand, Pairing, Program};

/// A program in steps. [`Operand::Value`] is the number of a step; an operand that is a pair is one of a step that
/// gives a pair, or the first of two neighbours.
#[derive(Debug, Default)]
pub struct Steps {
    /// Each comes after what it takes.
    pub steps: Vec<Step>,
    /// The results, one after the other.
    pub results: Vec<Given>,
    /// What stands after what is fixed: entries of it, with `true` where the negative is meant.
    pub appended: Vec<(u32, bool)>,
}

/// A step.
#[derive(Debug)]
pub enum Step {
    /// An operation on numbers.
    Number(Operation<Operand>),
    /// A number of a pair: the first or the second.
    Half(Operand, u8),
    /// An operation on pairs: a sum, a difference, a product or a quotient.
    Pair(Operation<Operand>),
    /// A pair of two numbers.
    Gather([Operand; 2]),
    /// A pair with other signs where `true`.
    Turn(Operand, [bool; 2]),
}

/// A result or two.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    Number(Operand),
    Pair(Operand),
}

/// How a pair is made of two numbers.
#[derive(Clone, Copy, Debug)]
pub enum Gathered {
    /// Of numbers of two pairs: each a pair, and which of its numbers.
    OfPairs([(Operand, u8); 2]),
    /// A pair of which one number is another one.
    Replaced { pair: Operand, half: u8, number: Operand },
    /// One number twice.
    Twice(Operand),
    /// Of numbers that stand in their place of no pair.
    Numbers([Operand; 2]),
}

/// Results with the place of the first.
pub type Placed = Vec<(Given, usize)>;

impl Step {
    pub fn operands(&self) -> Vec<Operand> {
        match self {
            Self::Number(operation) | Self::Pair(operation) => operation.operands(),
            Self::Half(of, _) | Self::Turn(of, _) => vec![*of],
            Self::Gather(both) => both.to_vec(),
        }
    }

    /// The steps whose values it takes.
    fn needs(&self) -> Vec<usize> {
        self.operands().into_iter().filter_map(Operand::value).collect()
    }

    fn is_call(&self) -> bool {
        matches!(self, Self::Number(Operation::Call(..)))
    }
}

impl Given {
    pub fn operand(self) -> Operand {
        match self {
            Self::Number(operand) | Self::Pair(operand) => operand,
        }
    }

    /// How many results it is.
    pub fn count(self) -> usize {
        match self {
            Self::Number(_) => 1,
            Self::Pair(_) => 2,
        }
    }
}

impl Steps {
    /// The steps of a program, in pairs where they are sought and pay.
    pub fn of(program: &Program, fixed: usize) -> Self {
        let paired = match program.pairing {
            Pairing::Sought => pair(&routine(program), Search::Short),
            Pairing::None => None,
        };
        paired.map_or_else(|| Self::alone(program), |paired| Writer::new(fixed).steps(&paired))
    }

    /// One step for each operation.
    fn alone(program: &Program) -> Self {
        Self {
            steps: program.operations.iter().cloned().map(Step::Number).collect(),
            results: program.results.iter().copied().map(Given::Number).collect(),
            appended: Vec::new(),
        }
    }

    /// How many needed steps are operations: all but numbers of pairs.
    pub fn operations(&self) -> usize {
        let is_operation = |(step, needed): &(&Step, bool)| *needed && !matches!(step, Step::Half(..));
        self.steps.iter().zip(self.needed()).filter(is_operation).count()
    }

    /// The steps that are needed, in an order in which machine code is short: first the arguments of functions and
    /// their calls, over which it can keep nothing in registers; then each result with what it needs, those first that
    /// are sooner there, and of two operands that one first which takes more registers.
    pub fn order(&self) -> Vec<usize> {
        let (depths, registers) = self.measures();
        let needed = self.needed();
        let mut order =
            Order { steps: &self.steps, registers, is_done: vec![false; self.steps.len()], done: Vec::new() };
        let calls = (0..self.steps.len()).filter(|&of| needed[of] && self.steps[of].is_call());
        calls.for_each(|of| order.enter(of));
        let mut results: Vec<usize> = self.results.iter().filter_map(|given| given.operand().value()).collect();
        results.sort_by_key(|&of| depths[of]);
        results.into_iter().for_each(|of| order.enter(of));
        order.done
    }

    /// The functions that are called: by which steps, with which arguments.
    pub fn calls(&self) -> impl Iterator<Item = (usize, Function, &[Operand])> {
        self.steps.iter().enumerate().filter_map(|(of, step)| match step {
            Step::Number(Operation::Call(function, arguments)) => Some((of, *function, &arguments[..])),
            _ => None,
        })
    }

    /// Of sines and cosines of the same angles each one's other.
    pub fn partners(&self) -> HashMap<usize, usize> {
        let of = |wanted: Function| {
            let calls = self.calls().filter(move |&(_, function, _)| function == wanted);
            calls.map(|(of, _, arguments)| (arguments[0], of))
        };
        let sines: HashMap<Operand, usize> = of(Function::Sin).collect();
        let pairs = of(Function::Cos).filter_map(|(angle, of)| sines.get(&angle).map(|&sine| [(of, sine), (sine, of)]));
        pairs.flatten().collect()
    }

    /// Of each step the results that are its value, and the other results.
    pub fn places(&self) -> (Vec<Placed>, Placed) {
        let (mut of_steps, mut of_inputs) = (vec![Vec::new(); self.steps.len()], Vec::new());
        let mut place = 0;
        for &given in &self.results {
            given.operand().value().map_or(&mut of_inputs, |of| &mut of_steps[of]).push((given, place));
            place += given.count();
        }
        (of_steps, of_inputs)
    }

    /// How the pair of two numbers is made, in one step where one of them stands in its place of another pair already.
    pub fn gathered(&self, both: [Operand; 2]) -> Gathered {
        let [first, second] = both;
        match both.map(|number| self.half_of(number)) {
            [Some(first), Some(second)] => Gathered::OfPairs([first, second]),
            [Some((pair, 0)), None] => Gathered::Replaced { pair, half: 1, number: second },
            [None, Some((pair, 1))] => Gathered::Replaced { pair, half: 0, number: first },
            _ if first == second => Gathered::Twice(first),
            _ => Gathered::Numbers(both),
        }
    }

    /// The pair that a number is of, and which of its numbers it is.
    fn half_of(&self, number: Operand) -> Option<(Operand, u8)> {
        match self.steps[number.value()?] {
            Step::Half(pair, half) => Some((pair, half)),
            _ => None,
        }
    }

    /// Of each step how many steps its value takes one after the other, and how many registers (R. Sethi, J. Ullman,
    /// JACM 1970), as if no value was used twice.
    fn measures(&self) -> (Vec<u32>, Vec<u32>) {
        let (mut depths, mut registers): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        for step in &self.steps {
            let needs = step.needs();
            depths.push(1 + needs.iter().map(|&of| depths[of]).max().unwrap_or(0));
            let mut each: Vec<u32> = needs.iter().map(|&of| registers[of]).collect();
            each.sort_unstable_by(|a, b| b.cmp(a));
            registers.push((0..).zip(each).map(|(before, own)| before + own).max().unwrap_or(1));
        }
        (depths, registers)
    }

    /// Which steps results need.
    fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.steps.len()];
        self.results.iter().filter_map(|given| given.operand().value()).for_each(|of| needed[of] = true);
        for (of, step) in self.steps.iter().enumerate().rev() {
            if needed[of] {
                step.needs().into_iter().for_each(|of| needed[of] = true);
            }
        }
        needed
    }
}

/// Steps in order.
struct Order<'a> {
    steps: &'a [Step],
    registers: Vec<u32>,
    is_done: Vec<bool>,
    done: Vec<usize>,
}

impl Order<'_> {
    /// Enters a step after what it needs. On a stack of its own: programs are deep.
    fn enter(&mut self, of: usize) {
        let mut open = vec![of];
        while let Some(&top) = open.last() {
            let waits = self.steps[top].needs().into_iter().filter(|&of| !self.is_done[of]);
            // Of equal ones the first.
            let first = waits.reduce(|a, b| if self.registers[b] > self.registers[a] { b } else { a });
            match first {
                Some(first) if !self.is_done[top] => open.push(first),
                _ => {
                    open.pop();
                    if !std::mem::replace(&mut self.is_done[top], true) {
                        self.done.push(top);
                    }
                }
            }
        }
    }
}

/// The program as the search for pairs reads it: what is fixed are constants; what else is read has any symbols.
fn routine(program: &Program) -> Routine {
    let operand = |operand: Operand| match operand {
        Operand::Fixed(place) => schedule::Operand::Constant(place),
        Operand::State(place) => schedule::Operand::Symbol(Symbol::State(place)),
        Operand::Read(place) => schedule::Operand::Symbol(Symbol::Input(place)),
        Operand::Value(place) => schedule::Operand::Temporary(place),
    };
    let assignment =
        |(target, operation): (u32, &Operation<Operand>)| Assignment { target, operation: operation.map(operand) };
    let assignments: Vec<Assignment> = (0..).zip(&program.operations).map(assignment).collect();
    let counts = Counts::of(&assignments);
    let results = program.results.iter().copied().map(operand).collect();
    Routine { name: String::new(), assignments, results, counts }
}

/// Paired code becomes steps.
struct Writer {
    steps: Steps,
    /// How many numbers are fixed.
    fixed: usize,
    /// Which step a temporary is.
    numbers: HashMap<u32, Operand>,
    /// What a pair is.
    pairs: Vec<Operand>,
}

impl Writer {
    fn new(fixed: usize) -> Self {
        Self { steps: Steps::default(), fixed, numbers: HashMap::new(), pairs: Vec::new() }
    }

    fn steps(mut self, paired: &Paired) -> Steps {
        let constants = paired.constants.iter().flatten().map(|(constant, is_negative)| match constant {
            schedule::Operand::Constant(place) => (*place, *is_negative),
            other => unreachable!("{other:?} is not fixed"),
        });
        self.steps.appended = constants.collect();
        for step in &paired.steps {
            match step {
                PairedStep::Single(Assignment { target, operation }) => {
                    let operation = operation.map(|operand| self.number(operand));
                    let value = self.write(Step::Number(operation));
                    self.numbers.insert(*target, value);
                }
                PairedStep::Half { target, pair, half } => {
                    let value = self.half(*pair, *half);
                    self.numbers.insert(*target, value);
                }
                PairedStep::Pair(_, value) => {
                    let pair = self.pair(value);
                    self.pairs.push(pair);
                }
            }
        }
        let mut results = &paired.results[..];
        while let [first, rest @ ..] = results {
            let given = match (*first, rest) {
                (Half::In(pair, 0), [Half::In(other, 1), after @ ..]) if *other == pair => {
                    results = after;
                    Given::Pair(self.pairs[pair as usize])
                }
                (half, after) => {
                    results = after;
                    Given::Number(self.any(half))
                }
            };
            self.steps.results.push(given);
        }
        self.steps
    }

    fn write(&mut self, step: Step) -> Operand {
        self.steps.steps.push(step);
        Operand::Value(u32::try_from(self.steps.steps.len() - 1).expect("fewer than 2^32 steps"))
    }

    fn number(&self, operand: schedule::Operand) -> Operand {
        match operand {
            schedule::Operand::Constant(place) => Operand::Fixed(place),
            schedule::Operand::Symbol(Symbol::State(place)) => Operand::State(place),
            schedule::Operand::Symbol(Symbol::Input(place)) => Operand::Read(place),
            schedule::Operand::Temporary(target) => self.numbers[&target],
            other => unreachable!("no operand of a program is {other:?}"),
        }
    }

    fn half(&mut self, pair: u32, half: usize) -> Operand {
        let half = u8::try_from(half).expect("the first or the second");
        self.write(Step::Half(self.pairs[pair as usize], half))
    }

    fn any(&mut self, half: Half) -> Operand {
        match half {
            Half::Of(operand) => self.number(operand),
            Half::In(pair, half) => self.half(pair, half),
        }
    }

    fn pair(&mut self, value: &Value) -> Operand {
        let of = |pair: u32| self.pairs[pair as usize];
        let step = match *value {
            Value::States(first) => return Operand::State(first),
            Value::Constants(index) => {
                let place = self.fixed + 2 * index as usize;
                return Operand::Fixed(u32::try_from(place).expect("fewer than 2^32 constants"));
            }
            Value::Numbers(_) => unreachable!("numbers of a program are fixed"),
            Value::Gather(both) => Step::Gather(both.map(|half| self.any(half))),
            Value::Add(a, b) => Step::Pair(Operation::Add(of(a), of(b))),
            Value::Subtract(a, b) => Step::Pair(Operation::Subtract(of(a), of(b))),
            Value::Multiply(a, b) => Step::Pair(Operation::Multiply(of(a), of(b))),
            Value::Divide(a, b) => Step::Pair(Operation::Divide(of(a), of(b))),
            Value::Turn(a, turn) => Step::Turn(of(a), turn),
        };
        self.write(step)
    }
}
