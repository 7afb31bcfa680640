//! From the start of an instance to its end, and the steps of Co-Simulation.

use std::ffi::{c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{ERROR, Handle, OK, Status, put};

/// The version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Switches messages on or off. There is one category, whose messages are told in any case.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    is_on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    let Some(handle) = (unsafe { instance.cast::<Handle>().as_mut() }) else { return ERROR };
    handle.logger.is_on = is_on;
    OK
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: it comes from `Box::into_raw` and is used no more.
        let handle = unsafe { Box::from_raw(instance.cast::<Handle>()) };
        // What a panic says here nobody can be told.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(handle)));
    }
}

/// Begins the initialization.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    tolerance_defined: bool,
    tolerance: f64,
    start: f64,
    _stop_defined: bool,
    _stop: f64,
) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.enter_initialization(start, tolerance_defined.then_some(tolerance))) }
}

/// Ends the initialization.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.exit_initialization()) }
}

/// Begins an event.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterEventMode(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.enter_event()) }
}

/// Ends the simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.terminate()) }
}

/// Back to where it was instantiated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: *mut c_void) -> Status {
    let reset = |own: &mut crate::Instance| {
        own.reset();
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, reset) }
}

/// Makes a step of Co-Simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    t: f64,
    h: f64,
    _no_restore_before: bool,
    event_needed: *mut bool,
    terminate: *mut bool,
    early_return: *mut bool,
    reached: *mut f64,
) -> Status {
    let step = |own: &mut crate::Instance| {
        let outcome = own.step(t, h);
        let time = own.time().unwrap_or(t);
        // SAFETY: room for one value each, as `Handle::call` says.
        unsafe {
            put(event_needed, false);
            put(terminate, false);
            put(early_return, false);
            put(reached, time);
        }
        outcome
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, step) }
}
