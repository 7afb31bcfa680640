//! Machine code by Cranelift.

mod translate;

use std::sync::{Arc, LazyLock, Mutex};

use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::default_libcall_names;

use crate::function::Entry;
use crate::functions::{SINE_AND_COSINE, called, sine_and_cosine};
use crate::steps::Steps;
use translate::translate;

/// The machine at hand.
pub struct Machine(&'static OwnedTargetIsa);

/// The machine code of a program.
pub struct Compiled {
    entry: Entry,
    /// What holds the memory, until this is dropped.
    module: Mutex<Option<JITModule>>,
}

/// None where there is no back end for the machine.
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

impl Machine {
    /// None where there is no back end for it.
    pub fn at_hand() -> Option<Self> {
        MACHINE.as_ref().map(Self)
    }

    /// The machine code of steps; none where the machine gives no memory for it.
    pub fn compiled(&self, steps: &Steps) -> Option<Compiled> {
        let mut builder = JITBuilder::with_isa(Arc::clone(self.0), default_libcall_names());
        builder.symbol(SINE_AND_COSINE, sine_and_cosine as *const u8);
        for called in steps.calls().filter_map(|(_, function, _)| called(function)) {
            builder.symbol(called.name, called.address);
        }
        let mut module = JITModule::new(builder);
        let id = translate(&mut module, steps)?;
        module.finalize_definitions().ok()?;
        let address = module.get_finalized_function(id);
        // SAFETY: the function has been translated with this signature, in the convention of `extern "C"`.
        #[expect(unsafe_code, reason = "an address becomes a function")]
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(address) };
        Some(Compiled { entry, module: Mutex::new(Some(module)) })
    }
}

impl Compiled {
    pub fn entry(&self) -> Entry {
        self.entry
    }
}

impl Drop for Compiled {
    fn drop(&mut self) {
        let module = self.module.get_mut().ok().and_then(Option::take);
        // SAFETY: the only address of the code is in `self`, of which there is no borrow any more.
        #[expect(unsafe_code, reason = "the memory of machine code is given back")]
        module.into_iter().for_each(|module| unsafe { module.free_memory() });
    }
}
