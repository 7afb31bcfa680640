//! Model Exchange: time, states, derivatives, event indicators, events.

use std::ffi::c_void;

use super::{Handle, Status, put, room, slice};

/// Sets the time, s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetTime(instance: *mut c_void, time: f64) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.set_time(time)) }
}

/// Sets the continuous states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetContinuousStates(instance: *mut c_void, states: *const f64, count: usize) -> Status {
    // SAFETY: an instance and an array of this length, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.set_states(slice(states, count))) }
}

/// Reads the continuous states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStates(instance: *mut c_void, states: *mut f64, count: usize) -> Status {
    // SAFETY: an instance and an array of this length, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.states(room(states, count))) }
}

/// Reads the derivatives of the continuous states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStateDerivatives(
    instance: *mut c_void,
    derivatives: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: an instance and an array of this length, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.derivatives(room(derivatives, count))) }
}

/// The nominal values of the continuous states: where the error norm of a run takes them to count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNominalsOfContinuousStates(
    instance: *mut c_void,
    nominals: *mut f64,
    count: usize,
) -> Status {
    // SAFETY: an instance and an array of this length, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.nominals(room(nominals, count))) }
}

/// Reads the event indicators.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetEventIndicators(instance: *mut c_void, indicators: *mut f64, count: usize) -> Status {
    // SAFETY: an instance and an array of this length, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.guards(room(indicators, count))) }
}

/// How many event indicators there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfEventIndicators(instance: *mut c_void, count: *mut usize) -> Status {
    let write = |own: &mut crate::Instance| {
        // SAFETY: room for one value, as `Handle::call` says.
        unsafe { put(count, own.guard_count()) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, write) }
}

/// How many continuous states there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfContinuousStates(instance: *mut c_void, count: *mut usize) -> Status {
    let write = |own: &mut crate::Instance| {
        // SAFETY: room for one value, as `Handle::call` says.
        unsafe { put(count, own.state_count()) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, write) }
}

/// The host has completed a step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3CompletedIntegratorStep(
    instance: *mut c_void,
    _no_restore_before: bool,
    event_needed: *mut bool,
    terminate: *mut bool,
) -> Status {
    let complete = |own: &mut crate::Instance| {
        let needed = own.completed_step()?;
        // SAFETY: room for one value each, as `Handle::call` says.
        unsafe {
            put(event_needed, needed);
            put(terminate, false);
        }
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, complete) }
}

/// Handles an event.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: *mut c_void,
    again: *mut bool,
    terminate: *mut bool,
    nominals_changed: *mut bool,
    states_changed: *mut bool,
    next_event_defined: *mut bool,
    next_event: *mut f64,
) -> Status {
    let update = |own: &mut crate::Instance| {
        let update = own.update()?;
        // SAFETY: room for one value each, as `Handle::call` says.
        unsafe {
            put(again, false);
            put(terminate, false);
            put(nominals_changed, false);
            put(states_changed, update.states_changed);
            put(next_event_defined, update.next_event.is_some());
            put(next_event, update.next_event.unwrap_or(0.0));
        }
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, update) }
}

/// There are no discrete states but the branches, which an update finds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EvaluateDiscreteStates(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |_| Ok(())) }
}

/// Goes on after an event.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterContinuousTimeMode(instance: *mut c_void) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.enter_continuous()) }
}
