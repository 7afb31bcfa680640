//! `bond_graph!` models as functional mock-up units (FMU): FMI 3.0 or 2.0, Model Exchange and Co-Simulation in one
//! file.
//!
//! A unit is a dynamic library and `modelDescription.xml` in an archive. The library is a package of a few lines, of
//! `crate-type = ["cdylib"]`:
//!
//! ```
//! use bg_model::bond_graph;
//!
//! bond_graph! {
//!     /// A mass on a spring, pushed by a given force.
//!     pub graph Oscillator {
//!         param mass: kg = 2, above 0;
//!         param stiffness: N/m = 50, above 0;
//!         input force: N;
//!         Se push = force;
//!         1 slide: translation;
//!         I body = mass; C spring = stiffness start 0.1;
//!         push -> slide -> body; slide -> spring;
//!         observe { x: m = spring.q; }
//!     }
//! }
//!
//! bg_fmi::export!(Oscillator);
//! ```
//!
//! A program of `bg-workbench` packs it by its command `fmu`. What a unit can do and what it cannot: `docs/fmu.md`.
//!
//! | module | question it answers |
//! |---|---|
//! | [`instance`] | what an instance of a model does: the whole interface, in safe Rust |
//! | [`exported`] | what an instance needs of a model |
//! | [`description`] | what `modelDescription.xml` and `terminalsAndIcons.xml` say |
//! | [`archive`] | what a unit's file has in it |
//! | [`abi`] | the functions of the standard: pointers in, slices on |

pub mod abi;
pub mod archive;
pub mod description;
pub mod exported;
pub mod instance;
mod units;
pub mod variables;

pub use bg_model;
pub use description::{Packing, Version, model_description, terminals_and_icons, token};
pub use exported::{AtDefaults, Described, Exported, MadeBy, Of};
pub use instance::{Fault, Instance, Interface};

/// The category of log messages.
pub(crate) const LOG_ERROR: &str = "logStatusError";

/// Exports models, named by their types, from a library of `crate-type = ["cdylib"]`: graphs and scenes. Which of them
/// an instance is of, its `modelDescription.xml` says. Once in a library.
#[macro_export]
macro_rules! export {
    ($($model:ty),+ $(,)?) => {
        $crate::export_found!(|_| Ok(vec![$(&$crate::Of::<$model>::NEW as &dyn $crate::Exported),+]));
    };
}

/// Exports the models that are found in the folder of a unit's resources: by a function of that folder, where the host
/// names one, that gives them or says why there are none. Once in a library.
#[macro_export]
macro_rules! export_found {
    ($found:expr) => {
        const _: () = {
            fn models_of_resources(
                resources: Option<::std::path::PathBuf>,
            ) -> ::core::result::Result<::std::vec::Vec<&'static dyn $crate::Exported>, ::std::string::String> {
                ($found)(resources)
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateModelExchange(
                name: *const ::core::ffi::c_char,
                token: *const ::core::ffi::c_char,
                resources: *const ::core::ffi::c_char,
                _visible: bool,
                logging: bool,
                environment: *mut ::core::ffi::c_void,
                log: $crate::abi::LogMessage,
            ) -> *mut ::core::ffi::c_void {
                let logger = $crate::abi::Logger::new(environment, log, logging);
                // SAFETY: the host hands over texts that end with 0, or none.
                unsafe {
                    let resources = $crate::abi::resources(resources);
                    let interface = $crate::Interface::ModelExchange;
                    $crate::abi::instantiate(|| models_of_resources(resources), interface, name, token, logger)
                }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateCoSimulation(
                name: *const ::core::ffi::c_char,
                token: *const ::core::ffi::c_char,
                resources: *const ::core::ffi::c_char,
                _visible: bool,
                logging: bool,
                events: bool,
                _early: bool,
                _intermediate: *const u32,
                intermediate_count: usize,
                environment: *mut ::core::ffi::c_void,
                log: $crate::abi::LogMessage,
                _update: *const ::core::ffi::c_void,
            ) -> *mut ::core::ffi::c_void {
                let logger = $crate::abi::Logger::new(environment, log, logging);
                if events || intermediate_count > 0 {
                    logger.refuse("this unit has no event mode and no intermediate variables in Co-Simulation");
                    return ::core::ptr::null_mut();
                }
                // SAFETY: the host hands over texts that end with 0, or none.
                unsafe {
                    let resources = $crate::abi::resources(resources);
                    $crate::abi::instantiate(
                        || models_of_resources(resources),
                        $crate::Interface::CoSimulation,
                        name,
                        token,
                        logger,
                    )
                }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi2Instantiate(
                name: *const ::core::ffi::c_char,
                kind: ::core::ffi::c_int,
                token: *const ::core::ffi::c_char,
                resources: *const ::core::ffi::c_char,
                callbacks: *const $crate::abi::two::Callbacks,
                _visible: ::core::ffi::c_int,
                logging: ::core::ffi::c_int,
            ) -> *mut ::core::ffi::c_void {
                // SAFETY: the host hands over texts that end with 0, or none, and its functions, or none.
                unsafe {
                    let resources = $crate::abi::two::resources(resources);
                    $crate::abi::two::instantiate(
                        || models_of_resources(resources),
                        kind,
                        name,
                        token,
                        callbacks,
                        logging,
                    )
                }
            }
        };
    };
}
