//! Versions, messages, the initialization, values, saved states.

use std::ffi::{c_char, c_void};

use super::super::{ERROR, Handle, OK, Status, lifecycle, room, saved, slice};
use super::{Boolean, as_in_three};

/// The sizes of numbers are those of the standard's own headers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// The version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Switches messages on or off. There is one category, whose messages are told in any case.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    instance: *mut c_void,
    is_on: Boolean,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { lifecycle::fmi3SetDebugLogging(instance, is_on != 0, count, categories) }
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(instance: *mut c_void) {
    // SAFETY: an instance that is used no more, or null.
    unsafe { lifecycle::fmi3FreeInstance(instance) }
}

/// Keeps start time and tolerance for the initialization.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    instance: *mut c_void,
    tolerance_defined: Boolean,
    tolerance: f64,
    start: f64,
    _stop_defined: Boolean,
    _stop: f64,
) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    let Some(handle) = (unsafe { instance.cast::<Handle>().as_mut() }) else { return ERROR };
    handle.experiment = (start, (tolerance_defined != 0).then_some(tolerance));
    OK
}

/// Begins the initialization.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    let Some(&mut Handle { experiment: (start, tolerance), .. }) = (unsafe { instance.cast::<Handle>().as_mut() })
    else {
        return ERROR;
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.enter_initialization(start, tolerance)) }
}

as_in_three! {
    fmi2ExitInitializationMode is lifecycle::fmi3ExitInitializationMode, (), "Ends the initialization.";
    fmi2Terminate is lifecycle::fmi3Terminate, (), "Ends the simulation.";
    fmi2GetFMUstate is saved::fmi3GetFMUState, (place: *mut *mut c_void), "Saves the state.";
    fmi2SetFMUstate is saved::fmi3SetFMUState, (saved: *mut c_void), "Restores a saved state.";
    fmi2FreeFMUstate is saved::fmi3FreeFMUState, (place: *mut *mut c_void), "Frees a saved state.";
    fmi2SerializedFMUstateSize is saved::fmi3SerializedFMUStateSize, (saved: *mut c_void, size: *mut usize),
        "The size of the bytes of a saved state.";
    fmi2SerializeFMUstate is saved::fmi3SerializeFMUState, (saved: *mut c_void, bytes: *mut u8, size: usize),
        "The bytes of a saved state.";
    fmi2DeSerializeFMUstate is saved::fmi3DeserializeFMUState, (bytes: *const u8, size: usize, place: *mut *mut c_void),
        "The saved state of these bytes.";
}

/// Back to where it was instantiated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    if let Some(handle) = unsafe { instance.cast::<Handle>().as_mut() } {
        handle.experiment = (0.0, None);
    }
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { lifecycle::fmi3Reset(instance) }
}

/// Reads variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
) -> Status {
    // SAFETY: an instance and arrays of this length, as `Handle::call` says.
    unsafe {
        let (references, values) = (slice(references, count), room(values, count));
        Handle::call(instance, |own| own.get(references, values))
    }
}

/// Sets variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
) -> Status {
    // SAFETY: an instance and arrays of this length, as `Handle::call` says.
    unsafe {
        let (references, values) = (slice(references, count), slice(values, count));
        Handle::call(instance, |own| own.set(references, values))
    }
}

/// Derivatives along a direction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    instance: *mut c_void,
    unknowns: *const u32,
    unknown_count: usize,
    knowns: *const u32,
    known_count: usize,
    seed: *const f64,
    sensitivity: *mut f64,
) -> Status {
    // SAFETY: an instance and arrays of these lengths, as `Handle::call` says.
    unsafe {
        let (unknowns, knowns) = (slice(unknowns, unknown_count), slice(knowns, known_count));
        let (seed, sensitivity) = (slice(seed, known_count), room(sensitivity, unknown_count));
        Handle::call(instance, |own| own.directional(unknowns, knowns, seed, sensitivity))
    }
}
