//! Values of variables and their derivatives: all variables but clocks are of the type Float64.

use std::ffi::c_void;

use super::{Handle, Status, room, slice};

/// Reads variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    reference_count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    // SAFETY: an instance and arrays of these lengths, as `Handle::call` says.
    unsafe {
        let (references, values) = (slice(references, reference_count), room(values, value_count));
        Handle::call(instance, |own| own.get(references, values))
    }
}

/// Reads whether clocks tick.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetClock(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut bool,
) -> Status {
    // SAFETY: an instance and arrays of this length, as `Handle::call` says.
    unsafe {
        let (references, values) = (slice(references, count), room(values, count));
        Handle::call(instance, |own| own.ticks(references, values))
    }
}

/// Sets variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    reference_count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    // SAFETY: an instance and arrays of these lengths, as `Handle::call` says.
    unsafe {
        let (references, values) = (slice(references, reference_count), slice(values, value_count));
        Handle::call(instance, |own| own.set(references, values))
    }
}

/// Derivatives along a direction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: *mut c_void,
    unknowns: *const u32,
    unknown_count: usize,
    knowns: *const u32,
    known_count: usize,
    seed: *const f64,
    seed_count: usize,
    sensitivity: *mut f64,
    sensitivity_count: usize,
) -> Status {
    // SAFETY: an instance and arrays of these lengths, as `Handle::call` says.
    unsafe {
        let (unknowns, knowns) = (slice(unknowns, unknown_count), slice(knowns, known_count));
        let (seed, sensitivity) = (slice(seed, seed_count), room(sensitivity, sensitivity_count));
        Handle::call(instance, |own| own.directional(unknowns, knowns, seed, sensitivity))
    }
}

/// Derivatives against a direction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetAdjointDerivative(
    instance: *mut c_void,
    unknowns: *const u32,
    unknown_count: usize,
    knowns: *const u32,
    known_count: usize,
    seed: *const f64,
    seed_count: usize,
    sensitivity: *mut f64,
    sensitivity_count: usize,
) -> Status {
    // SAFETY: an instance and arrays of these lengths, as `Handle::call` says.
    unsafe {
        let (unknowns, knowns) = (slice(unknowns, unknown_count), slice(knowns, known_count));
        let (seed, sensitivity) = (slice(seed, seed_count), room(sensitivity, sensitivity_count));
        Handle::call(instance, |own| own.adjoint(unknowns, knowns, seed, sensitivity))
    }
}
