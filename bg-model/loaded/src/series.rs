//! The Taylor series of the rates, order by order.
//!
//! In: the routine of the rates. Out: [`SeriesCode`], whose operations are those of generated code: what does not
//! change is evaluated once; at each order what changes has the coefficient of that order, and products, quotients and
//! functions read those of lower orders from a work table.
//!
//! Method: at an order after the first a product is its inner sum, which needs lower orders only and is made for all
//! products side by side, and two products with the values at the start; so what is between quotients and functions is
//! a program of sums and products, the same for all orders. [`Stage`]s are such programs, one for the first order and
//! one for the others, with the quotients and functions that come after them.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use bg_compiler::expr::{Function, Symbol};
use bg_compiler::program::pairs::Step;
use bg_compiler::program::series::places as places_in_table;
use bg_compiler::program::{Assignment, Changes, Operand as Of, Operation, Routine, SeriesSize, series_size};
use bg_model::scalar::Scalar;
use bg_model::series::{
    Flat, abs, acos, asin, atan2, cos, exp, inner_products, ln, power, powf, quotient, sin, sqrt, tan, tanh,
};
use bg_native::{Operand, Program};

use crate::code::{BackEnd, Code, Places, Row};

/// The series of a routine. Its values stand in one row: what is read, what does not change, then the [`Known`] parts
/// of products, then what the stages give.
#[derive(Debug)]
pub struct SeriesCode {
    pub size: SeriesSize,
    /// Time, what iterations find and inputs, in the first places.
    read: Vec<Symbol>,
    /// What does not change, in the places after these.
    still: Code,
    /// How many of its results there are, and where what is known of products begins.
    known: Known,
    stages: Vec<Stage>,
    /// Where the rates stand, with the unknowns of iterations; the factors of products stand after them.
    rates: Range<usize>,
    /// How many places the row has.
    places: usize,
}

/// Where what is known of products before an order stands: the inner sums, then the factors' values at the start.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// The place of the first inner sum.
    first: usize,
    /// How many products there are, with those that fill up vectors.
    products: usize,
}

/// Sums and products, and what comes after them.
#[derive(Debug)]
struct Stage {
    /// For the values at the start.
    start: Code,
    /// For the coefficients of all other orders.
    order: Code,
    /// Where its results stand, side by side.
    at: usize,
    recursions: Vec<Recursion>,
}

/// A quotient or a function, which reads its own coefficients of lower orders.
#[derive(Clone, Copy, Debug)]
struct Recursion {
    kind: Kind,
    /// Its place in the work table.
    at: usize,
    /// Where its arguments stand; the second is the first where it has one only.
    arguments: [usize; 2],
    to: usize,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Quotient,
    /// A function, and whether its second argument changes.
    Call(Function, bool),
}

/// What a series is expanded from.
pub struct Expansion<'a, S: Scalar> {
    pub t: S,
    pub h: S,
    pub negative: &'a [S::Switch],
    /// How many states there are; the results after them are of the unknowns of iterations.
    pub states: usize,
    /// What iterations find at the start.
    pub found: Vec<S>,
}

/// The row of values of a series of one model, and those of its programs.
#[derive(Debug)]
pub struct SeriesRow<S: Scalar> {
    values: Vec<S>,
    still: Row<S>,
    stages: Vec<[Row<S>; 2]>,
}

impl SeriesCode {
    /// The series of the rates; `is_twice` where iterations find something.
    pub fn of(routine: &Routine, is_twice: bool) -> Self {
        let steps: Vec<Step> = routine.assignments.iter().cloned().map(Step::Single).collect();
        let changes = Changes::of(&steps);
        let (moving, still): (Vec<&Assignment>, Vec<&Assignment>) =
            routine.assignments.iter().partition(|of| changes.temporary(of.target));
        Writer::new(&changes, &moving).series(routine, &still, series_size(routine, is_twice))
    }
}

impl SeriesCode {
    /// Whether it reads what iterations find.
    pub fn reads_found(&self) -> bool {
        self.read.iter().any(|symbol| matches!(symbol, Symbol::Found(_)))
    }

    /// All programs of it.
    pub fn codes(&self) -> impl Iterator<Item = &Code> {
        [&self.still].into_iter().chain(self.stages.iter().flat_map(|stage| [&stage.start, &stage.order]))
    }

    /// The row of a model with these constants.
    pub fn row<S: Scalar>(&self, constants: &[S], back_end: BackEnd) -> SeriesRow<S> {
        let row = |code: &Code| code.row(constants, back_end);
        SeriesRow {
            values: vec![S::from_f64(0.0); self.places],
            still: row(&self.still),
            stages: self.stages.iter().map(|stage| [row(&stage.start), row(&stage.order)]).collect(),
        }
    }

    /// Writes the coefficients of all orders after the first, of each order all states. `input` gives the inputs, and
    /// their slopes, at the start.
    pub fn expand<S: Scalar>(
        &self,
        of: Expansion<'_, S>,
        row: &mut SeriesRow<S>,
        input: impl Fn(Symbol) -> S,
        rows: &mut [S],
        series: &mut [S],
    ) {
        let Expansion { t, h, negative, states, mut found } = of;
        let zero = S::from_f64(0.0);
        let (first, products) = (self.known.first, self.known.products);
        let still_values = &mut row.values[self.read.len()..first];
        self.still.evaluate(&mut row.still, &[], &input, negative, still_values);
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
            inner_products(&rows, k, &mut row.values[first..first + products]);
            let order = |row: &mut SeriesRow<S>, rows: &mut Flat<'_, S>, found: &[S]| {
                for (value, &symbol) in row.values.iter_mut().zip(&self.read) {
                    *value = match symbol {
                        Symbol::Time => t,
                        Symbol::Found(index) => found[index as usize],
                        symbol => input(symbol),
                    };
                }
                self.order(k, x, row, rows, negative);
            };
            if k > 0 && !found.is_empty() {
                found.fill(zero);
                order(row, &mut rows, &found);
                found.copy_from_slice(&row.values[self.rates.clone()][states..]);
                order(row, &mut rows, &found);
            } else {
                order(row, &mut rows, &found);
            }
            if k == 0 {
                row.values[first + products..][..2 * products].copy_from_slice(&rows[0][..2 * products]);
            }
            let part = if k == 0 { h } else { h / S::from_f64((k + 1) as f64) };
            let rates = &row.values[self.rates.clone()];
            next[..states].iter_mut().zip(rates).for_each(|(to, &rate)| *to = rate * part);
        }
    }

    /// All stages at order `k`: rates, and the factors of products for later orders.
    fn order<S: Scalar>(
        &self,
        k: usize,
        x: &[S],
        SeriesRow { values, stages, .. }: &mut SeriesRow<S>,
        rows: &mut Flat<'_, S>,
        negative: &[S::Switch],
    ) {
        for (stage, [start, order]) in self.stages.iter().zip(stages) {
            let (code, row) = if k == 0 { (&stage.start, start) } else { (&stage.order, order) };
            let (read, results) = values.split_at_mut(stage.at);
            code.evaluate_listed(row, x, read, negative, &mut results[..code.results()]);
            for of in &stage.recursions {
                values[of.to] = of.coefficient(rows, k, of.arguments.map(|place| values[place]));
            }
        }
        let factors = 2 * self.known.products;
        rows[k][..factors].copy_from_slice(&values[self.rates.end..][..factors]);
    }
}

impl Recursion {
    /// The coefficient of order `k`, from those of the arguments.
    fn coefficient<S: Scalar>(&self, rows: &mut Flat<'_, S>, k: usize, [a, b]: [S; 2]) -> S {
        let at = self.at;
        match self.kind {
            Kind::Quotient => quotient(rows, k, at, a, b),
            Kind::Call(Function::Sqrt, _) => sqrt(rows, k, at, a),
            Kind::Call(Function::Sin, _) => sin(rows, k, at, a),
            Kind::Call(Function::Cos, _) => cos(rows, k, at, a),
            Kind::Call(Function::Tan, _) => tan(rows, k, at, a),
            Kind::Call(Function::Asin, _) => asin(rows, k, at, a),
            Kind::Call(Function::Acos, _) => acos(rows, k, at, a),
            Kind::Call(Function::Exp, _) => exp(rows, k, at, a),
            Kind::Call(Function::Ln, _) => ln(rows, k, at, a),
            Kind::Call(Function::Tanh, _) => tanh(rows, k, at, a),
            Kind::Call(Function::Abs, _) => abs(rows, k, at, a),
            Kind::Call(Function::Atan2, _) => atan2(rows, k, at, a, b),
            Kind::Call(Function::Pow, true) => power(rows, k, at, a, b),
            Kind::Call(Function::Pow, false) => powf(rows, k, at, a, b),
        }
    }
}

/// What is written down of a routine.
struct Writer<'a> {
    changes: &'a Changes,
    moving: &'a [&'a Assignment],
    /// From which stage on the value of what changes is there.
    there: HashMap<u32, usize>,
    /// The last stage, which gives the rates and the factors of products.
    last: usize,
    /// The numbers of products, by their targets.
    products: HashMap<u32, usize>,
    /// Where values stand in the row.
    row: HashMap<u32, usize>,
    read: Vec<Symbol>,
    known: Known,
}

/// What a stage gives.
#[derive(Clone, Copy)]
enum Given {
    /// A coefficient: of what does not change zero but at the start.
    Coefficient(Of),
    /// A number at each order.
    Number(Of),
}

/// A program while it is written.
#[derive(Default)]
struct Written {
    operations: Vec<Operation<Operand>>,
    values: HashMap<u32, Operand>,
    places: Places,
}

impl Written {
    fn push(&mut self, operation: Operation<Operand>) -> Operand {
        self.operations.push(operation);
        Operand::Value(small(self.operations.len() - 1))
    }
}

impl<'a> Writer<'a> {
    fn new(changes: &'a Changes, moving: &'a [&'a Assignment]) -> Self {
        let mut writer = Self {
            changes,
            moving,
            there: HashMap::new(),
            last: 0,
            products: HashMap::new(),
            row: HashMap::new(),
            read: Vec::new(),
            known: Known { first: 0, products: 0 },
        };
        for of in moving {
            let there = writer.stage(&of.operation) + usize::from(writer.is_recursion(&of.operation));
            writer.there.insert(of.target, there);
            writer.last = writer.last.max(there);
            if changes.is_product(&of.operation) {
                writer.products.insert(of.target, writer.products.len());
            }
        }
        writer
    }

    /// Whether it reads its own coefficients of lower orders.
    fn is_recursion(&self, operation: &Operation) -> bool {
        match operation {
            Operation::Divide(_, divisor) => self.changes.operand(divisor),
            Operation::Call(..) => true,
            _ => false,
        }
    }

    /// From which stage on an operand is there.
    fn of_operand(&self, operand: &Of) -> usize {
        if let Of::Temporary(index) = operand { self.there.get(index).copied().unwrap_or(0) } else { 0 }
    }

    /// In which stage an operation is made.
    fn stage(&self, operation: &Operation) -> usize {
        operation.operands().iter().map(|operand| self.of_operand(operand)).max().unwrap_or(0)
    }

    /// The products in their order, their factors in pairs.
    fn factors(&self) -> impl Iterator<Item = [Of; 2]> {
        let products = self.moving.iter().filter(|of| self.products.contains_key(&of.target));
        products.map(|of| <[Of; 2]>::try_from(of.operation.operands()).expect("a product has two factors"))
    }

    fn series(mut self, routine: &Routine, still: &[&Assignment], size: SeriesSize) -> SeriesCode {
        let operands = self.moving.iter().flat_map(|of| of.operation.operands()).chain(routine.results.iter().copied());
        let operands: Vec<Of> = operands.collect();
        for operand in &operands {
            if let Of::Symbol(symbol) = *operand
                && !matches!(symbol, Symbol::State(_))
                && !self.read.contains(&symbol)
            {
                self.read.push(symbol);
            }
        }
        let still = self.still(still, &operands);
        self.known = Known { first: self.read.len() + still.results(), products: size.products };
        let mut places = self.known.first + 3 * size.products;
        let mut table = 2 * size.products;
        let stages: Vec<Stage> =
            (0..=self.last).map(|stage| self.written(stage, &routine.results, &mut places, &mut table)).collect();
        let first = stages.last().map_or(0, |stage| stage.at);
        let rates = first..first + routine.results.len();
        SeriesCode { size, read: self.read, still, known: self.known, stages, rates, places }
    }

    /// What does not change, of which these operands are read. Its results stand after what is read.
    fn still(&mut self, still: &[&Assignment], operands: &[Of]) -> Code {
        let mut written = Written::default();
        for of in still {
            let operation = of.operation.map(|operand| match operand {
                Of::Temporary(index) => written.values[&index],
                other => written.places.of(other),
            });
            let value = written.push(operation);
            written.values.insert(of.target, value);
        }
        let mut results = Vec::new();
        for operand in operands {
            if let Of::Temporary(index) = *operand
                && let Some(&value) = written.values.get(&index)
                && !self.row.contains_key(&index)
            {
                self.row.insert(index, self.read.len() + results.len());
                results.push(value);
            }
        }
        let reads = written.places.symbols.len();
        written.places.code(Program { operations: written.operations, results, ..Program::default() }, reads)
    }

    /// A stage; `places` are those of the row that are taken, `table` those of the work table.
    fn written(&mut self, stage: usize, results: &[Of], places: &mut usize, table: &mut usize) -> Stage {
        let at = *places;
        let own: Vec<&Assignment> =
            self.moving.iter().copied().filter(|of| self.stage(&of.operation) == stage).collect();
        let mut given: Vec<Given> = Vec::new();
        let mut recursions = Vec::new();
        if stage == self.last {
            let [left, right] = [0, 1].map(|side| {
                let filled = self.factors().map(move |factors| factors[side]).chain(std::iter::repeat(Of::Number(0.0)));
                filled.take(self.known.products).collect::<Vec<Of>>()
            });
            given.extend(results.iter().chain(&left).chain(&right).map(|&of| Given::Coefficient(of)));
        } else {
            given.extend(self.later(&own, stage, results).into_iter().map(|of| Given::Coefficient(Of::Temporary(of))));
        }
        let kept = given.len();
        for of in own.iter().filter(|of| self.is_recursion(&of.operation)) {
            let operands = of.operation.operands();
            let is_second_changing = operands.get(1).is_some_and(|second| self.changes.operand(second));
            let kind = match of.operation {
                Operation::Call(function, _) => Kind::Call(function, is_second_changing),
                _ => Kind::Quotient,
            };
            let first = at + given.len();
            given.push(Given::Coefficient(operands[0]));
            let mut second = first;
            if let Some(&operand) = operands.get(1) {
                second = at + given.len();
                // An exponent that does not change is the number itself at each order.
                let is_exponent = matches!(kind, Kind::Call(Function::Pow, false));
                given.push(if is_exponent { Given::Number(operand) } else { Given::Coefficient(operand) });
            }
            recursions.push((of.target, Recursion { kind, at: *table, arguments: [first, second], to: 0 }));
            *table += match kind {
                Kind::Quotient => 2,
                Kind::Call(function, _) => places_in_table(function, matches!(kind, Kind::Call(Function::Pow, false))),
            };
        }
        let [start, order] = [true, false].map(|is_start| self.program(&own, &given, is_start, at));
        if stage < self.last {
            for (place, of) in (at..).zip(&given[..kept]) {
                if let Given::Coefficient(Of::Temporary(index)) = of {
                    self.row.insert(*index, place);
                }
            }
        }
        *places = at + given.len();
        let recursions = recursions.into_iter().map(|(target, recursion)| {
            let to = *places;
            *places += 1;
            self.row.insert(target, to);
            Recursion { to, ..recursion }
        });
        let recursions = recursions.collect();
        Stage { start, order, at, recursions }
    }

    /// The targets of those operations of a stage that later ones read, or that are results.
    fn later(&self, own: &[&Assignment], stage: usize, results: &[Of]) -> Vec<u32> {
        let users = self.moving.iter().filter(|of| self.stage(&of.operation) > stage);
        let read = users.flat_map(|of| of.operation.operands()).chain(results.iter().copied());
        let read = read.chain(self.factors().flatten());
        let read: HashSet<u32> =
            read.filter_map(|of| if let Of::Temporary(index) = of { Some(index) } else { None }).collect();
        let own = own.iter().filter(|of| !self.is_recursion(&of.operation) && read.contains(&of.target));
        own.map(|of| of.target).collect()
    }

    /// The program of a stage, at the start or at any other order; values that stand in the row below `reads` are read.
    fn program(&self, own: &[&Assignment], given: &[Given], is_start: bool, reads: usize) -> Code {
        let mut written = Written::default();
        for of in own.iter().filter(|of| !self.is_recursion(&of.operation)) {
            let value = self.value(&mut written, of, is_start);
            written.values.insert(of.target, value);
        }
        let results = given.iter().map(|of| match *of {
            Given::Coefficient(operand) if !is_start && !self.changes.operand(&operand) => {
                written.places.of(Of::Number(0.0))
            }
            Given::Coefficient(operand) | Given::Number(operand) => self.operand(&mut written, operand),
        });
        let results = results.collect();
        written.places.code(Program { operations: written.operations, results, ..Program::default() }, reads)
    }

    /// The value of an operation, or its coefficient.
    fn value(&self, written: &mut Written, of: &Assignment, is_start: bool) -> Operand {
        let operands = of.operation.operands();
        let is_moving = |place: usize| is_start || self.changes.operand(&operands[place]);
        let values: Vec<Operand> = operands.iter().map(|&operand| self.operand(written, operand)).collect();
        let operation = match (&of.operation, self.products.get(&of.target)) {
            // What is added and does not change is nothing at other orders.
            (Operation::Add(..) | Operation::Subtract(..), _) if !is_moving(1) => return values[0],
            (Operation::Add(..), _) if !is_moving(0) => return values[1],
            (Operation::Subtract(..), _) if !is_moving(0) => Operation::Negate(values[1]),
            (Operation::Multiply(..), Some(&product)) if !is_start => {
                let Known { first, products } = self.known;
                let [inner, left, right] =
                    [0, 1, 2].map(|part| Operand::Read(small(first + part * products + product)));
                let [a, b] =
                    [(values[0], right), (left, values[1])].map(|(a, b)| written.push(Operation::Multiply(a, b)));
                let ends = written.push(Operation::Add(a, b));
                Operation::Add(inner, ends)
            }
            (Operation::Select { switch, .. }, _) if !is_start => {
                let zero = written.places.of(Of::Number(0.0));
                let [negative, positive] = [0, 1].map(|place| if is_moving(place) { values[place] } else { zero });
                Operation::Select { switch: *switch, negative, positive }
            }
            (operation, _) => {
                let mut values = values.into_iter();
                operation.map(|_| values.next().expect("one for each operand"))
            }
        };
        written.push(operation)
    }

    fn operand(&self, written: &mut Written, operand: Of) -> Operand {
        match operand {
            Of::Temporary(index) => match written.values.get(&index) {
                Some(&value) => value,
                None => Operand::Read(small(self.row[&index])),
            },
            Of::Symbol(symbol) if !matches!(symbol, Symbol::State(_)) => {
                let place = self.read.iter().position(|&read| read == symbol);
                Operand::Read(small(place.expect("all that is read has a place")))
            }
            other => written.places.of(other),
        }
    }
}

fn small(place: usize) -> u32 {
    u32::try_from(place).expect("fewer than 2^32 values")
}
