//! Random programs, alone and twice in the axes of a plane, by a function and one operation after the other.

use bg_expressions::expr;
use bg_expressions::schedule::Operation;
use bg_model::scalar::Scalar;
use bg_native::{Function, Inputs, Operand, Pairing, Program};
use fastrand::Rng;

const LENGTHS: [usize; 4] = [5, 4, 3, 2];
const FUNCTIONS: [expr::Function; 12] = [
    expr::Function::Sqrt,
    expr::Function::Sin,
    expr::Function::Cos,
    expr::Function::Tan,
    expr::Function::Asin,
    expr::Function::Acos,
    expr::Function::Atan2,
    expr::Function::Exp,
    expr::Function::Ln,
    expr::Function::Tanh,
    expr::Function::Abs,
    expr::Function::Pow,
];

fn operand(random: &mut Rng, known: usize) -> Operand {
    let mut place = |below: usize| u32::try_from(random.usize(..below)).expect("few places");
    match place(8) {
        0 => Operand::Fixed(place(LENGTHS[0])),
        1 => Operand::State(place(LENGTHS[1])),
        2 => Operand::Read(place(LENGTHS[2])),
        _ if known > 0 => Operand::Value(place(known)),
        _ => Operand::State(0),
    }
}

fn operation(random: &mut Rng, known: usize) -> Operation<Operand> {
    let (a, b) = (operand(random, known), operand(random, known));
    match random.u32(..8) {
        0 => Operation::Add(a, b),
        1 => Operation::Subtract(a, b),
        2 | 3 => Operation::Multiply(a, b),
        4 => Operation::Divide(a, b),
        5 => Operation::Negate(a),
        6 => Operation::Select { switch: random.u32(..2), negative: a, positive: b },
        _ => {
            let function = FUNCTIONS[random.usize(..FUNCTIONS.len())];
            Operation::Call(function, [a, b][..function.arity()].to_vec())
        }
    }
}

fn program(random: &mut Rng) -> Program {
    let count = random.usize(..120);
    let operations = (0..count).map(|known| operation(random, known)).collect();
    let results = (0..random.usize(1..9)).map(|_| operand(random, count)).collect();
    Program { operations, results, pairing: Pairing::None }
}

/// A program twice, in the two axes of a plane: what is read stands side by side, some operations mix both axes, some
/// are others in the second.
fn in_a_plane(random: &mut Rng) -> Program {
    let one = program(random);
    let mut axis = |operand: Operand, axis: u32| {
        let axis = if random.u32(..40) == 0 { 1 - axis } else { axis };
        match operand {
            Operand::Fixed(place) => Operand::Fixed(2 * place + axis),
            Operand::State(place) => Operand::State(2 * place + axis),
            Operand::Read(place) => Operand::Read(2 * place + axis),
            // Only what comes before both.
            Operand::Value(place) => Operand::Value(2 * place + axis),
        }
    };
    let mut operations = Vec::new();
    for operation in &one.operations {
        operations.push(operation.map(|operand| axis(operand, 0)));
        operations.push(match operation.map(|operand| axis(operand, 1)) {
            Operation::Add(a, b) if operations.len() % 7 == 0 => Operation::Subtract(b, a),
            Operation::Multiply(a, b) => Operation::Multiply(b, a),
            other => other,
        });
    }
    let results = one.results.iter().flat_map(|&result| [0, 1].map(|of| axis(result, of))).collect();
    Program { operations, results, pairing: Pairing::Sought }
}

/// How many numbers are fixed.
fn fixed_of(program: &Program) -> usize {
    let operands = program.operations.iter().flat_map(Operation::operands).chain(program.results.iter().copied());
    let places = operands.filter_map(|operand| match operand {
        Operand::Fixed(place) => Some(place as usize + 1),
        _ => None,
    });
    places.max().unwrap_or(0)
}

/// One operation after the other.
fn evaluated(program: &Program, inputs: Inputs<'_>) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::new();
    for operation in &program.operations {
        let of = |operand: Operand| value(operand, inputs, &values);
        let value = match operation {
            &Operation::Add(a, b) => of(a) + of(b),
            &Operation::Subtract(a, b) => of(a) - of(b),
            &Operation::Multiply(a, b) => of(a) * of(b),
            &Operation::Divide(a, b) => of(a) / of(b),
            &Operation::Negate(a) => -of(a),
            &Operation::Select { switch, negative, positive } => {
                if inputs.negative[switch as usize] {
                    of(negative)
                } else {
                    of(positive)
                }
            }
            Operation::Call(function, arguments) => {
                called(*function, &arguments.iter().copied().map(of).collect::<Vec<_>>())
            }
        };
        values.push(value);
    }
    program.results.iter().map(|&result| value(result, inputs, &values)).collect()
}

fn value(operand: Operand, inputs: Inputs<'_>, values: &[f64]) -> f64 {
    match operand {
        Operand::Fixed(place) => inputs.fixed[place as usize],
        Operand::State(place) => inputs.states[place as usize],
        Operand::Read(place) => inputs.read[place as usize],
        Operand::Value(place) => values[place as usize],
    }
}

fn called(function: expr::Function, arguments: &[f64]) -> f64 {
    let a = arguments[0];
    match function {
        expr::Function::Sqrt => Scalar::sqrt(a),
        expr::Function::Sin => Scalar::sin(a),
        expr::Function::Cos => Scalar::cos(a),
        expr::Function::Tan => Scalar::tan(a),
        expr::Function::Asin => Scalar::asin(a),
        expr::Function::Acos => Scalar::acos(a),
        expr::Function::Atan2 => Scalar::atan2(a, arguments[1]),
        expr::Function::Exp => Scalar::exp(a),
        expr::Function::Ln => Scalar::ln(a),
        expr::Function::Tanh => Scalar::tanh(a),
        expr::Function::Abs => Scalar::abs(a),
        expr::Function::Pow => Scalar::powf(a, arguments[1]),
    }
}

/// What is no number has many forms.
fn bits(of: &[f64]) -> Vec<u64> {
    of.iter().map(|value| if value.is_nan() { u64::MAX } else { value.to_bits() }).collect()
}

/// What was compared.
pub struct Compared {
    /// Results that are numbers.
    pub numbers: usize,
    /// Functions that have fewer operations by pairs of them.
    pub paired: usize,
}

/// Compares functions of programs with one operation after the other.
///
/// # Panics
/// A bit differs, or there is no function of a program.
pub fn compare() -> Compared {
    let mut random = Rng::with_seed(11);
    let mut compared = Compared { numbers: 0, paired: 0 };
    for round in 0..400 {
        let program = if round % 2 == 0 { program(&mut random) } else { in_a_plane(&mut random) };
        let function = Function::of(&program).expect("this machine has a back end");
        let alone = Function::of(&Program { pairing: Pairing::None, ..program.clone() }).expect("as well");
        compared.paired += usize::from(function.operations() < alone.operations());
        for _ in 0..4 {
            let mut draw = |count: usize| -> Vec<f64> {
                // Zeros of both signs are among them.
                (0..count).map(|_| [0.0, -0.0, 4.0 * random.f64() - 2.0][random.usize(..3)]).collect()
            };
            let [mut fixed, states, read] = [LENGTHS[0], LENGTHS[1], LENGTHS[2]].map(|count| draw(2 * count));
            fixed.truncate(fixed_of(&program));
            for &(place, is_negative) in function.appended() {
                fixed.push(if is_negative { -fixed[place as usize] } else { fixed[place as usize] });
            }
            let negative = [random.bool(), random.bool()];
            let inputs = Inputs { fixed: &fixed, states: &states, read: &read, negative: &negative };
            let mut results = vec![7.0; program.results.len()];
            function.call(inputs, &mut results);
            assert_eq!(bits(&results), bits(&evaluated(&program, inputs)), "{round}: {program:?}");
            compared.numbers += results.iter().filter(|result| result.is_finite()).count();
        }
    }
    compared
}
