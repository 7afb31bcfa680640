//! The functions of FMI 3.0 and 2.0, as a host finds them in a library: pointers in, slices on to [`Instance`].
//!
//! In: calls of a host. Out: a status; on an error or worse a sentence in its log. A panic ends here as the status
//! Fatal; of an instance that has panicked only what frees it works. Source of names and types: FMI 3.0.1, sections 2.2
//! to 4 and its headers; for `two` FMI 2.0.4. The functions that make instances are in [`export!`](crate::export) and
//! `absent`.

#![allow(non_snake_case, reason = "the names are those of the standard")]
#![allow(clippy::missing_safety_doc, reason = "the caller is a host that keeps to the standard, see `Handle::call`")]

mod absent;
mod exchange;
mod lifecycle;
mod saved;
#[cfg(test)]
mod tests;
pub mod two;
mod values;

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use crate::LOG_ERROR;
use crate::description;
use crate::exported::Exported;
use crate::instance::{Fault, Instance, Interface};

/// `fmi3Status` and `fmi2Status`, whose numbers are the same.
pub type Status = c_int;
/// All well.
const OK: Status = 0;
/// Something cannot be calculated where the instance stands: a host may try a smaller step.
const DISCARD: Status = 2;
/// The call failed, the instance can be reset or restored.
const ERROR: Status = 3;
/// The instance is lost.
const FATAL: Status = 4;

/// `fmi3LogMessageCallback`: the host's environment, a status, a category, a message.
pub type LogMessage = Option<unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char)>;

/// Where messages go.
#[derive(Clone, Debug)]
pub struct Logger {
    environment: *mut c_void,
    log: Log,
    is_on: bool,
}

/// A host's function for messages.
#[derive(Clone, Debug)]
enum Log {
    /// Of FMI 3.0.
    Three(LogMessage),
    /// Of FMI 2.0, with the instance's name.
    Two(two::LogMessage, CString),
}

impl Logger {
    /// A logger of these arguments of an instantiation.
    #[must_use]
    pub const fn new(environment: *mut c_void, log: LogMessage, is_on: bool) -> Self {
        Self { environment, log: Log::Three(log), is_on }
    }

    /// Says why there is no instance.
    pub fn refuse(&self, message: &str) {
        self.say(ERROR, message);
    }

    fn say(&self, status: Status, message: &str) {
        if !self.is_on && status < DISCARD {
            return;
        }
        let text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
        let (category, message) = (text(LOG_ERROR), text(message));
        match &self.log {
            // SAFETY: the host gave this function with this environment, for as long as the instance lives.
            Log::Three(Some(log)) => unsafe { log(self.environment, status, category.as_ptr(), message.as_ptr()) },
            // SAFETY: as above; what comes after the format is what the format asks for.
            Log::Two(Some(log), name) => unsafe {
                log(self.environment, name.as_ptr(), status, category.as_ptr(), c"%s".as_ptr(), message.as_ptr());
            },
            Log::Three(None) | Log::Two(None, _) => {}
        }
    }
}

/// What an `fmi3Instance` or `fmi2Component` points to.
struct Handle {
    instance: Instance,
    logger: Logger,
    is_lost: bool,
    /// Start time, s, and relative tolerance, where a call before the initialization has given them.
    experiment: (f64, Option<f64>),
}

impl Handle {
    /// Calls `then` with the instance that `pointer` points to.
    ///
    /// # Safety
    /// As the standard asks of a host: `pointer` is null or comes from an instantiation and has not been freed, and no
    /// other call with it is under way. Arrays have the lengths that are given with them, results have room.
    unsafe fn call(pointer: *mut c_void, then: impl FnOnce(&mut Instance) -> Result<(), Fault>) -> Status {
        // SAFETY: not freed and not in use, by the above.
        let Some(handle) = (unsafe { pointer.cast::<Self>().as_mut() }) else { return ERROR };
        if handle.is_lost {
            return FATAL;
        }
        let instance = &mut handle.instance;
        match catch_unwind(AssertUnwindSafe(|| then(instance))) {
            Ok(Ok(())) => OK,
            Ok(Err(fault)) => {
                let status = if matches!(fault, Fault::NoNumber(_)) { DISCARD } else { ERROR };
                handle.logger.say(status, &fault.to_string());
                status
            }
            Err(panic) => {
                handle.is_lost = true;
                handle.logger.say(FATAL, &format!("the model is lost: {}", told(&*panic)));
                FATAL
            }
        }
    }
}

/// What a panic says.
fn told(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("a fault inside")
}

/// Where a unit's resources are, by the argument of FMI 3.0: the path of a folder; none where the host names none.
///
/// # Safety
/// The text ends with 0, or is null.
#[doc(hidden)]
#[must_use]
pub unsafe fn resources(path: *const c_char) -> Option<PathBuf> {
    // SAFETY: not null, and it ends with 0.
    (!path.is_null()).then(|| unsafe { CStr::from_ptr(path) }.to_string_lossy().into_owned().into())
}

/// The models that a library has for an instance, or why it has none.
pub type Found = Result<Vec<&'static dyn Exported>, String>;

/// The instance of the model among those that are `found` that has this token; null where there is none.
///
/// # Safety
/// The texts end with 0, or are null.
#[doc(hidden)]
pub unsafe fn instantiate(
    found: impl FnOnce() -> Found,
    interface: Interface,
    _name: *const c_char,
    token: *const c_char,
    logger: Logger,
) -> *mut c_void {
    if token.is_null() {
        logger.refuse("no instantiation token is given");
        return std::ptr::null_mut();
    }
    // SAFETY: not null, and it ends with 0.
    let token = unsafe { CStr::from_ptr(token) }.to_string_lossy();
    let made = catch_unwind(AssertUnwindSafe(|| {
        let model = found()?.into_iter().find(|model| description::token(model.described()) == token);
        let model = model.ok_or_else(|| {
            format!(
                "this library has no model with the instantiation token {token}: its modelDescription.xml is of \
                 another build; pack the unit again"
            )
        })?;
        let instance = Instance::new(model, interface);
        Ok::<_, String>(Box::new(Handle { instance, logger: logger.clone(), is_lost: false, experiment: (0.0, None) }))
    }));
    match made {
        Ok(Ok(handle)) => Box::into_raw(handle).cast(),
        Ok(Err(fault)) => {
            logger.refuse(&fault);
            std::ptr::null_mut()
        }
        Err(panic) => {
            logger.say(FATAL, told(&*panic));
            std::ptr::null_mut()
        }
    }
}

/// The `count` values at `pointer`; none where it is null.
///
/// # Safety
/// As of [`std::slice::from_raw_parts`], but that it may be null.
unsafe fn slice<'a, T>(pointer: *const T, count: usize) -> &'a [T] {
    // SAFETY: not null, and as long as the caller says.
    if pointer.is_null() || count == 0 { &[] } else { unsafe { std::slice::from_raw_parts(pointer, count) } }
}

/// The room for `count` values at `pointer`; none where it is null.
///
/// # Safety
/// As of [`std::slice::from_raw_parts_mut`], but that it may be null.
unsafe fn room<'a, T>(pointer: *mut T, count: usize) -> &'a mut [T] {
    // SAFETY: not null, as long as the caller says, and nothing else looks at it during the call.
    if pointer.is_null() || count == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(pointer, count) } }
}

/// Writes a result where the host wants one.
///
/// # Safety
/// `pointer` is null or points to room for one value.
unsafe fn put<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: not null, room for one value.
        unsafe { pointer.write(value) }
    }
}
