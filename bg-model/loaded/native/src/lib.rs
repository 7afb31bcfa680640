//! Straight-line programs of models to machine code, while a program runs.
//!
//! In: a [`Program`] of flat single assignments. Out: a [`Function`] over slices, made by Cranelift for the machine at
//! hand; none where that has no back end. Each operation is the program's, nothing is fused, reordered in a sum or left
//! to another library: functions are those that [`bg_model::scalar::Scalar`] has for `f64`. So the values have the bits
//! of an interpreter and of code by rustc.
//!
//! | module | question it answers |
//! |---|---|
//! | `program` | what is translated |
//! | `steps` | which steps it takes, on numbers and on pairs of them; in which order, what of it is needed |
//! | `back_end` | where machine code is, how it is called: the one place with `unsafe` |
//! | `back_end::functions` | which functions machine code calls |
//! | `back_end::translate` | a program to instructions |
//! | `elsewhere` | what stands for `back_end` where there is none |

#[cfg(all(feature = "cranelift", any(target_arch = "x86_64", target_arch = "aarch64")))]
mod back_end;
#[cfg(not(all(feature = "cranelift", any(target_arch = "x86_64", target_arch = "aarch64"))))]
#[path = "elsewhere.rs"]
mod back_end;
#[cfg_attr(
    not(all(feature = "cranelift", any(target_arch = "x86_64", target_arch = "aarch64"))),
    allow(dead_code, reason = "what is not translated needs no lengths")
)]
mod program;
#[cfg(all(feature = "cranelift", any(target_arch = "x86_64", target_arch = "aarch64")))]
mod steps;

pub use back_end::Function;
pub use program::{Inputs, Operand, Pairing, Program};
