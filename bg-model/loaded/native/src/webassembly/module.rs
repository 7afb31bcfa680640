//! Steps to the bytes of a module.
//!
//! In: [`Steps`]. Out: a module that has the memory and the functions of another one, and exports one function of five
//! addresses in that memory: what is fixed, the states, what is read, the branches, where results go. Method: one
//! instruction for each operation on numbers or on pairs, in the order of [`Steps::order`]; inputs are read where they
//! are used; a result is written as soon as it is there; sine and cosine of one angle are one call.

use std::collections::HashMap;

use bg_expressions::expr;
use bg_expressions::schedule::Operation;
use wasm_encoder::{
    CodeSection, EntityType, ExportKind, ExportSection, Function, FunctionSection, ImportSection, InstructionSink,
    MemArg, MemArgTarget, MemoryType, Module, TypeSection, ValType,
};

use crate::functions::{SINE_AND_COSINE, called};
use crate::program::Operand;
use crate::steps::{Gathered, Given, Step, Steps};

/// Where memory and functions are from.
const FROM: &str = "env";
/// The parameters of the function after the addresses of what is fixed, of states and of what is read.
const NEGATIVE: u32 = 3;
const RESULTS: u32 = 4;
const PARAMETERS: [ValType; 5] = [ValType::I32; 5];

const NUMBER: ValType = ValType::F64;
const PAIR: ValType = ValType::V128;

/// The module of a program's steps, whose function is exported as `entry`.
pub fn module(steps: &Steps) -> Vec<u8> {
    let body = Body::of(steps);
    let (mut types, mut imports) = (TypeSection::new(), ImportSection::new());
    types.ty().function(PARAMETERS, []);
    let memory = MemoryType { minimum: 0, maximum: None, memory64: false, shared: false, page_size_log2: None };
    imports.import(FROM, "memory", memory);
    for (of, Imported { name, arguments, gives }) in (1..).zip(&body.imported) {
        types.ty().function(vec![NUMBER; *arguments], [*gives]);
        imports.import(FROM, name, EntityType::Function(of));
    }
    let mut functions = FunctionSection::new();
    functions.function(0);
    let mut exports = ExportSection::new();
    exports.export("entry", ExportKind::Func, small(body.imported.len()));
    let mut code = CodeSection::new();
    code.function(&body.function());
    let mut module = Module::new();
    module.section(&types).section(&imports).section(&functions).section(&exports).section(&code);
    module.finish()
}

/// A function that steps call.
#[derive(PartialEq)]
struct Imported {
    name: &'static str,
    arguments: usize,
    gives: ValType,
}

/// The body of a function while it is written.
struct Body<'a> {
    steps: &'a Steps,
    /// Of a sine or a cosine the step that is the other one of the same angle.
    partners: HashMap<usize, usize>,
    /// In the order of their numbers.
    imported: Vec<Imported>,
    code: Vec<u8>,
    /// The types of the locals after the parameters.
    locals: Vec<ValType>,
    /// Of each step the local that has its number or its pair.
    values: Vec<Option<u32>>,
}

impl<'a> Body<'a> {
    fn of(steps: &'a Steps) -> Self {
        let mut body = Self {
            steps,
            partners: steps.partners(),
            imported: Vec::new(),
            code: Vec::new(),
            locals: Vec::new(),
            values: vec![None; steps.steps.len()],
        };
        let (of_steps, of_inputs) = steps.places();
        for of in steps.order() {
            body.enter(of);
            // At once: a value that waits takes a register or a place on the stack.
            of_steps[of].iter().for_each(|&(given, place)| body.give(given, place));
        }
        of_inputs.into_iter().for_each(|(given, place)| body.give(given, place));
        body.ins().end();
        body
    }

    fn function(&self) -> Function {
        let mut function = Function::new_with_locals_types(self.locals.iter().copied());
        function.raw(self.code.iter().copied());
        function
    }

    fn ins(&mut self) -> InstructionSink<'_> {
        InstructionSink::new(&mut self.code)
    }

    /// A new local.
    fn local(&mut self, kind: ValType) -> u32 {
        self.locals.push(kind);
        small(PARAMETERS.len() + self.locals.len() - 1)
    }

    /// Puts a number or a pair onto the stack. Numbers of pairs are taken out of them when they are first asked for:
    /// not all are.
    fn push(&mut self, operand: Operand, kind: ValType) {
        let Operand::Value(of) = operand else {
            self.address(operand);
            let place = place(operand);
            let mut ins = self.ins();
            if kind == PAIR {
                ins.v128_load(place)
            } else {
                ins.f64_load(place)
            };
            return;
        };
        match (self.values[of as usize], &self.steps.steps[of as usize]) {
            (Some(local), _) => {
                self.ins().local_get(local);
            }
            (None, &Step::Half(pair, half)) => {
                self.push(pair, PAIR);
                let local = self.local(NUMBER);
                self.ins().f64x2_extract_lane(half).local_tee(local);
                self.values[of as usize] = Some(local);
            }
            (None, _) => unreachable!("values are taken after they are there"),
        }
    }

    /// Puts the address of the slice onto the stack that an input stands in.
    fn address(&mut self, input: Operand) {
        let parameter = match input {
            Operand::Fixed(_) => 0,
            Operand::State(_) => 1,
            Operand::Read(_) => 2,
            Operand::Value(_) => unreachable!("the value of a step is no input"),
        };
        self.ins().local_get(parameter);
    }

    /// Writes results to their places.
    fn give(&mut self, given: Given, place: usize) {
        self.ins().local_get(RESULTS);
        let place = at(8 * small(place));
        match given {
            Given::Number(number) => {
                self.push(number, NUMBER);
                self.ins().f64_store(place);
            }
            Given::Pair(pair) => {
                self.push(pair, PAIR);
                self.ins().v128_store(place);
            }
        }
    }

    /// Writes a step, unless it is there.
    fn enter(&mut self, of: usize) {
        if self.values[of].is_some() {
            return;
        }
        let steps = self.steps;
        let kind = match &steps.steps[of] {
            Step::Half(..) => return,
            Step::Number(Operation::Call(function, arguments)) => {
                if let Some(&partner) = self.partners.get(&of) {
                    let places = if *function == expr::Function::Sin { [of, partner] } else { [partner, of] };
                    return self.sine_and_cosine(arguments[0], places);
                }
                self.operands(arguments, NUMBER);
                self.call(*function, arguments.len());
                NUMBER
            }
            Step::Number(Operation::Select { switch, negative, positive }) => {
                self.operands(&[*negative, *positive], NUMBER);
                let switch = MemArg { align: 0, ..at(*switch) };
                self.ins().local_get(NEGATIVE).i32_load8_u(switch).select();
                NUMBER
            }
            Step::Number(operation) => {
                self.operands(&operation.operands(), NUMBER);
                let mut ins = self.ins();
                match operation {
                    Operation::Add(..) => ins.f64_add(),
                    Operation::Subtract(..) => ins.f64_sub(),
                    Operation::Multiply(..) => ins.f64_mul(),
                    Operation::Divide(..) => ins.f64_div(),
                    Operation::Negate(_) => ins.f64_neg(),
                    Operation::Call(..) | Operation::Select { .. } => unreachable!("they stand above"),
                };
                NUMBER
            }
            Step::Pair(operation) => {
                self.operands(&operation.operands(), PAIR);
                let mut ins = self.ins();
                match operation {
                    Operation::Add(..) => ins.f64x2_add(),
                    Operation::Subtract(..) => ins.f64x2_sub(),
                    Operation::Multiply(..) => ins.f64x2_mul(),
                    Operation::Divide(..) => ins.f64x2_div(),
                    other => unreachable!("no pairs are {other:?}"),
                };
                PAIR
            }
            Step::Gather(both) => {
                self.gather(*both);
                PAIR
            }
            Step::Turn(pair, turn) => {
                self.push(*pair, PAIR);
                self.turn(*turn);
                PAIR
            }
        };
        self.keep(of, kind);
    }

    /// Takes the value of a step from the stack.
    fn keep(&mut self, of: usize, kind: ValType) {
        let local = self.local(kind);
        self.ins().local_set(local);
        self.values[of] = Some(local);
    }

    fn operands(&mut self, operands: &[Operand], kind: ValType) {
        operands.iter().for_each(|&operand| self.push(operand, kind));
    }

    fn call(&mut self, function: expr::Function, arguments: usize) {
        if let Some(called) = called(function) {
            let number = self.number(Imported { name: called.name, arguments, gives: NUMBER });
            self.ins().call(number);
        } else if function == expr::Function::Sqrt {
            self.ins().f64_sqrt();
        } else {
            self.ins().f64_abs();
        }
    }

    /// The number of a function that is called.
    fn number(&mut self, wanted: Imported) -> u32 {
        let number = self.imported.iter().position(|known| *known == wanted).unwrap_or(self.imported.len());
        if number == self.imported.len() {
            self.imported.push(wanted);
        }
        small(number)
    }

    /// Sine and cosine of an angle, which are the values of these steps.
    fn sine_and_cosine(&mut self, angle: Operand, places: [usize; 2]) {
        self.push(angle, NUMBER);
        let number = self.number(Imported { name: SINE_AND_COSINE, arguments: 1, gives: ValType::I32 });
        let both = self.local(ValType::I32);
        self.ins().call(number).local_set(both);
        for (of, offset) in places.into_iter().zip([0, 8]) {
            self.ins().local_get(both).f64_load(at(offset));
            self.keep(of, NUMBER);
        }
    }

    /// The pair of two numbers.
    fn gather(&mut self, both: [Operand; 2]) {
        match self.steps.gathered(both) {
            Gathered::OfPairs(both) => {
                both.into_iter().for_each(|(pair, _)| self.push(pair, PAIR));
                let [first, second] = both.map(|(_, half)| 8 * half);
                let bytes = |of: u8| if of < 8 { first + of } else { 16 + second + of - 8 };
                self.ins().i8x16_shuffle(std::array::from_fn(|of| bytes(of as u8)));
            }
            Gathered::Replaced { pair, half, number } => {
                self.push(pair, PAIR);
                self.replace(half, number);
            }
            Gathered::Twice(number) if number.value().is_none() => {
                self.address(number);
                self.ins().v128_load64_splat(place(number));
            }
            Gathered::Twice(number) => {
                self.push(number, NUMBER);
                self.ins().f64x2_splat();
            }
            Gathered::Numbers([first, second]) => {
                if first.value().is_some() {
                    self.push(first, NUMBER);
                    self.ins().f64x2_splat();
                } else {
                    self.address(first);
                    self.ins().v128_load64_zero(place(first));
                }
                self.replace(1, second);
            }
        }
    }

    /// Puts a number into the place of another one of the pair on the stack.
    fn replace(&mut self, half: u8, number: Operand) {
        self.push(number, NUMBER);
        self.ins().f64x2_replace_lane(half);
    }

    /// Gives other signs to the pair on the stack.
    fn turn(&mut self, turn: [bool; 2]) {
        if turn == [true; 2] {
            self.ins().f64x2_neg();
        } else {
            let [first, second] = turn.map(|is_turned| u128::from(is_turned) << 63);
            self.ins().v128_const((first | second << 64).cast_signed()).v128_xor();
        }
    }
}

/// Where an input stands after the address of its slice. Pairs begin at any number.
fn place(input: Operand) -> MemArg {
    match input {
        Operand::Fixed(place) | Operand::State(place) | Operand::Read(place) => at(8 * place),
        Operand::Value(_) => unreachable!("the value of a step is no input"),
    }
}

/// Where a number stands after an address, bytes.
fn at(offset: u32) -> MemArg {
    MemArg { offset: u64::from(offset), align: 3, target: MemArgTarget::Memory(0), ordering: None }
}

fn small(count: usize) -> u32 {
    u32::try_from(count).expect("fewer than 2^32 of each")
}
