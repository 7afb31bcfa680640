//! Where machine code is, and how it is called.

mod functions;
#[cfg(test)]
mod tests;
mod translate;

use std::fmt;
use std::sync::{Arc, LazyLock, Mutex};

use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::default_libcall_names;

use crate::program::{Inputs, Lengths, Program};
use crate::steps::Steps;
use functions::{SINE_AND_COSINE, called, sine_and_cosine};
use translate::{calls, translate};

/// Longer programs are not translated: how long registers are sought for grows faster than the program.
const LONGEST: usize = 20_000;

/// What machine code is: it reads what is fixed, states, other numbers and branches, and writes results.
type Entry = unsafe extern "C" fn(*const f64, *const f64, *const f64, *const bool, *mut f64);

/// A program in machine code.
pub struct Function {
    entry: Entry,
    lengths: Lengths,
    results: usize,
    appended: Vec<(u32, bool)>,
    operations: usize,
    /// What holds the memory, until this is dropped.
    module: Mutex<Option<JITModule>>,
}

/// The machine at hand; none where there is no back end for it.
static MACHINE: LazyLock<Option<OwnedTargetIsa>> = LazyLock::new(machine);

fn machine() -> Option<OwnedTargetIsa> {
    let mut flags = settings::builder();
    // The module wants calls of any distance, and code that stays where it is. The verifier finds faults of
    // translation: tests have it.
    let verified = if cfg!(debug_assertions) { "true" } else { "false" };
    for (name, value) in [
        ("use_colocated_libcalls", "false"),
        ("is_pic", "false"),
        ("opt_level", "none"),
        ("regalloc_algorithm", "backtracking"),
        ("enable_verifier", verified),
    ] {
        flags.set(name, value).ok()?;
    }
    cranelift_native::builder().ok()?.finish(settings::Flags::new(flags)).ok()
}

impl Function {
    /// A program in machine code; none where there is no back end for the machine, where it gives no memory for code,
    /// or where the program is longer than 20 000 operations.
    ///
    /// # Panics
    /// An operation takes a value that does not come before it.
    #[must_use]
    pub fn of(program: &Program) -> Option<Self> {
        let mut lengths = program.lengths();
        let isa = MACHINE.as_ref().filter(|_| program.operations.len() <= LONGEST)?;
        let steps = Steps::of(program, lengths.fixed);
        lengths.fixed += steps.appended.len();
        let mut builder = JITBuilder::with_isa(Arc::clone(isa), default_libcall_names());
        builder.symbol(SINE_AND_COSINE, sine_and_cosine as *const u8);
        for called in calls(&steps).filter_map(|(_, function, _)| called(function)) {
            builder.symbol(called.name, called.address);
        }
        Self::in_module(JITModule::new(builder), steps, program.results.len(), lengths)
    }

    fn in_module(mut module: JITModule, steps: Steps, results: usize, lengths: Lengths) -> Option<Self> {
        let id = translate(&mut module, &steps)?;
        module.finalize_definitions().ok()?;
        let address = module.get_finalized_function(id);
        // SAFETY: the function has been translated with this signature, in the convention of `extern "C"`.
        #[expect(unsafe_code, reason = "an address becomes a function")]
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(address) };
        let operations = steps.operations();
        Some(Self { entry, lengths, results, appended: steps.appended, operations, module: Mutex::new(Some(module)) })
    }

    /// How many operations it has: on numbers, on pairs, and those that gather pairs or give them other signs.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.operations
    }

    /// What has to stand after what is fixed when the program is called: entries of it, side by side for pairs, with
    /// `true` where the negative is meant.
    #[must_use]
    pub fn appended(&self) -> &[(u32, bool)] {
        &self.appended
    }

    /// Evaluates the program. After what is fixed stands what is [appended](Self::appended).
    ///
    /// # Panics
    /// A slice is shorter than what the program reads; `results` has not one place for each result.
    pub fn call(&self, inputs: Inputs<'_>, results: &mut [f64]) {
        let Inputs { fixed, states, read, negative } = inputs;
        let Lengths { fixed: of_fixed, states: of_states, read: of_read, switches } = self.lengths;
        assert!(fixed.len() >= of_fixed && states.len() >= of_states, "a place for each number that is read");
        assert!(read.len() >= of_read && negative.len() >= switches, "a place for each number and branch that is read");
        assert!(results.len() == self.results, "a place for each result");
        // SAFETY: the code reads places below `lengths` and writes as many results as there are, which were checked;
        // the slices do not overlap, as one of them is borrowed to be written; the memory of the code is there until
        // `self` is dropped.
        #[expect(unsafe_code, reason = "machine code is called")]
        unsafe {
            (self.entry)(fixed.as_ptr(), states.as_ptr(), read.as_ptr(), negative.as_ptr(), results.as_mut_ptr());
        }
    }
}

impl Drop for Function {
    fn drop(&mut self) {
        let module = self.module.get_mut().ok().and_then(Option::take);
        // SAFETY: the only address of the code is in `self`, of which there is no borrow any more.
        #[expect(unsafe_code, reason = "the memory of machine code is given back")]
        module.into_iter().for_each(|module| unsafe { module.free_memory() });
    }
}

impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Function")
            .field("lengths", &self.lengths)
            .field("results", &self.results)
            .finish_non_exhaustive()
    }
}
