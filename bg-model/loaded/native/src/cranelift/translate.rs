//! Steps to instructions.
//!
//! In: [`Steps`]. Out: the body of one function of five addresses: what is fixed, the states, what is read, the
//! branches, where results go. Method: one instruction of Cranelift for each operation on numbers or on pairs, in the
//! order of [`Steps::order`]; inputs are read where they are used, and again where the last use is long ago; a result
//! is written as soon as it is there; sine and cosine of one angle are one call.

use std::collections::HashMap;

use bg_expressions::expr;
use bg_expressions::schedule::Operation;
use cranelift_codegen::Context;
use cranelift_codegen::ir::{
    AbiParam, ConstantData, Endianness, FuncRef, InstBuilder, MemFlagsData as MemFlags, Signature, StackSlotData,
    StackSlotKind, Type, Value, types,
};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::JITModule;
use cranelift_module::{FuncId, Linkage, Module};

use crate::functions::{SINE_AND_COSINE, called};
use crate::program::Operand;
use crate::steps::{Gathered, Given, Step, Steps};

/// An input is read again where its last use is more steps ago: kept longer, it takes a register that values need
/// more (`docs/benchmarks/text.md`).
const KEPT: usize = 24;

/// Puts the function of a program's steps into a module, which knows the functions that it calls; gives its number
/// there. None where the back end cannot.
pub fn translate(module: &mut JITModule, steps: &Steps) -> Option<FuncId> {
    let mut context = module.make_context();
    let address = module.target_config().pointer_type();
    context.func.signature = signature(module, &[address; 5], &[]);
    let functions = Functions::declared(module, &mut context, steps)?;
    let mut reused = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut reused);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    let [fixed, states, read, negative, results] = *builder.block_params(block) else {
        unreachable!("the signature has five addresses")
    };
    let values = vec![None; steps.steps.len()];
    let inputs = Loads { addresses: [fixed, states, read], used: HashMap::new() };
    let mut body = Body { builder, steps, functions, address, inputs, negative, values, written: 0 };
    let (of_steps, of_inputs) = steps.places();
    for of in steps.order() {
        body.enter(of);
        // At once: a value that waits takes a register or a place on the stack.
        of_steps[of].iter().for_each(|&(given, place)| body.give(given, results, place));
    }
    of_inputs.into_iter().for_each(|(given, place)| body.give(given, results, place));
    body.builder.ins().return_(&[]);
    body.builder.seal_all_blocks();
    body.builder.finalize(module.target_config());
    let id = module.declare_anonymous_function(&context.func.signature).ok()?;
    module.define_function(id, &mut context).ok()?;
    Some(id)
}

fn signature(module: &JITModule, takes: &[Type], gives: &[Type]) -> Signature {
    let mut signature = module.make_signature();
    signature.params = takes.iter().copied().map(AbiParam::new).collect();
    signature.returns = gives.iter().copied().map(AbiParam::new).collect();
    signature
}

/// The functions that steps call.
struct Functions {
    alone: HashMap<expr::Function, FuncRef>,
    sine_and_cosine: Option<FuncRef>,
    /// Of a sine or a cosine the step that is the other one of the same angle.
    partners: HashMap<usize, usize>,
}

impl Functions {
    fn declared(module: &mut JITModule, context: &mut Context, steps: &Steps) -> Option<Self> {
        let address = module.target_config().pointer_type();
        let mut declare = |name, takes: &[Type], gives: &[Type]| {
            let signature = signature(module, takes, gives);
            let known = module.declare_function(name, Linkage::Import, &signature).ok()?;
            Some(module.declare_func_in_func(known, &mut context.func))
        };
        let partners = steps.partners();
        let sine_and_cosine = match partners.is_empty() {
            true => None,
            false => Some(declare(SINE_AND_COSINE, &[types::F64, address], &[])?),
        };
        let mut alone = HashMap::new();
        for (_, function, arguments) in steps.calls() {
            if let Some(called) = called(function)
                && !alone.contains_key(&function)
            {
                alone.insert(function, declare(called.name, &vec![types::F64; arguments.len()], &[types::F64])?);
            }
        }
        Some(Self { alone, sine_and_cosine, partners })
    }
}

/// The body of a function while it is written.
struct Body<'a> {
    builder: FunctionBuilder<'a>,
    steps: &'a Steps,
    functions: Functions,
    address: Type,
    inputs: Loads,
    negative: Value,
    /// Of each step its number or its pair.
    values: Vec<Option<Value>>,
    /// How many steps are written.
    written: usize,
}

/// The loads of inputs.
struct Loads {
    /// Where what is fixed, states and what is read stand.
    addresses: [Value; 3],
    /// Those that have been read since the last call, as a number or a pair, and before which step each was used last.
    used: HashMap<(Operand, Type), (Value, usize)>,
}

const PAIR: Type = types::F64X2;

impl Body<'_> {
    /// A number or a pair. Numbers of pairs are taken out of them when they are first asked for: not all are.
    fn operand(&mut self, operand: Operand, kind: Type) -> Value {
        if let Operand::Value(of) = operand {
            let of = of as usize;
            if let (None, Step::Half(pair, half)) = (self.values[of], &self.steps.steps[of]) {
                let pair = self.operand(*pair, PAIR);
                self.values[of] = Some(self.builder.ins().extractlane(pair, *half));
            }
            return self.values[of].expect("values are taken after they are there");
        }
        let value = match self.inputs.used.get(&(operand, kind)) {
            Some(&(value, last)) if self.written - last <= KEPT => value,
            _ => self.load(operand, kind),
        };
        self.inputs.used.insert((operand, kind), (value, self.written));
        value
    }

    fn load(&mut self, operand: Operand, kind: Type) -> Value {
        let (of, place) = match operand {
            Operand::Fixed(place) => (0, place),
            Operand::State(place) => (1, place),
            Operand::Read(place) => (2, place),
            Operand::Value(_) => unreachable!("the value of a step is no input"),
        };
        self.builder.ins().load(kind, memory(kind).with_readonly(), self.inputs.addresses[of], offset(place as usize))
    }

    /// Writes results to their places.
    fn give(&mut self, given: Given, results: Value, place: usize) {
        let kind = if let Given::Pair(_) = given { PAIR } else { types::F64 };
        let value = self.operand(given.operand(), kind);
        self.builder.ins().store(memory(kind), value, results, offset(place));
    }

    /// Writes a step, unless it is there.
    fn enter(&mut self, of: usize) {
        if self.values[of].is_some() {
            return;
        }
        let steps = self.steps;
        let value = match &steps.steps[of] {
            Step::Half(..) => return,
            Step::Number(operation) => {
                let operands = self.operands(operation, types::F64);
                if let Operation::Call(function, _) = operation {
                    self.inputs.used.clear();
                    if let Some(&partner) = self.functions.partners.get(&of) {
                        let [sine, cosine] = self.sine_and_cosine(operands[0]);
                        let is_sine = *function == expr::Function::Sin;
                        self.values[partner] = Some(if is_sine { cosine } else { sine });
                        if is_sine { sine } else { cosine }
                    } else {
                        self.operation(operation, &operands)
                    }
                } else {
                    self.operation(operation, &operands)
                }
            }
            Step::Pair(operation) => {
                let operands = self.operands(operation, PAIR);
                self.operation(operation, &operands)
            }
            Step::Gather(both) => self.gathered(*both),
            Step::Turn(of, turn) => self.turned(*of, *turn),
        };
        self.values[of] = Some(value);
        self.written += 1;
    }

    fn operands(&mut self, operation: &Operation<Operand>, kind: Type) -> Vec<Value> {
        operation.operands().into_iter().map(|operand| self.operand(operand, kind)).collect()
    }

    /// The pair of two numbers.
    fn gathered(&mut self, both: [Operand; 2]) -> Value {
        match self.steps.gathered(both) {
            Gathered::OfPairs(both) => {
                let [first, second] = both.map(|(pair, half)| (self.operand(pair, PAIR), half));
                self.shuffled(first, second)
            }
            Gathered::Replaced { pair, half, number } => {
                let [pair, number] = [(pair, PAIR), (number, types::F64)].map(|(of, kind)| self.operand(of, kind));
                self.builder.ins().insertlane(pair, number, half)
            }
            Gathered::Twice(number) => {
                let number = self.operand(number, types::F64);
                self.builder.ins().splat(PAIR, number)
            }
            Gathered::Numbers([first, second]) => {
                let begun = if first.value().is_some() {
                    let first = self.operand(first, types::F64);
                    self.builder.ins().splat(PAIR, first)
                } else {
                    let first = self.load(first, types::F64);
                    self.builder.ins().scalar_to_vector(PAIR, first)
                };
                let second = self.operand(second, types::F64);
                self.builder.ins().insertlane(begun, second, 1)
            }
        }
    }

    /// A number of one pair, then one of another.
    fn shuffled(&mut self, first: (Value, u8), second: (Value, u8)) -> Value {
        let bytes_of = |(_, half): (Value, u8), begin: u8| begin + 8 * half..begin + 8 * half + 8;
        let bytes: Vec<u8> = bytes_of(first, 0).chain(bytes_of(second, 16)).collect();
        let mask = self.builder.func.dfg.immediates.push(ConstantData::from(bytes));
        let [first, second] = [first, second].map(|(pair, _)| self.in_bits(types::I8X16, pair));
        let shuffled = self.builder.ins().shuffle(first, second, mask);
        self.in_bits(PAIR, shuffled)
    }

    fn in_bits(&mut self, kind: Type, value: Value) -> Value {
        self.builder.ins().bitcast(kind, MemFlags::new().with_endianness(Endianness::Little), value)
    }

    fn turned(&mut self, pair: Operand, turn: [bool; 2]) -> Value {
        let pair = self.operand(pair, PAIR);
        if turn == [true; 2] {
            return self.builder.ins().fneg(pair);
        }
        let signs = turn.map(|is_turned| if is_turned { -0.0 } else { 0.0_f64 }.to_le_bytes()).concat();
        let signs = self.builder.func.dfg.constants.insert(ConstantData::from(signs));
        let signs = self.builder.ins().vconst(PAIR, signs);
        self.builder.ins().bxor(pair, signs)
    }

    fn sine_and_cosine(&mut self, angle: Value) -> [Value; 2] {
        let both = StackSlotData::new(StackSlotKind::ExplicitSlot, 16, 3);
        let both = self.builder.create_sized_stack_slot(both);
        let to = self.builder.ins().stack_addr(self.address, both, 0);
        let function = self.functions.sine_and_cosine.expect("it is declared where there are both");
        self.builder.ins().call(function, &[angle, to]);
        [0, 8].map(|offset| self.builder.ins().load(types::F64, MemFlags::trusted(), to, offset))
    }

    fn operation(&mut self, operation: &Operation<Operand>, operands: &[Value]) -> Value {
        let ins = self.builder.ins();
        match operation {
            Operation::Add(..) => ins.fadd(operands[0], operands[1]),
            Operation::Subtract(..) => ins.fsub(operands[0], operands[1]),
            Operation::Multiply(..) => ins.fmul(operands[0], operands[1]),
            Operation::Divide(..) => ins.fdiv(operands[0], operands[1]),
            Operation::Negate(_) => ins.fneg(operands[0]),
            Operation::Call(expr::Function::Sqrt, _) => ins.sqrt(operands[0]),
            Operation::Call(expr::Function::Abs, _) => ins.fabs(operands[0]),
            Operation::Call(function, _) => {
                let call = ins.call(self.functions.alone[function], operands);
                self.builder.inst_results(call)[0]
            }
            Operation::Select { switch, .. } => {
                let place = i32::try_from(*switch).expect("fewer than 2^31 switches");
                let branch = ins.load(types::I8, MemFlags::trusted().with_readonly(), self.negative, place);
                self.builder.ins().select(branch, operands[0], operands[1])
            }
        }
    }
}

/// How numbers and pairs stand in a slice: as a pair begins at any number, not at a multiple of its size.
fn memory(kind: Type) -> MemFlags {
    if kind == PAIR { MemFlags::new().with_notrap() } else { MemFlags::trusted() }
}

/// Where the number of this place stands in a slice, bytes.
fn offset(place: usize) -> i32 {
    i32::try_from(8 * place).expect("a slice of less than 2 GB")
}
