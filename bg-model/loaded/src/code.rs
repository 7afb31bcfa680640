//! Straight-line programs as an interpreter reads them: operations in batches of one kind.
//!
//! In: a [`Routine`] of the compiler. Out: [`Code`], whose values stand in one row of places: numbers and constants,
//! what is read anew for each evaluation, then what operations give. What a batch reads stands before what it writes,
//! so an evaluation is a walk along the row; a batch is one loop without a choice in it.
//!
//! Each operation and its operands are the routine's, so the values have the bits of generated code in any scalar.

use std::any::Any;
use std::collections::HashMap;
use std::sync::OnceLock;

use bg_compiler::expr::Symbol;
use bg_compiler::program::Routine;
use bg_compiler::program::batches::{self, Read, batches};
use bg_model::scalar::Scalar;
use bg_model::tabled::{Word, run};
use bg_native::{Function, Inputs, Operand, Pairing, Program};

/// A place in the row of values.
type Place = u32;

/// A program, whatever the scalar.
#[derive(Debug)]
pub struct Code {
    /// What it evaluates.
    program: Program,
    /// What stands in the first places as long as the model is the same.
    fixed: Vec<Fixed>,
    /// How many states stand in the places after these.
    states: usize,
    /// How many other numbers that are read anew stand in the places after these.
    reads: usize,
    /// What these are, where they are symbols.
    symbols: Vec<Symbol>,
    /// Whether it reads what iterations find.
    reads_found: bool,
    /// For the interpreter, made when it is first interpreted.
    batches: OnceLock<Batches>,
    /// In machine code, made when that pays; none where the machine has no back end.
    function: OnceLock<Option<Function>>,
}

/// What does not change between evaluations.
#[derive(Clone, Copy, Debug)]
enum Fixed {
    Number(f64),
    /// An entry of the table of constants.
    Constant(u32),
}

/// What an interpreter reads.
#[derive(Clone, Debug)]
struct Batches {
    /// The operations in batches of one kind.
    words: Vec<Word>,
    /// The places of the results.
    results: Vec<Place>,
    /// How many places there are.
    places: usize,
}

/// The row of values of one program of one model.
#[derive(Debug)]
pub struct Row<S: Scalar> {
    values: Vec<S>,
    /// None where it is interpreted.
    call: Option<Call<S>>,
    /// What machine code reads that stays as it is; none as long as there is no machine code.
    fixed: Option<Vec<S>>,
    /// How often it is interpreted before it is translated.
    waits: u32,
}

impl<S: Scalar> Row<S> {
    /// What machine code reads that stays as it is.
    fn appended(&self) -> &[S] {
        self.fixed.as_deref().unwrap_or_default()
    }
}

/// How machine code is called with numbers of this kind.
type Call<S> = for<'a> fn(&Function, Inputs<'a, S, <S as Scalar>::Switch>, &mut [S]);

/// What evaluates programs. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BackEnd {
    /// An interpreter, for any numbers on any machine.
    Interpreter,
    /// Machine code for doubles where the machine has a back end, after so many evaluations by the interpreter; else
    /// the interpreter.
    MachineCode {
        /// Evaluations of a program before it is translated.
        after: u32,
    },
}

/// Translation takes as long as so many evaluations by the interpreter: measured in `docs/benchmarks/text.md`. In a
/// page what translates is itself compiled when it is first called, and made for size.
const PAYS: u32 = if cfg!(target_arch = "wasm32") { 4000 } else { 500 };

impl Default for BackEnd {
    /// Machine code where it pays.
    fn default() -> Self {
        Self::MachineCode { after: PAYS }
    }
}

impl BackEnd {
    /// How machine code is called, where there is some for these numbers, and after how many evaluations.
    fn call<S: Scalar>(self) -> (Option<Call<S>>, u32) {
        let of_doubles: Call<f64> = Function::call;
        match self {
            Self::Interpreter => (None, 0),
            Self::MachineCode { after } => ((&of_doubles as &dyn Any).downcast_ref().copied(), after),
        }
    }
}

impl Code {
    /// The program of a routine.
    #[must_use]
    pub fn of(routine: &Routine) -> Self {
        let mut places = Places::default();
        let operations = routine.assignments.iter().map(|of| of.operation.map(|operand| places.of(operand))).collect();
        let results = routine.results.iter().map(|&result| places.of(result)).collect();
        let reads = places.symbols.len();
        places.code(Program { operations, results, pairing: Pairing::None }, reads)
    }

    /// The same program, whose machine code has pairs of operations: for what is evaluated at each step of a run.
    #[must_use]
    pub fn in_pairs(mut self) -> Self {
        self.program.pairing = Pairing::Sought;
        self
    }

    /// How many results it has.
    #[must_use]
    pub fn results(&self) -> usize {
        self.program.results.len()
    }

    /// Whether it reads what iterations find.
    #[must_use]
    pub fn reads_found(&self) -> bool {
        self.reads_found
    }

    /// The row of a model with these constants.
    #[must_use]
    pub fn row<S: Scalar>(&self, constants: &[S], back_end: BackEnd) -> Row<S> {
        let fixed = self.fixed.iter().map(|fixed| match *fixed {
            Fixed::Number(value) => S::from_f64(value),
            Fixed::Constant(index) => constants[index as usize],
        });
        let mut values: Vec<S> = fixed.collect();
        values.resize(self.inputs(), S::from_f64(0.0));
        let (call, waits) = back_end.call();
        Row { values, call, fixed: None, waits }
    }

    /// How many places there are before those of operations.
    fn inputs(&self) -> usize {
        self.fixed.len() + self.states + self.reads
    }

    /// Evaluates it at the states `x`, with a place for each result in `to`.
    pub fn evaluate<S: Scalar>(
        &self,
        row: &mut Row<S>,
        x: &[S],
        symbol: impl Fn(Symbol) -> S,
        negative: &[S::Switch],
        to: &mut [S],
    ) {
        let begin = self.fixed.len() + self.states;
        row.values[begin..].iter_mut().zip(&self.symbols).for_each(|(to, &read)| *to = symbol(read));
        if let Some((function, call)) = self.function(row) {
            let read = &row.values[begin..begin + self.reads];
            call(function, Inputs { fixed: row.appended(), states: x, read, negative }, to);
        } else {
            self.interpret(row, x, negative, to);
        }
    }

    /// The same by machine code, where there is some by now and the program reads nothing but states; whether it is so.
    /// The short way, without a place for what is read: rates of a few hundred operations take a tenth less time by it.
    #[inline]
    pub fn evaluate_at<S: Scalar>(&self, row: &Row<S>, x: &[S], negative: &[S::Switch], to: &mut [S]) -> bool {
        let (Some(call), Some(fixed), Some(Some(function)), 0) =
            (row.call, &row.fixed, self.function.get(), self.reads)
        else {
            return false;
        };
        call(function, Inputs { fixed, states: x, read: &[], negative }, to);
        true
    }

    /// The same, of a program that reads numbers in a list.
    pub fn evaluate_listed<S: Scalar>(
        &self,
        row: &mut Row<S>,
        x: &[S],
        read: &[S],
        negative: &[S::Switch],
        to: &mut [S],
    ) {
        if let Some((function, call)) = self.function(row) {
            call(function, Inputs { fixed: row.appended(), states: x, read, negative }, to);
        } else {
            let begin = self.fixed.len() + self.states;
            row.values[begin..begin + self.reads].copy_from_slice(&read[..self.reads]);
            self.interpret(row, x, negative, to);
        }
    }

    fn interpret<S: Scalar>(&self, row: &mut Row<S>, x: &[S], negative: &[S::Switch], to: &mut [S]) {
        let Batches { words, results, places } = self.batches.get_or_init(|| self.batched());
        row.values.resize(*places, S::from_f64(0.0));
        let values = &mut row.values[..];
        values[self.fixed.len()..][..self.states].copy_from_slice(&x[..self.states]);
        run(words, values, self.inputs(), negative);
        to.iter_mut().zip(results).for_each(|(to, &place)| *to = values[place as usize]);
    }

    /// The machine code, where it is there or pays; the row has what it reads then.
    fn function<S: Scalar>(&self, row: &mut Row<S>) -> Option<(&Function, Call<S>)> {
        let call = row.call?;
        let function = match self.function.get() {
            Some(known) => known,
            None if row.waits > 0 => {
                row.waits -= 1;
                return None;
            }
            None => self.translated(),
        };
        let function = function.as_ref()?;
        row.fixed.get_or_insert_with(|| {
            let fixed = &row.values[..self.fixed.len()];
            let signed = |&(place, is_negative): &(u32, bool)| {
                let value = fixed[place as usize];
                if is_negative { -value } else { value }
            };
            fixed.iter().copied().chain(function.appended().iter().map(signed)).collect()
        });
        Some((function, call))
    }

    fn translated(&self) -> &Option<Function> {
        self.function.get_or_init(|| Function::of(&self.program))
    }

    /// Makes machine code of it; whether there is some.
    pub fn translate(&self) -> bool {
        self.translated().is_some()
    }

    /// The results of one evaluation by itself, with these constants.
    pub fn once<S: Scalar>(&self, constants: &[S], symbol: impl Fn(Symbol) -> S) -> Vec<S> {
        let mut results = vec![S::from_f64(0.0); self.results()];
        self.evaluate(&mut self.row(constants, BackEnd::Interpreter), &[], symbol, &[], &mut results);
        results
    }

    /// The operations in batches.
    fn batched(&self) -> Batches {
        let operations = &self.program.operations;
        let (first_state, first_read) = (place(self.fixed.len()), place(self.fixed.len() + self.states));
        let read = |operand: Operand| match operand {
            Operand::Fixed(index) => match self.fixed[index as usize] {
                Fixed::Number(value) => Read::Number(value, index),
                Fixed::Constant(_) => Read::Place(index),
            },
            Operand::State(index) => Read::Place(first_state + index),
            Operand::Read(index) => Read::Place(first_read + index),
            Operand::Value(index) => Read::Value(index),
        };
        let batches::Batches { words, values } = batches(operations, place(self.inputs()), &read);
        let result = |&result: &Operand| match read(result) {
            Read::Place(place) | Read::Number(_, place) => place,
            Read::Value(value) => values[value as usize],
        };
        Batches {
            words: words.into_iter().map(u32::to_le_bytes).collect(),
            results: self.program.results.iter().map(result).collect(),
            places: self.inputs() + operations.len(),
        }
    }
}

/// Where what a program reads stands.
#[derive(Debug, Default)]
pub struct Places {
    fixed: Vec<Fixed>,
    states: usize,
    numbers: HashMap<u64, Place>,
    constants: HashMap<u32, Place>,
    /// What is read that is no state.
    pub symbols: Vec<Symbol>,
    of_symbols: HashMap<Symbol, Place>,
}

impl Places {
    /// The operand of a program that an operand of a routine is.
    pub fn of(&mut self, operand: bg_compiler::program::Operand) -> Operand {
        use bg_compiler::program::Operand as Of;
        let Self { fixed, states, numbers, constants, symbols, of_symbols } = self;
        let mut enter = |entry| entered(fixed, entry);
        match operand {
            Of::Number(value) => {
                Operand::Fixed(*numbers.entry(value.to_bits()).or_insert_with(|| enter(Fixed::Number(value))))
            }
            Of::Constant(index) => {
                Operand::Fixed(*constants.entry(index).or_insert_with(|| enter(Fixed::Constant(index))))
            }
            Of::Symbol(Symbol::State(index)) => {
                *states = (*states).max(index as usize + 1);
                Operand::State(index)
            }
            Of::Symbol(symbol) => Operand::Read(*of_symbols.entry(symbol).or_insert_with(|| entered(symbols, symbol))),
            Of::Temporary(index) => Operand::Value(index),
        }
    }

    /// A program whose operands stand here, and which reads so many other numbers.
    pub fn code(self, program: Program, reads: usize) -> Code {
        Code {
            program,
            fixed: self.fixed,
            states: self.states,
            reads,
            reads_found: self.symbols.iter().any(|symbol| matches!(symbol, Symbol::Found(_))),
            symbols: self.symbols,
            batches: OnceLock::new(),
            function: OnceLock::new(),
        }
    }
}

/// The place of a new entry.
fn entered<T>(list: &mut Vec<T>, entry: T) -> Place {
    list.push(entry);
    place(list.len() - 1)
}

fn place(index: usize) -> Place {
    Place::try_from(index).expect("fewer than 2^32 values")
}

#[cfg(all(test, feature = "machine-code", any(target_arch = "x86_64", target_arch = "aarch64")))]
mod tests {
    use std::path::Path;

    use crate::text::{Counted, Wanted, load_wanted};

    #[test]
    fn rates_of_the_hacksaw_have_pairs_of_operations() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../hacksaw/hacksaw.bond");
        let text = std::fs::read_to_string(file).expect("the hacksaw's text");
        let wanted = Wanted { scene: &|name| name == "Motion", counted: Counted::Made, most: None };
        let graphs = load_wanted(&text, wanted).unwrap_or_else(|faults| panic!("{}", faults[0]));
        let motion = graphs[0].models.iter().find(|model| model.description.name == "Motion").expect("the scene");
        let rate = &motion.blueprint.as_ref().expect("it was asked for").programs.rate;
        let function = rate.translated().as_ref().expect("a back end");
        assert_eq!(rate.program.operations.len(), 225);
        assert!(function.operations() <= 211 && !function.appended().is_empty(), "{}", function.operations());
    }
}
