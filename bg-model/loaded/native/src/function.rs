//! A program that machine code evaluates.

use std::fmt;

use crate::back_end::{Compiled, Machine};
use crate::program::{Inputs, Lengths, Program};
use crate::steps::Steps;

/// Longer programs are not translated: how long registers are sought for grows faster than the program.
const LONGEST: usize = 20_000;

/// What machine code is: it reads what is fixed, states, other numbers and branches, and writes results.
pub(crate) type Entry = unsafe extern "C" fn(*const f64, *const f64, *const f64, *const bool, *mut f64);

/// A program in machine code.
pub struct Function {
    compiled: Compiled,
    lengths: Lengths,
    results: usize,
    appended: Vec<(u32, bool)>,
    operations: usize,
}

impl Function {
    /// A program in machine code; none where there is no back end for the machine, where it takes no more code, or
    /// where the program is longer than 20 000 operations.
    ///
    /// # Panics
    /// An operation takes a value that does not come before it.
    #[must_use]
    pub fn of(program: &Program) -> Option<Self> {
        let machine = Machine::at_hand().filter(|_| program.operations.len() <= LONGEST)?;
        let mut lengths = program.lengths();
        let steps = Steps::of(program, lengths.fixed);
        lengths.fixed += steps.appended.len();
        let (compiled, operations) = (machine.compiled(&steps)?, steps.operations());
        Some(Self { compiled, lengths, results: program.results.len(), appended: steps.appended, operations })
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
        // the slices do not overlap, as one of them is borrowed to be written; the code is there until `self` is
        // dropped.
        #[expect(unsafe_code, reason = "machine code is called")]
        unsafe {
            (self.compiled.entry())(
                fixed.as_ptr(),
                states.as_ptr(),
                read.as_ptr(),
                negative.as_ptr(),
                results.as_mut_ptr(),
            );
        }
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
