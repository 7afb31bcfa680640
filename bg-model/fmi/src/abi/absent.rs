//! What these units do not have: variables of other types than Float64, clocks that a host activates, scheduled
//! execution, configuration, dependencies by call. The functions are there, since a library without one of them is
//! none.

use std::ffi::{c_char, c_void};

use super::{Handle, LogMessage, Logger, Status};
use crate::Instance;
use crate::instance::Fault;

/// Nothing is asked for, or there is none.
fn none(what: &str, count: usize) -> Result<(), Fault> {
    if count == 0 { Ok(()) } else { Err(Fault::Absent(format!("the model has no {what}"))) }
}

/// Access to variables of a type that no variable has.
macro_rules! no_variables {
    ($($get:ident $set:ident $of:ty, $name:literal;)*) => {$(
        #[doc = concat!("There are no variables of the type ", $name, ".")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            instance: *mut c_void,
            _references: *const u32,
            count: usize,
            _values: *mut $of,
            _value_count: usize,
        ) -> Status {
            // SAFETY: an instance, as `Handle::call` says.
            unsafe { Handle::call(instance, |_| none(concat!("variables of the type ", $name), count)) }
        }

        #[doc = concat!("There are no variables of the type ", $name, ".")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            instance: *mut c_void,
            _references: *const u32,
            count: usize,
            _values: *const $of,
            _value_count: usize,
        ) -> Status {
            // SAFETY: an instance, as `Handle::call` says.
            unsafe { Handle::call(instance, |_| none(concat!("variables of the type ", $name), count)) }
        }
    )*};
}

no_variables! {
    fmi3GetFloat32 fmi3SetFloat32 f32, "Float32";
    fmi3GetInt8 fmi3SetInt8 i8, "Int8";
    fmi3GetUInt8 fmi3SetUInt8 u8, "UInt8";
    fmi3GetInt16 fmi3SetInt16 i16, "Int16";
    fmi3GetUInt16 fmi3SetUInt16 u16, "UInt16";
    fmi3GetInt32 fmi3SetInt32 i32, "Int32";
    fmi3GetUInt32 fmi3SetUInt32 u32, "UInt32";
    fmi3GetInt64 fmi3SetInt64 i64, "Int64";
    fmi3GetUInt64 fmi3SetUInt64 u64, "UInt64";
    fmi3GetBoolean fmi3SetBoolean bool, "Boolean";
    fmi3GetString fmi3SetString *const c_char, "String";
}

/// A function that asks about `count` of something that there is none of.
macro_rules! nothing {
    ($($name:ident($($argument:ident: $of:ty),*), $what:literal;)*) => {$(
        #[doc = concat!("There are no ", $what, ".")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            instance: *mut c_void,
            _references: *const u32,
            count: usize,
            $($argument: $of),*
        ) -> Status {
            // SAFETY: an instance, as `Handle::call` says.
            unsafe { Handle::call(instance, |_| none($what, count)) }
        }
    )*};
}

nothing! {
    fmi3GetBinary(_sizes: *mut usize, _values: *mut *const u8, _value_count: usize), "variables of the type Binary";
    fmi3SetBinary(_sizes: *const usize, _values: *const *const u8, _value_count: usize), "variables of the type Binary";
    fmi3SetClock(_values: *const bool), "clocks that a host activates";
    fmi3GetIntervalDecimal(_intervals: *mut f64, _qualifiers: *mut i32), "clocks with an interval";
    fmi3GetIntervalFraction(_counters: *mut u64, _resolutions: *mut u64, _qualifiers: *mut i32), "clocks with an \
        interval";
    fmi3GetShiftDecimal(_shifts: *mut f64), "clocks with an interval";
    fmi3GetShiftFraction(_counters: *mut u64, _resolutions: *mut u64), "clocks with an interval";
    fmi3SetIntervalDecimal(_intervals: *const f64), "clocks with an interval";
    fmi3SetIntervalFraction(_counters: *const u64, _resolutions: *const u64), "clocks with an interval";
    fmi3SetShiftDecimal(_shifts: *const f64), "clocks with an interval";
    fmi3SetShiftFraction(_counters: *const u64, _resolutions: *const u64), "clocks with an interval";
    fmi3GetOutputDerivatives(_orders: *const i32, _values: *mut f64, _value_count: usize), "derivatives of outputs \
        with respect to time";
}

/// A function that is for units of another kind.
macro_rules! refused {
    ($($name:ident($($argument:ident: $of:ty),*), $why:literal;)*) => {$(
        #[doc = concat!("Refused: ", $why, ".")]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut c_void $(, $argument: $of)*) -> Status {
            // SAFETY: an instance, as `Handle::call` says.
            unsafe { Handle::call(instance, |_: &mut Instance| Err(Fault::Absent($why.to_owned()))) }
        }
    )*};
}

refused! {
    fmi3EnterConfigurationMode(), "the unit has no structural parameters";
    fmi3ExitConfigurationMode(), "the unit has no structural parameters";
    fmi3EnterStepMode(), "the unit has no event mode in Co-Simulation";
    fmi3ActivateModelPartition(_clock: u32, _time: f64), "the unit has no model partitions";
    fmi3GetNumberOfVariableDependencies(_dependent: u32, _count: *mut usize),
        "the dependencies are those of modelDescription.xml";
    fmi3GetVariableDependencies(
        _dependent: u32, _elements: *mut usize, _independents: *mut u32, _of: *mut usize, _kinds: *mut i32,
            _count: usize
    ), "the dependencies are those of modelDescription.xml";
}

/// There is no scheduled execution.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    logging: bool,
    environment: *mut c_void,
    log: LogMessage,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    Logger::new(environment, log, logging).refuse("this unit is for Model Exchange and Co-Simulation");
    std::ptr::null_mut()
}
