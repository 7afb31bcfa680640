//! Co-Simulation: steps, and where they have come to.

use std::ffi::{c_int, c_void};

use super::super::{Handle, Status, put};
use super::Boolean;
use crate::instance::Fault;

/// `fmi2LastSuccessfulTime` and `fmi2Terminated` of `fmi2StatusKind`.
const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;

/// Makes a step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(instance: *mut c_void, t: f64, h: f64, _no_restore_before: Boolean) -> Status {
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, |own| own.step(t, h)) }
}

/// The time of the last good state, s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(instance: *mut c_void, kind: c_int, value: *mut f64) -> Status {
    let read = |own: &mut crate::Instance| {
        if kind != LAST_SUCCESSFUL_TIME {
            return Err(Fault::Absent(format!("the unit has no number for the status {kind}")));
        }
        let time = own.time()?;
        // SAFETY: room for one value, as `Handle::call` says.
        unsafe { put(value, time) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, read) }
}

/// The unit never ends a simulation by itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(instance: *mut c_void, kind: c_int, value: *mut Boolean) -> Status {
    let read = |_: &mut crate::Instance| {
        if kind != TERMINATED {
            return Err(Fault::Absent(format!("the unit has no truth value for the status {kind}")));
        }
        // SAFETY: room for one value, as `Handle::call` says.
        unsafe { put(value, 0) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, read) }
}
