//! A program to instructions.
//!
//! In: a [`Program`]. Out: the body of one function of five addresses: what is fixed, the states, what is read, the
//! branches, where results go. Method: one instruction of Cranelift for each operation, in the order of
//! [`Program::order`]; inputs are read where they are used, and again where the last use is long ago; sine and cosine of
//! one angle are one call.

use std::collections::HashMap;

use bg_expressions::expr;
use bg_expressions::schedule::Operation;
use cranelift_codegen::Context;
use cranelift_codegen::ir::{
    AbiParam, FuncRef, InstBuilder, MemFlagsData as MemFlags, Signature, StackSlotData, StackSlotKind, Type, Value,
    types,
};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::JITModule;
use cranelift_module::{FuncId, Linkage, Module};

use super::functions::{SINE_AND_COSINE, called};
use crate::program::{Operand, Program};

/// An input is read again where its last use is more operations ago: kept longer, it takes a register that values need
/// more (`docs/benchmarks/text.md`).
const KEPT: usize = 24;

/// Puts the function of a program into a module, which knows the functions that it calls; gives its number there. None
/// where the back end cannot.
pub fn translate(module: &mut JITModule, program: &Program) -> Option<FuncId> {
    let mut context = module.make_context();
    let address = module.target_config().pointer_type();
    context.func.signature = signature(module, &[address; 5], &[]);
    let functions = Functions::declared(module, &mut context, program)?;
    let mut reused = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut reused);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    let [fixed, states, read, negative, results] = *builder.block_params(block) else {
        unreachable!("the signature has five addresses")
    };
    let values = vec![None; program.operations.len()];
    let inputs = Loads { addresses: [fixed, states, read], used: HashMap::new() };
    let mut body = Body { builder, program, functions, address, inputs, negative, values, written: 0 };
    program.order().into_iter().for_each(|of| body.enter(of));
    for (place, &result) in program.results.iter().enumerate() {
        let value = body.operand(result);
        body.builder.ins().store(MemFlags::trusted(), value, results, offset(place));
    }
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

/// The functions that a program calls.
struct Functions {
    alone: HashMap<expr::Function, FuncRef>,
    sine_and_cosine: FuncRef,
    /// Of a sine or a cosine the operation that is the other one of the same angle.
    partners: HashMap<usize, usize>,
}

impl Functions {
    fn declared(module: &mut JITModule, context: &mut Context, program: &Program) -> Option<Self> {
        let address = module.target_config().pointer_type();
        let mut declare = |name, takes: &[Type], gives: &[Type]| {
            let signature = signature(module, takes, gives);
            let known = module.declare_function(name, Linkage::Import, &signature).ok()?;
            Some(module.declare_func_in_func(known, &mut context.func))
        };
        let sine_and_cosine = declare(SINE_AND_COSINE, &[types::F64, address], &[])?;
        let mut alone = HashMap::new();
        for operation in &program.operations {
            if let Operation::Call(function, arguments) = operation
                && let Some(called) = called(*function)
                && !alone.contains_key(function)
            {
                alone.insert(*function, declare(called.name, &vec![types::F64; arguments.len()], &[types::F64])?);
            }
        }
        Some(Self { alone, sine_and_cosine, partners: partners(program) })
    }
}

/// Of sines and cosines of the same angles each one's other.
fn partners(program: &Program) -> HashMap<usize, usize> {
    use expr::Function::{Cos, Sin};
    let of = |wanted: expr::Function| {
        program.operations.iter().enumerate().filter_map(move |(of, operation)| match operation {
            Operation::Call(function, arguments) if *function == wanted => Some((arguments[0], of)),
            _ => None,
        })
    };
    let sines: HashMap<Operand, usize> = of(Sin).collect();
    of(Cos).filter_map(|(angle, of)| sines.get(&angle).map(|&sine| [(of, sine), (sine, of)])).flatten().collect()
}

/// The body of a function while it is written.
struct Body<'a> {
    builder: FunctionBuilder<'a>,
    program: &'a Program,
    functions: Functions,
    address: Type,
    inputs: Loads,
    negative: Value,
    values: Vec<Option<Value>>,
    /// How many operations are written.
    written: usize,
}

/// The loads of inputs.
struct Loads {
    /// Where what is fixed, states and what is read stand.
    addresses: [Value; 3],
    /// Those that have been read since the last call, and before which operation each was used last.
    used: HashMap<Operand, (Value, usize)>,
}

impl Body<'_> {
    fn operand(&mut self, operand: Operand) -> Value {
        let (of, place) = match operand {
            Operand::Value(value) => {
                return self.values[value as usize].expect("values are taken after they are there");
            }
            Operand::Fixed(place) => (0, place),
            Operand::State(place) => (1, place),
            Operand::Read(place) => (2, place),
        };
        let value = match self.inputs.used.get(&operand) {
            Some(&(value, last)) if self.written - last <= KEPT => value,
            _ => {
                let flags = MemFlags::trusted().with_readonly();
                self.builder.ins().load(types::F64, flags, self.inputs.addresses[of], offset(place as usize))
            }
        };
        self.inputs.used.insert(operand, (value, self.written));
        value
    }

    /// Writes an operation, unless it is there.
    fn enter(&mut self, of: usize) {
        if self.values[of].is_some() {
            return;
        }
        let program = self.program;
        let operation = &program.operations[of];
        let operands: Vec<Value> = operation.operands().into_iter().map(|operand| self.operand(operand)).collect();
        self.written += 1;
        if let Operation::Call(..) = operation {
            self.inputs.used.clear();
        }
        if let Some(&partner) = self.functions.partners.get(&of) {
            let [sine, cosine] = self.sine_and_cosine(operands[0]);
            let is_sine = matches!(operation, Operation::Call(expr::Function::Sin, _));
            let (own, other) = if is_sine { (sine, cosine) } else { (cosine, sine) };
            (self.values[of], self.values[partner]) = (Some(own), Some(other));
        } else {
            self.values[of] = Some(self.operation(operation, &operands));
        }
    }

    fn sine_and_cosine(&mut self, angle: Value) -> [Value; 2] {
        let both = StackSlotData::new(StackSlotKind::ExplicitSlot, 16, 3);
        let both = self.builder.create_sized_stack_slot(both);
        let to = self.builder.ins().stack_addr(self.address, both, 0);
        self.builder.ins().call(self.functions.sine_and_cosine, &[angle, to]);
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

/// Where the number of this place stands in a slice, bytes.
fn offset(place: usize) -> i32 {
    i32::try_from(8 * place).expect("a slice of less than 2 GB")
}
