//! Straight-line programs as an interpreter reads them: operations in batches of one kind.
//!
//! In: a [`Routine`] of the compiler. Out: [`Code`], whose values stand in one row of places: numbers and constants,
//! what is read anew for each evaluation, then what operations give. What a batch reads stands before what it writes,
//! so an evaluation is a walk along the row; a batch is one loop without a choice in it.
//!
//! Each operation and its operands are the routine's, so the values have the bits of generated code in any scalar.

use std::collections::HashMap;
use std::mem::{Discriminant, discriminant};

use bg_compiler::expr::{Function, Symbol};
use bg_compiler::program::{Operand, Operation, Routine};
use bg_model::scalar::Scalar;

/// A place in the row of values.
type Place = u32;

/// A program, whatever the scalar.
#[derive(Clone, Debug, Default)]
pub struct Code {
    /// What stands in the first places as long as the model is the same.
    fixed: Vec<Fixed>,
    /// What is read anew, in the places after these.
    read: Vec<Symbol>,
    /// The operations.
    batches: Vec<Batch>,
    /// Whether it reads what iterations find.
    reads_found: bool,
    /// The places of the results.
    results: Vec<Place>,
    /// How many places there are.
    places: usize,
}

/// What does not change between evaluations.
#[derive(Clone, Copy, Debug)]
enum Fixed {
    Number(f64),
    /// An entry of the table of constants.
    Constant(u32),
}

/// Operations of one kind, whose results stand side by side.
#[derive(Clone, Debug)]
enum Batch {
    Add(Vec<[Place; 2]>),
    Subtract(Vec<[Place; 2]>),
    Multiply(Vec<[Place; 2]>),
    /// Times a number.
    Times(Vec<(Place, f64)>),
    Divide(Vec<[Place; 2]>),
    Negate(Vec<Place>),
    Unary(Function, Vec<Place>),
    Binary(Function, Vec<[Place; 2]>),
    /// The switch, the place where it is negative, that where it is not.
    Select(Vec<(u32, [Place; 2])>),
}

/// The row of values of one program of one model.
#[derive(Clone, Debug)]
pub struct Row<S> {
    values: Vec<S>,
}

impl Code {
    /// The program of a routine.
    #[must_use]
    pub fn of(routine: &Routine) -> Self {
        let mut code = Self::default();
        let mut places = Places::default();
        let operands = routine.assignments.iter().flat_map(|of| of.operation.operands());
        for operand in operands.chain(routine.results.iter().copied()) {
            places.enter(operand, &mut code);
        }
        let mut next = places.begin(&code);
        for batch in batches(routine) {
            let operations: Vec<&Operation> = batch.iter().map(|&of| &routine.assignments[of].operation).collect();
            code.batches.push(Batch::of(&operations, &|operand| places.of(&code, operand)));
            for of in batch {
                places.temporaries.insert(routine.assignments[of].target, next);
                next += 1;
            }
        }
        code.places = next as usize;
        code.reads_found = code.read.iter().any(|symbol| matches!(symbol, Symbol::Found(_)));
        code.results = routine.results.iter().map(|&result| places.of(&code, result)).collect();
        code
    }

    /// How many results it has.
    #[must_use]
    pub fn results(&self) -> usize {
        self.results.len()
    }

    /// Whether it reads what iterations find.
    #[must_use]
    pub fn reads_found(&self) -> bool {
        self.reads_found
    }

    /// The row of a model with these constants.
    #[must_use]
    pub fn row<S: Scalar>(&self, constants: &[S]) -> Row<S> {
        let fixed = self.fixed.iter().map(|fixed| match *fixed {
            Fixed::Number(value) => S::from_f64(value),
            Fixed::Constant(index) => constants[index as usize],
        });
        let mut values: Vec<S> = fixed.collect();
        values.resize(self.places, S::from_f64(0.0));
        Row { values }
    }

    /// Evaluates it, and writes its first results, as many as `to` has places.
    pub fn evaluate<S: Scalar>(
        &self,
        row: &mut Row<S>,
        symbol: impl Fn(Symbol) -> S,
        negative: &[S::Switch],
        to: &mut [S],
    ) {
        let values = &mut row.values[..];
        let mut at = self.fixed.len();
        for &read in &self.read {
            values[at] = symbol(read);
            at += 1;
        }
        for batch in &self.batches {
            at += batch.evaluate(values, at, negative);
        }
        to.iter_mut().zip(&self.results).for_each(|(to, &place)| *to = values[place as usize]);
    }

    /// The results of one evaluation by itself, with these constants.
    pub fn once<S: Scalar>(&self, constants: &[S], symbol: impl Fn(Symbol) -> S) -> Vec<S> {
        let mut results = vec![S::from_f64(0.0); self.results()];
        self.evaluate(&mut self.row(constants), symbol, &[], &mut results);
        results
    }
}

/// Which operations are one batch.
type Kind = (Discriminant<Operation>, bool, Option<Function>);

fn kind(of: &Operation) -> Kind {
    let is_times = matches!(of, Operation::Multiply(a, b) if number(a).or(number(b)).is_some());
    let function = if let Operation::Call(function, _) = of { Some(*function) } else { None };
    (discriminant(of), is_times, function)
}

fn number(of: &Operand) -> Option<f64> {
    if let Operand::Number(value) = of { Some(*value) } else { None }
}

/// The assignments in batches: of what is ready, each time all of the kind that there is most of.
fn batches(routine: &Routine) -> Vec<Vec<usize>> {
    let assignments = &routine.assignments;
    let by_target: HashMap<u32, usize> =
        assignments.iter().enumerate().map(|(index, assignment)| (assignment.target, index)).collect();
    let mut users = vec![Vec::new(); assignments.len()];
    let mut missing = vec![0_usize; assignments.len()];
    for (index, assignment) in assignments.iter().enumerate() {
        for operand in assignment.operation.operands() {
            if let Operand::Temporary(temporary) = operand {
                users[by_target[&temporary]].push(index);
                missing[index] += 1;
            }
        }
    }
    let mut ready: Vec<(Kind, Vec<usize>)> = Vec::new();
    let enter = |ready: &mut Vec<(Kind, Vec<usize>)>, index: usize| {
        let kind = kind(&assignments[index].operation);
        match ready.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, of)) => of.push(index),
            None => ready.push((kind, vec![index])),
        }
    };
    (0..assignments.len()).filter(|&index| missing[index] == 0).for_each(|index| enter(&mut ready, index));
    let mut batches = Vec::new();
    while let Some((_, most)) = ready.iter_mut().max_by_key(|(_, of)| of.len()).filter(|(_, of)| !of.is_empty()) {
        let mut batch = std::mem::take(most);
        batch.sort_unstable();
        for &user in batch.iter().flat_map(|&of| &users[of]) {
            missing[user] -= 1;
            if missing[user] == 0 {
                enter(&mut ready, user);
            }
        }
        batches.push(batch);
    }
    batches
}

/// Where operands stand.
#[derive(Default)]
struct Places {
    numbers: HashMap<u64, Place>,
    constants: HashMap<u32, Place>,
    symbols: HashMap<Symbol, Place>,
    temporaries: HashMap<u32, Place>,
}

impl Places {
    /// Gives a place to what is no temporary.
    fn enter(&mut self, operand: Operand, code: &mut Code) {
        let [next_fixed, next_read] = [code.fixed.len(), code.read.len()].map(place);
        match operand {
            Operand::Number(value) => {
                self.numbers.entry(value.to_bits()).or_insert_with(|| {
                    code.fixed.push(Fixed::Number(value));
                    next_fixed
                });
            }
            Operand::Constant(index) => {
                self.constants.entry(index).or_insert_with(|| {
                    code.fixed.push(Fixed::Constant(index));
                    next_fixed
                });
            }
            Operand::Symbol(symbol) => {
                self.symbols.entry(symbol).or_insert_with(|| {
                    code.read.push(symbol);
                    next_read
                });
            }
            Operand::Temporary(_) => {}
        }
    }

    /// The first place after these.
    fn begin(&self, code: &Code) -> Place {
        place(code.fixed.len() + code.read.len())
    }

    /// The place of an operand.
    fn of(&self, code: &Code, operand: Operand) -> Place {
        match operand {
            Operand::Number(value) => self.numbers[&value.to_bits()],
            Operand::Constant(index) => self.constants[&index],
            Operand::Symbol(symbol) => self.symbols[&symbol] + place(code.fixed.len()),
            Operand::Temporary(index) => self.temporaries[&index],
        }
    }
}

fn place(index: usize) -> Place {
    Place::try_from(index).expect("fewer than 2^32 values")
}

impl Batch {
    /// Operations of one kind.
    fn of(operations: &[&Operation], place: &dyn Fn(Operand) -> Place) -> Self {
        let places = || operations.iter().map(|of| of.operands().into_iter().map(place).collect::<Vec<_>>());
        let one = || places().map(|places| places[0]).collect();
        let two = || places().map(|places| [places[0], places[1]]).collect();
        match operations[0] {
            Operation::Add(..) => Self::Add(two()),
            Operation::Subtract(..) => Self::Subtract(two()),
            Operation::Multiply(a, b) if number(a).or(number(b)).is_some() => {
                let times = |of: &&Operation| match of {
                    Operation::Multiply(Operand::Number(factor), other)
                    | Operation::Multiply(other, Operand::Number(factor)) => (place(*other), *factor),
                    _ => unreachable!("a batch has operations of one kind"),
                };
                Self::Times(operations.iter().map(times).collect())
            }
            Operation::Multiply(..) => Self::Multiply(two()),
            Operation::Divide(..) => Self::Divide(two()),
            Operation::Negate(_) => Self::Negate(one()),
            Operation::Call(function, _) if function.arity() == 2 => Self::Binary(*function, two()),
            Operation::Call(function, _) => Self::Unary(*function, one()),
            Operation::Select { .. } => {
                let choice = |of: &&Operation| match of {
                    Operation::Select { switch, negative, positive } => (*switch, [place(*negative), place(*positive)]),
                    _ => unreachable!("a batch has operations of one kind"),
                };
                Self::Select(operations.iter().map(choice).collect())
            }
        }
    }

    /// Writes its values from the place `at` on; gives how many.
    fn evaluate<S: Scalar>(&self, values: &mut [S], at: usize, negative: &[S::Switch]) -> usize {
        let (known, next) = values.split_at_mut(at);
        let known = &*known;
        match self {
            Self::Add(of) => binary(known, next, of, |a, b| a + b),
            Self::Subtract(of) => binary(known, next, of, |a, b| a - b),
            Self::Multiply(of) => binary(known, next, of, |a, b| a * b),
            Self::Divide(of) => binary(known, next, of, |a, b| a / b),
            Self::Times(of) => each(next, of, |&(place, factor)| known[place as usize].times(factor)),
            Self::Negate(of) => each(next, of, |&place| -known[place as usize]),
            Self::Unary(function, of) => {
                let function = of_one(*function);
                each(next, of, |&place| function(known[place as usize]))
            }
            Self::Binary(function, of) => binary(known, next, of, of_two(*function)),
            Self::Select(of) => each(next, of, |&(switch, [below, above])| {
                S::select(negative[switch as usize], known[below as usize], known[above as usize])
            }),
        }
    }
}

fn binary<S: Scalar>(known: &[S], next: &mut [S], of: &[[Place; 2]], value: impl Fn(S, S) -> S) -> usize {
    each(next, of, |&[a, b]| value(known[a as usize], known[b as usize]))
}

fn each<T, S>(next: &mut [S], of: &[T], value: impl Fn(&T) -> S) -> usize {
    next.iter_mut().zip(of).for_each(|(to, of)| *to = value(of));
    of.len()
}

/// A function of one argument.
pub fn of_one<S: Scalar>(function: Function) -> fn(S) -> S {
    match function {
        Function::Sqrt => S::sqrt,
        Function::Sin => S::sin,
        Function::Cos => S::cos,
        Function::Tan => S::tan,
        Function::Asin => S::asin,
        Function::Acos => S::acos,
        Function::Exp => S::exp,
        Function::Ln => S::ln,
        Function::Tanh => S::tanh,
        Function::Abs => S::abs,
        Function::Atan2 | Function::Pow => unreachable!("{function:?} has two arguments"),
    }
}

/// A function of two arguments.
pub fn of_two<S: Scalar>(function: Function) -> fn(S, S) -> S {
    match function {
        Function::Atan2 => S::atan2,
        Function::Pow => S::powf,
        _ => unreachable!("{function:?} has one argument"),
    }
}
