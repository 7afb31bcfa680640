//! The functions of FMI 2.0. Most are those of FMI 3.0 under another name; truth values are whole numbers there.
//!
//! Source of names and types: Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.4, sections 2.1
//! (common), 3 (Model Exchange), 4 (Co-Simulation) and its headers.

mod absent;
mod common;
mod exchange;
mod steps;

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;

use percent_encoding::percent_decode_str;

use super::{Log, Logger};
use crate::instance::Interface;

/// `fmi2Boolean`.
type Boolean = c_int;

/// `fmi2CallbackLogger`: the host's environment, the instance's name, a status, a category, a format and what it asks
/// for.
pub type LogMessage =
    Option<unsafe extern "C" fn(*mut c_void, *const c_char, super::Status, *const c_char, *const c_char, ...)>;

/// `fmi2CallbackFunctions`. Memory is our own, and steps end before they return: only messages are called for.
#[derive(Debug)]
#[repr(C)]
pub struct Callbacks {
    logger: LogMessage,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// Where a unit's resources are, by the argument of FMI 2.0: a URI of a folder of this machine (2.0.4, section 2.1.5);
/// none of another, or where the host names none.
///
/// # Safety
/// The text ends with 0, or is null.
#[doc(hidden)]
#[must_use]
pub unsafe fn resources(uri: *const c_char) -> Option<PathBuf> {
    // SAFETY: not null, and it ends with 0.
    let uri = (!uri.is_null()).then(|| unsafe { CStr::from_ptr(uri) }.to_string_lossy())?;
    folder(&uri)
}

/// The folder of a URI such as `file:///C:/a%20b` or `file:/a`.
fn folder(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file:")?;
    let path = match rest.strip_prefix("//") {
        Some(rest) => rest.strip_prefix("localhost").unwrap_or(rest),
        None => rest,
    };
    let path = percent_decode_str(path).decode_utf8().ok()?;
    // Before the letter of a drive stands a stroke that is no part of the path.
    let with_drive = path.strip_prefix('/').filter(|rest| rest.get(1..2) == Some(":"));
    let path = with_drive.unwrap_or(&path);
    (path.starts_with('/') || with_drive.is_some()).then(|| path.into())
}

/// The instance of the model among those that are `found` that has this token, for an `fmi2Type`; null where there is
/// none.
///
/// # Safety
/// The texts end with 0, or are null; `callbacks` points to the host's functions, or is null.
#[doc(hidden)]
pub unsafe fn instantiate(
    found: impl FnOnce() -> super::Found,
    kind: c_int,
    name: *const c_char,
    token: *const c_char,
    callbacks: *const Callbacks,
    logging: c_int,
) -> *mut c_void {
    // SAFETY: null, or a text that ends with 0.
    let own = if name.is_null() { CString::default() } else { unsafe { CStr::from_ptr(name) }.to_owned() };
    // SAFETY: null, or the host's functions.
    let callbacks = unsafe { callbacks.as_ref() };
    let (log, environment) = callbacks.map_or((None, std::ptr::null_mut()), |all| (all.logger, all.environment));
    let logger = Logger { environment, log: Log::Two(log, own), is_on: logging != 0 };
    let interface = match kind {
        0 => Interface::ModelExchange,
        1 => Interface::CoSimulation,
        other => {
            logger.refuse(&format!(
                "an instance of the type {other} is asked for; there are 0, fmi2ModelExchange, and 1, fmi2CoSimulation"
            ));
            return std::ptr::null_mut();
        }
    };
    // SAFETY: the texts are as this function asks for.
    unsafe { super::instantiate(found, interface, name, token, logger) }
}

/// Functions whose arguments and meaning are those of a function of FMI 3.0.
macro_rules! as_in_three {
    ($($name:ident is $three:path, ($($argument:ident: $of:ty),*), $doc:literal;)*) => {$(
        #[doc = $doc]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut std::ffi::c_void $(, $argument: $of)*) -> crate::abi::Status {
            // SAFETY: what this standard asks of a host is what the other one does.
            unsafe { $three(instance $(, $argument)*) }
        }
    )*};
}
use as_in_three;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_of_folders_are_read() {
        let path = |path: &str| Some(PathBuf::from(path));
        assert_eq!(folder("file:///units/a%20b/resources"), path("/units/a b/resources"));
        assert_eq!(folder("file:/units/resources"), path("/units/resources"));
        assert_eq!(folder("file://localhost/units"), path("/units"));
        assert_eq!(folder("file:///C:/units/resources"), path("C:/units/resources"));
        assert_eq!(["file://elsewhere/units", "http://a/b", "/units", "file:"].map(folder), [None, None, None, None]);
    }
}
