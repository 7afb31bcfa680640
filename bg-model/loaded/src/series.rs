//! The Taylor series of the rates, order by order.
//!
//! In: the routine of the rates. Out: [`SeriesCode`], whose steps are those of generated code: what does not change is
//! evaluated once; at each order what changes has the coefficient of that order, and products, quotients and functions
//! read those of lower orders from a work table.

use std::collections::HashMap;

use bg_compiler::expr::{Function, Symbol};
use bg_compiler::program::pairs::Step as PairStep;
use bg_compiler::program::series::places;
use bg_compiler::program::{Changes, Operand, Operation, Routine, SeriesSize, series_size};
use bg_model::scalar::Scalar;
use bg_model::series::{
    Flat, abs, acos, asin, atan2, cos, exp, inner_product, ln, power, powf, quotient, sin, sqrt, tan, tanh,
};

use crate::code::{of_one, of_two};

/// Where a value stands.
#[derive(Clone, Copy, Debug)]
struct Value {
    place: usize,
    /// Whether it changes with time: then the place has its coefficient, else its value.
    changes: bool,
}

/// An operation that changes.
#[derive(Clone, Copy, Debug)]
enum Moving {
    Add(Value, Value),
    Subtract(Value, Value),
    /// Of two values that change; its number among the products.
    Product(Value, Value, usize),
    /// Of one that does, by one that does not.
    Multiply(Value, Value),
    Times(Value, f64),
    /// By what changes, from this place of the work table on.
    Quotient(Value, Value, usize),
    Divide(Value, Value),
    Negate(Value),
    Call(Function, [Value; 2], usize),
    Select(u32, Value, Value),
}

/// An operation that does not change, with its place.
#[derive(Clone, Debug)]
struct Still {
    operation: Operation<usize>,
    to: usize,
}

/// The series of a routine.
#[derive(Clone, Debug)]
pub struct SeriesCode {
    pub size: SeriesSize,
    numbers: Vec<(f64, usize)>,
    constants: Vec<(u32, usize)>,
    /// Inputs, read once.
    inputs: Vec<(Symbol, usize)>,
    /// States, time and what iterations find, read at each order.
    read: Vec<(Symbol, usize)>,
    still: Vec<Still>,
    moving: Vec<(Moving, usize)>,
    results: Vec<Value>,
    places: usize,
}

/// What a series is expanded from.
pub struct Expansion<'a, S: Scalar> {
    pub constants: &'a [S],
    pub t: S,
    pub h: S,
    pub negative: &'a [S::Switch],
    /// How many states there are; the results after them are of the unknowns of iterations.
    pub states: usize,
    /// What iterations find at the start.
    pub found: Vec<S>,
}

impl SeriesCode {
    /// The series of the rates; `is_twice` where iterations find something.
    pub fn of(routine: &Routine, is_twice: bool) -> Self {
        let steps: Vec<PairStep> = routine.assignments.iter().cloned().map(PairStep::Single).collect();
        let changes = Changes::of(&steps);
        let size = series_size(routine, is_twice);
        let (mut product, mut other) = (0, 2 * size.products);
        let mut known = Known { changes: &changes, places: HashMap::new(), entered: Vec::new() };
        let (mut still, mut moving) = (Vec::new(), Vec::new());
        for of in &routine.assignments {
            let values: Vec<Value> = of.operation.operands().into_iter().map(|operand| known.value(operand)).collect();
            let to = known.value(Operand::Temporary(of.target));
            if !to.changes {
                let mut values = values.iter();
                let operation = of.operation.map(|_| values.next().expect("one for each operand").place);
                still.push(Still { operation, to: to.place });
                continue;
            }
            let number = |operand: &Operand| if let Operand::Number(value) = operand { Some(*value) } else { None };
            let step = match &of.operation {
                Operation::Add(..) => Moving::Add(values[0], values[1]),
                Operation::Subtract(..) => Moving::Subtract(values[0], values[1]),
                Operation::Multiply(..) if changes.is_product(&of.operation) => {
                    product += 1;
                    Moving::Product(values[0], values[1], product - 1)
                }
                Operation::Multiply(a, b) => match (number(a), number(b)) {
                    (Some(factor), _) => Moving::Times(values[1], factor),
                    (_, Some(factor)) => Moving::Times(values[0], factor),
                    _ => Moving::Multiply(values[0], values[1]),
                },
                Operation::Divide(..) if values[1].changes => {
                    other += 2;
                    Moving::Quotient(values[0], values[1], other - 2)
                }
                Operation::Divide(..) => Moving::Divide(values[0], values[1]),
                Operation::Negate(_) => Moving::Negate(values[0]),
                Operation::Call(function, _) => {
                    let second = values.get(1).copied().unwrap_or(values[0]);
                    let count = places(*function, *function == Function::Pow && !second.changes);
                    other += count;
                    Moving::Call(*function, [values[0], second], other - count)
                }
                Operation::Select { switch, .. } => Moving::Select(*switch, values[0], values[1]),
            };
            moving.push((step, to.place));
        }
        let results = routine.results.iter().map(|&result| known.value(result)).collect();
        let places = known.places.len();
        let mut code = Self {
            size,
            numbers: Vec::new(),
            constants: Vec::new(),
            inputs: Vec::new(),
            read: Vec::new(),
            still,
            moving,
            results,
            places,
        };
        for (operand, place) in known.entered {
            match operand {
                Operand::Number(value) => code.numbers.push((value, place)),
                Operand::Constant(index) => code.constants.push((index, place)),
                Operand::Symbol(symbol @ Symbol::Input(_)) => code.inputs.push((symbol, place)),
                Operand::Symbol(symbol) => code.read.push((symbol, place)),
                Operand::Temporary(_) => {}
            }
        }
        code
    }

    /// Whether it reads what iterations find.
    pub fn reads_found(&self) -> bool {
        self.read.iter().any(|(symbol, _)| matches!(symbol, Symbol::Found(_)))
    }

    /// Writes the coefficients of all orders after the first, of each order all states. `input` gives the inputs, and
    /// their slopes, at the start.
    pub fn expand<S: Scalar>(
        &self,
        of: Expansion<'_, S>,
        input: impl Fn(Symbol) -> S,
        rows: &mut [S],
        series: &mut [S],
    ) {
        let Expansion { constants, t, h, negative, states, mut found } = of;
        let zero = S::from_f64(0.0);
        let mut values = vec![zero; self.places];
        self.numbers.iter().for_each(|&(number, place)| values[place] = S::from_f64(number));
        self.constants.iter().for_each(|&(index, place)| values[place] = constants[index as usize]);
        self.inputs.iter().for_each(|&(symbol, place)| values[place] = input(symbol));
        for Still { operation, to } in &self.still {
            values[*to] = evaluated(operation, &values, negative);
        }
        let mut rows = Flat { numbers: rows, width: self.size.width };
        let orders = series.len() / states.max(1);
        for k in 0..orders.saturating_sub(1) {
            let (known, next) = series.split_at_mut((k + 1) * states);
            let x = &known[k * states..];
            let t = match k {
                0 => t,
                1 => h,
                _ => zero,
            };
            let mut order = |found: &[S]| {
                for &(symbol, place) in &self.read {
                    values[place] = match symbol {
                        Symbol::State(index) => x[index as usize],
                        Symbol::Time => t,
                        Symbol::Found(index) => found[index as usize],
                        symbol => input(symbol),
                    };
                }
                self.order(k, &mut values, &mut rows, negative);
                self.results.iter().map(|&of| at_order(&values, of, k)).collect::<Vec<S>>()
            };
            let mut rates = if k > 0 && !found.is_empty() {
                found.fill(zero);
                let coefficients = order(&found);
                found.copy_from_slice(&coefficients[states..]);
                order(&found)
            } else {
                order(&found)
            };
            rates.truncate(states);
            let part = if k == 0 { h } else { h / S::from_f64((k + 1) as f64) };
            next.iter_mut().zip(rates).for_each(|(to, rate)| *to = rate * part);
        }
    }

    /// What changes, at order `k`.
    fn order<S: Scalar>(&self, k: usize, values: &mut [S], rows: &mut Flat<'_, S>, negative: &[S::Switch]) {
        let products = self.size.products;
        for &(step, to) in &self.moving {
            let of = |value: Value| at_order(values, value, k);
            let fixed = |value: Value| values[value.place];
            values[to] = match step {
                Moving::Add(a, b) if k > 0 && !a.changes => of(b),
                Moving::Add(a, b) | Moving::Subtract(a, b) if k > 0 && !b.changes => of(a),
                Moving::Subtract(a, b) if k > 0 && !a.changes => -of(b),
                Moving::Add(a, b) => of(a) + of(b),
                Moving::Subtract(a, b) => of(a) - of(b),
                Moving::Product(a, b, at) => {
                    let (a, b) = (of(a), of(b));
                    (rows[k][at], rows[k][products + at]) = (a, b);
                    if k == 0 {
                        a * b
                    } else {
                        let inner = inner_product(&*rows, k, at, products + at);
                        inner + (a * rows[0][products + at] + rows[0][at] * b)
                    }
                }
                Moving::Multiply(a, b) => fixed(a) * fixed(b),
                Moving::Times(a, factor) => fixed(a).times(factor),
                Moving::Quotient(a, b, at) => quotient(rows, k, at, of(a), of(b)),
                Moving::Divide(a, b) => fixed(a) / fixed(b),
                Moving::Negate(a) => -of(a),
                Moving::Call(function, [a, b], at) => {
                    // An exponent that does not change is the number itself at each order.
                    let is_exponent = function == Function::Pow && !b.changes;
                    call(function, rows, k, at, [of(a), if is_exponent { fixed(b) } else { of(b) }], b.changes)
                }
                Moving::Select(switch, below, above) => S::select(negative[switch as usize], of(below), of(above)),
            };
        }
    }
}

/// The coefficient of order `k` of a value: of one that does not change zero but for the first.
fn at_order<S: Scalar>(values: &[S], value: Value, k: usize) -> S {
    if k == 0 || value.changes { values[value.place] } else { S::from_f64(0.0) }
}

fn call<S: Scalar>(
    function: Function,
    rows: &mut Flat<'_, S>,
    k: usize,
    at: usize,
    [a, b]: [S; 2],
    is_second_changing: bool,
) -> S {
    match function {
        Function::Sqrt => sqrt(rows, k, at, a),
        Function::Sin => sin(rows, k, at, a),
        Function::Cos => cos(rows, k, at, a),
        Function::Tan => tan(rows, k, at, a),
        Function::Asin => asin(rows, k, at, a),
        Function::Acos => acos(rows, k, at, a),
        Function::Exp => exp(rows, k, at, a),
        Function::Ln => ln(rows, k, at, a),
        Function::Tanh => tanh(rows, k, at, a),
        Function::Abs => abs(rows, k, at, a),
        Function::Atan2 => atan2(rows, k, at, a, b),
        Function::Pow if is_second_changing => power(rows, k, at, a, b),
        Function::Pow => powf(rows, k, at, a, b),
    }
}

fn evaluated<S: Scalar>(operation: &Operation<usize>, values: &[S], negative: &[S::Switch]) -> S {
    match *operation {
        Operation::Add(a, b) => values[a] + values[b],
        Operation::Subtract(a, b) => values[a] - values[b],
        Operation::Multiply(a, b) => values[a] * values[b],
        Operation::Divide(a, b) => values[a] / values[b],
        Operation::Negate(a) => -values[a],
        Operation::Call(function, ref arguments) => {
            let a = values[arguments[0]];
            match arguments.get(1) {
                Some(&b) => of_two(function)(a, values[b]),
                None => of_one(function)(a),
            }
        }
        Operation::Select { switch, negative: below, positive } => {
            S::select(negative[switch as usize], values[below], values[positive])
        }
    }
}

/// Where operands stand.
struct Known<'a> {
    changes: &'a Changes,
    places: HashMap<(u8, u64), usize>,
    entered: Vec<(Operand, usize)>,
}

impl Known<'_> {
    fn value(&mut self, operand: Operand) -> Value {
        let key = match operand {
            Operand::Number(value) => (0, value.to_bits()),
            Operand::Constant(index) => (1, u64::from(index)),
            Operand::Temporary(index) => (2, u64::from(index)),
            Operand::Symbol(symbol) => {
                let known = self.entered.iter().position(|(entered, _)| *entered == Operand::Symbol(symbol));
                (3, known.unwrap_or(self.entered.len()) as u64)
            }
        };
        let next = self.places.len();
        let place = *self.places.entry(key).or_insert(next);
        if place == next {
            self.entered.push((operand, place));
        }
        Value { place, changes: self.changes.operand(&operand) }
    }
}
