//! Straight-line programs of models to machine code, while a program runs.
//!
//! In: a [`Program`] of flat single assignments. Out: a [`Function`] over slices, made by Cranelift for the machine at
//! hand, or, where this program is WebAssembly, by the engine that runs it; none where there is no back end. Each
//! operation is the program's, nothing is fused, reordered in a sum or left to another library: functions are those
//! that [`bg_model::scalar::Scalar`] has for `f64`. So the values have the bits of an interpreter and of code by rustc.
//!
//! | module | question it answers |
//! |---|---|
//! | `program` | what is translated |
//! | `function` | how machine code is called |
//! | `steps` | which steps it takes, on numbers and on pairs of them; in which order, what of it is needed |
//! | `functions` | which functions it calls |
//! | `cranelift` | where machine code is on x86-64 and aarch64; `translate`: steps to instructions |
//! | `webassembly` | where it is in WebAssembly; `module`: steps to the bytes of a module |
//! | `elsewhere` | what stands for these where there is no back end |

#[cfg(all(feature = "machine-code", any(target_arch = "x86_64", target_arch = "aarch64")))]
#[path = "cranelift/mod.rs"]
mod back_end;
#[cfg(all(feature = "machine-code", target_arch = "wasm32"))]
#[path = "webassembly/mod.rs"]
mod back_end;
#[cfg(not(all(
    feature = "machine-code",
    any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "wasm32")
)))]
#[path = "elsewhere.rs"]
mod back_end;
mod function;
#[cfg(all(feature = "machine-code", any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "wasm32")))]
mod functions;
mod program;
#[cfg_attr(
    not(all(feature = "machine-code", any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "wasm32"))),
    allow(dead_code, reason = "what is not translated needs no instructions")
)]
mod steps;

pub use function::Function;
pub use program::{Inputs, Operand, Pairing, Program};
