//! Calls as a host makes them, on a model whose start panics.

use std::cell::RefCell;
use std::ptr::null_mut;

use bg_model::description::Description;
use bg_model::parameters::ParameterError;

use super::lifecycle::{
    fmi3EnterInitializationMode, fmi3ExitInitializationMode, fmi3FreeInstance, fmi3GetVersion, fmi3Reset,
};
use super::saved::{fmi3DeserializeFMUState, fmi3FreeFMUState, fmi3GetFMUState};
use super::values::fmi3GetFloat64;
use super::*;
use crate::exported::{Described, Made, sealed};
use crate::instance::Signals;

thread_local! {
    static LOG: RefCell<Vec<(Status, String)>> = const { RefCell::new(Vec::new()) };
}

unsafe extern "C" fn log(_: *mut c_void, status: Status, _: *const c_char, message: *const c_char) {
    // SAFETY: `Logger` hands over texts that end with 0.
    let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
    LOG.with_borrow_mut(|log| log.push((status, message)));
}

struct Panics;

impl Described for Panics {
    fn description(&self) -> &'static Description {
        static NOTHING: std::sync::LazyLock<Description> = std::sync::LazyLock::new(Description::default);
        &NOTHING
    }
    fn nominals(&self) -> Option<Vec<f64>> {
        None
    }

    fn dependencies(&self) -> Option<Vec<Vec<usize>>> {
        None
    }

    fn delays(&self) -> bool {
        false
    }

    fn clocks(&self) -> Vec<usize> {
        Vec::new()
    }
}

impl sealed::Make for Panics {
    fn make(&self, _: &[f64], _: &Signals, _: f64) -> Result<Made, Fault> {
        panic!("no number of {}", 0)
    }
    fn check(&self, _: usize, _: f64) -> Result<(), ParameterError> {
        Ok(())
    }
}

impl Exported for Panics {
    fn described(&self) -> &dyn Described {
        self
    }
}

fn instance(token: &str) -> *mut c_void {
    let (token, logger) = (CString::new(token).unwrap(), Logger::new(null_mut(), Some(log), false));
    // SAFETY: the token ends with 0.
    unsafe {
        instantiate(
            || Ok(vec![&Panics as &dyn Exported]),
            Interface::CoSimulation,
            std::ptr::null(),
            token.as_ptr(),
            logger,
        )
    }
}

#[test]
fn a_panic_ends_the_instance_and_not_the_host() {
    let own = instance(&description::token(&Panics));
    assert!(!own.is_null());
    // SAFETY: an instance that is used by nobody else, and then no more.
    let codes = unsafe {
        let entered = fmi3EnterInitializationMode(own, false, 0.0, 0.0, false, 0.0);
        let (exited, reset) = (fmi3ExitInitializationMode(own), fmi3Reset(own));
        fmi3FreeInstance(own);
        [entered, exited, reset]
    };
    assert_eq!(codes, [OK, FATAL, FATAL]);
    assert_eq!(LOG.take(), [(FATAL, "the model is lost: no number of 0".to_owned())]);
}

#[test]
fn a_state_without_a_place_is_an_error() {
    let own = instance(&description::token(&Panics));
    // SAFETY: an instance that is used by nobody else, and then no more.
    let codes = unsafe {
        let mut place = null_mut();
        let codes = [
            fmi3GetFMUState(own, null_mut()),
            fmi3GetFMUState(own, &raw mut place),
            fmi3DeserializeFMUState(own, c"{}".as_ptr().cast(), 2, null_mut()),
            fmi3FreeFMUState(own, &raw mut place),
        ];
        fmi3FreeInstance(own);
        codes
    };
    assert_eq!(codes, [ERROR, OK, ERROR, OK]);
    let told = (ERROR, "this is no saved state of this model: there is no place for it".to_owned());
    assert_eq!(LOG.take(), [told.clone(), told]);
}

#[test]
fn what_is_no_instance_is_an_error() {
    assert!(instance("{another}").is_null());
    let told = LOG.take();
    assert!(told.len() == 1 && told[0].1.contains("no model with the instantiation token {another}"), "{told:?}");
    // SAFETY: null is looked for; the version is a text that ends with 0.
    let (code, version) = unsafe {
        fmi3FreeInstance(null_mut());
        (fmi3ExitInitializationMode(null_mut()), CStr::from_ptr(fmi3GetVersion()))
    };
    assert_eq!((code, version), (ERROR, c"3.0"));
}

#[test]
fn refusals_are_told_to_the_host() {
    let own = instance(&description::token(&Panics));
    let (references, mut values) = ([7_u32], [0.0]);
    // SAFETY: an instance that is used by nobody else, arrays of the lengths given.
    let code = unsafe { fmi3GetFloat64(own, references.as_ptr(), 1, values.as_mut_ptr(), 1) };
    assert_eq!(code, ERROR);
    assert_eq!(LOG.take(), [(ERROR, "there is no variable with the value reference 7".to_owned())]);
    // SAFETY: it is used no more.
    unsafe { fmi3FreeInstance(own) };
}
