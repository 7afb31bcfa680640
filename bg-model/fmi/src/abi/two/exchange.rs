//! Model Exchange: time, states, derivatives, event indicators, events.

use std::ffi::c_void;

use super::super::{Handle, Status, exchange, lifecycle, put};
use super::{Boolean, as_in_three};

/// `fmi2EventInfo`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct EventInfo {
    new_discrete_states_needed: Boolean,
    terminate_simulation: Boolean,
    nominals_changed: Boolean,
    states_changed: Boolean,
    next_event_defined: Boolean,
    next_event: f64,
}

as_in_three! {
    fmi2EnterEventMode is lifecycle::fmi3EnterEventMode, (), "Begins an event.";
    fmi2EnterContinuousTimeMode is exchange::fmi3EnterContinuousTimeMode, (), "Goes on after an event.";
    fmi2SetTime is exchange::fmi3SetTime, (time: f64), "Sets the time, s.";
    fmi2SetContinuousStates is exchange::fmi3SetContinuousStates, (states: *const f64, count: usize),
        "Sets the continuous states.";
    fmi2GetContinuousStates is exchange::fmi3GetContinuousStates, (states: *mut f64, count: usize),
        "Reads the continuous states.";
    fmi2GetDerivatives is exchange::fmi3GetContinuousStateDerivatives, (derivatives: *mut f64, count: usize),
        "Reads the derivatives of the continuous states.";
    fmi2GetEventIndicators is exchange::fmi3GetEventIndicators, (indicators: *mut f64, count: usize),
        "Reads the event indicators.";
    fmi2GetNominalsOfContinuousStates is exchange::fmi3GetNominalsOfContinuousStates, (nominals: *mut f64,
        count: usize),
        "The nominal values of the continuous states.";
}

/// Handles an event.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(instance: *mut c_void, info: *mut EventInfo) -> Status {
    let update = |own: &mut crate::Instance| {
        let update = own.update()?;
        let info_now = EventInfo {
            new_discrete_states_needed: 0,
            terminate_simulation: 0,
            nominals_changed: 0,
            states_changed: Boolean::from(update.states_changed),
            next_event_defined: Boolean::from(update.next_event.is_some()),
            next_event: update.next_event.unwrap_or(0.0),
        };
        // SAFETY: room for one value, as `Handle::call` says.
        unsafe { put(info, info_now) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, update) }
}

/// The host has completed a step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    instance: *mut c_void,
    _no_restore_before: Boolean,
    event_needed: *mut Boolean,
    terminate: *mut Boolean,
) -> Status {
    let complete = |own: &mut crate::Instance| {
        let needed = own.completed_step()?;
        // SAFETY: room for one value each, as `Handle::call` says.
        unsafe {
            put(event_needed, Boolean::from(needed));
            put(terminate, 0);
        }
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, complete) }
}
