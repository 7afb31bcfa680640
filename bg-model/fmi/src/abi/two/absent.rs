//! What these units do not have: variables of other types than Real, steps that go on after they return, derivatives of
//! inputs and outputs with respect to time. The functions are there, since a library without one of them is none.

use std::ffi::{c_char, c_int, c_void};

use super::super::{Handle, Status};
use super::Boolean;
use crate::instance::Fault;

/// Functions that are refused where `count` is not 0, or where they have none.
macro_rules! nothing {
    ($($name:ident($($argument:ident: $of:ty),*) where $none:expr, $what:literal;)*) => {$(
        #[doc = concat!("There are no ", $what, ".")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut c_void, $($argument: $of),*) -> Status {
            let refuse = |_: &mut crate::Instance| {
                if $none { Ok(()) } else { Err(Fault::Absent(concat!("the model has no ", $what).to_owned())) }
            };
            // SAFETY: an instance, as `Handle::call` says.
            unsafe { Handle::call(instance, refuse) }
        }
    )*};
}

nothing! {
    fmi2GetInteger(_references: *const u32, count: usize, _values: *mut c_int) where count == 0, "variables of the \
        type Integer";
    fmi2SetInteger(_references: *const u32, count: usize, _values: *const c_int) where count == 0, "variables of the \
        type Integer";
    fmi2GetBoolean(_references: *const u32, count: usize, _values: *mut Boolean) where count == 0, "variables of the \
        type Boolean";
    fmi2SetBoolean(_references: *const u32, count: usize, _values: *const Boolean) where count == 0, "variables of the \
        type Boolean";
    fmi2GetString(_references: *const u32, count: usize, _values: *mut *const c_char) where count == 0, "variables of \
        the type String";
    fmi2SetString(_references: *const u32, count: usize, _values: *const *const c_char) where count == 0, "variables \
        of the type String";
    fmi2SetRealInputDerivatives(_references: *const u32, count: usize, _orders: *const c_int,
        _values: *const f64) where count == 0,
        "inputs whose derivatives it takes";
    fmi2GetRealOutputDerivatives(_references: *const u32, count: usize, _orders: *const c_int,
        _values: *mut f64) where count == 0,
        "derivatives of outputs with respect to time";
    fmi2CancelStep() where false, "steps that go on after their call";
    fmi2GetStatus(_kind: c_int, _status: *mut Status) where false, "steps that go on after their call";
    fmi2GetIntegerStatus(_kind: c_int, _value: *mut c_int) where false, "whole number as a status";
    fmi2GetStringStatus(_kind: c_int, _text: *mut *const c_char) where false, "steps that go on after their call";
}
