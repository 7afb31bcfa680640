//! Machine code by the engine that runs this program: a module beside the program's own, which has its memory and its
//! functions.
//!
//! What runs the program instantiates such a module when it is asked for it, and puts its function into the program's
//! table of functions: there its place is the address of a function.

mod module;

use crate::function::Entry;
use crate::steps::Steps;
use module::module;

/// The engine.
pub struct Machine;

/// A function of a module.
pub struct Compiled(Entry);

#[expect(unsafe_code, reason = "functions of what runs the program")]
#[link(wasm_import_module = "env")]
unsafe extern "C" {
    /// Instantiates the module of these bytes and says where its function stands in the table; 0 where the engine
    /// refuses.
    safe fn bg_native_instantiate(bytes: *const u8, length: usize) -> usize;
    /// Takes a function out of the table.
    safe fn bg_native_release(entry: usize);
}

impl Machine {
    pub fn at_hand() -> Option<Self> {
        Some(Self)
    }

    /// The function of steps; none where the engine refuses it.
    pub fn compiled(&self, steps: &Steps) -> Option<Compiled> {
        let bytes = module(steps);
        let place = bg_native_instantiate(bytes.as_ptr(), bytes.len());
        if place == 0 {
            return None;
        }
        // SAFETY: at this place of the table stands a function with this signature, in the convention of `extern "C"`.
        #[expect(unsafe_code, reason = "a place in the table becomes a function")]
        let entry = unsafe { std::mem::transmute::<usize, Entry>(place) };
        Some(Compiled(entry))
    }
}

impl Compiled {
    pub fn entry(&self) -> Entry {
        self.0
    }
}

impl Drop for Compiled {
    fn drop(&mut self) {
        bg_native_release(self.0 as usize);
    }
}
