//! What a co-simulation of the hacksaw costs a host, beside our own run: prints a table.
//!
//! ```sh
//! cargo build --release --target-dir target --manifest-path hacksaw/fmu/Cargo.toml
//! cargo run --release --target-dir target --manifest-path hacksaw/fmu/Cargo.toml --example host
//! ```
//!
//! A host as small as one can be: it opens the library and calls the functions of the standard. 5 s of the scene
//! `motion` at 1e-8; an output is read after every step. Times are the least of [`RUNS`] runs that take turns, so that
//! all see the same machine. With `-- COUNT` one run of FMI 3.0 in so many steps a second and nothing else, for
//! callgrind.

use std::error::Error;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;
use std::ptr::{null, null_mut};
use std::time::Instant;

use bg_fmi::bg_model::run::Simulation;
use bg_fmi::{Of, Packing, model_description, token};
use hacksaw::mechanism::{Motion, MotionParameters};
use libloading::{Library, Symbol};

const T_END: f64 = 5.0;
const RUNS: usize = 40;
/// Communication steps, as many to a second.
const STEPS: [u32; 4] = [1, 100, 1000, 2000];
/// What is read after each step.
const OUTPUT: &str = "C3_x";

type Outcome<T> = Result<T, Box<dyn Error>>;
type Instance = *mut c_void;

fn main() -> Outcome<()> {
    // SAFETY: the library is this package's own and does nothing when it is loaded.
    let library = unsafe { Library::new(library()) }?;
    let model = &Of::<Motion>::NEW;
    let host = Host { library, token: CString::new(token(model))?, output: reference(model)? };
    if let Some(per_second) = std::env::args().nth(1) {
        println!("{OUTPUT} = {:?} m", host.three(per_second.parse()?)?);
        return Ok(());
    }
    let own_model = Motion::new(MotionParameters::default())?;
    let own = || -> Outcome<f64> {
        let run = Simulation::new(&own_model).every(0.01).until(T_END).run()?;
        Ok(run[OUTPUT].last().copied().unwrap_or(f64::NAN))
    };
    let mut least = vec![[f64::INFINITY; 2]; STEPS.len()];
    let (mut alone, mut off) = (f64::INFINITY, 0.0_f64);
    for _ in 0..RUNS {
        let (wanted, time) = timed(own)?;
        alone = alone.min(time);
        for (least, per_second) in least.iter_mut().zip(STEPS) {
            let runs = [timed(|| host.three(per_second))?, timed(|| host.two(per_second))?];
            for (least, (found, time)) in least.iter_mut().zip(runs) {
                *least = least.min(time);
                off = off.max((found - wanted).abs());
            }
        }
    }
    println!("our own run, 501 samples: {:.2} ms; ends agree to {off:.0e} m", alone * 1e3);
    println!("{:>8} {:>14} {:>6} {:>14} {:>6}", "step, ms", "FMI 3.0, ms", "ratio", "FMI 2.0, ms", "ratio");
    for ([three, two], per_second) in least.into_iter().zip(STEPS) {
        let step = 1e3 / f64::from(per_second);
        println!("{step:>8} {:>14.2} {:>6.2} {:>14.2} {:>6.2}", three * 1e3, three / alone, two * 1e3, two / alone);
    }
    Ok(())
}

/// What `run` gives, and the time that it takes, s.
fn timed(run: impl FnOnce() -> Outcome<f64>) -> Outcome<(f64, f64)> {
    let begin = Instant::now();
    let value = run()?;
    Ok((value, begin.elapsed().as_secs_f64()))
}

/// The library of this package, which cargo builds above its examples.
fn library() -> PathBuf {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let program = std::env::current_exe().unwrap_or_default();
    let folder = program.ancestors().nth(2).map(PathBuf::from).unwrap_or_default();
    folder.join(format!("{DLL_PREFIX}hacksaw_fmu{DLL_SUFFIX}"))
}

/// The value reference of the output, which the description has.
fn reference(model: &Of<Motion>) -> Outcome<u32> {
    let text = model_description(model, &Packing::default());
    let after = text.split(&format!("name=\"{OUTPUT}\" valueReference=\"")).nth(1).ok_or("no such output")?;
    Ok(after.split('"').next().unwrap_or_default().parse()?)
}

/// A library and what it is asked for.
struct Host {
    library: Library,
    token: CString,
    output: u32,
}

impl Host {
    fn function<T>(&self, name: &CStr) -> Outcome<Symbol<'_, T>> {
        // SAFETY: the standard gives the function of this name this type; the library outlives what it is used for.
        Ok(unsafe { self.library.get(name.to_bytes_with_nul()) }?)
    }

    /// The output after 5 s by FMI 3.0.
    fn three(&self, per_second: u32) -> Outcome<f64> {
        type Instantiate = unsafe extern "C" fn(
            *const c_char,
            *const c_char,
            *const c_char,
            bool,
            bool,
            bool,
            bool,
            *const u32,
            usize,
            *mut c_void,
            *const c_void,
            *const c_void,
        ) -> Instance;
        type DoStep =
            unsafe extern "C" fn(Instance, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> c_int;
        let instantiate: Symbol<'_, Instantiate> = self.function(c"fmi3InstantiateCoSimulation")?;
        let enter: Symbol<'_, unsafe extern "C" fn(Instance, bool, f64, f64, bool, f64) -> c_int> =
            self.function(c"fmi3EnterInitializationMode")?;
        let exit: Symbol<'_, unsafe extern "C" fn(Instance) -> c_int> = self.function(c"fmi3ExitInitializationMode")?;
        let step: Symbol<'_, DoStep> = self.function(c"fmi3DoStep")?;
        let get: Symbol<'_, unsafe extern "C" fn(Instance, *const u32, usize, *mut f64, usize) -> c_int> =
            self.function(c"fmi3GetFloat64")?;
        let free: Symbol<'_, unsafe extern "C" fn(Instance)> = self.function(c"fmi3FreeInstance")?;
        let (mut value, h) = (f64::NAN, 1.0 / f64::from(per_second));
        let (mut event, mut end, mut early, mut reached) = (false, false, false, 0.0);
        // SAFETY: as the standard wants it: the calls in this order, room for what is written, an instance that is
        // freed once.
        let status = unsafe {
            let token = self.token.as_ptr();
            let unit = instantiate(
                c"one".as_ptr(),
                token,
                null(),
                false,
                false,
                false,
                false,
                null(),
                0,
                null_mut(),
                null(),
                null(),
            );
            let mut status = enter(unit, false, 0.0, 0.0, false, 0.0) | exit(unit);
            for k in 0..steps(per_second) {
                status |= step(unit, f64::from(k) * h, h, true, &mut event, &mut end, &mut early, &mut reached);
                status |= get(unit, &self.output, 1, &mut value, 1);
            }
            free(unit);
            status
        };
        if status == 0 { Ok(value) } else { Err("a call has failed".into()) }
    }

    /// The output after 5 s by FMI 2.0.
    fn two(&self, per_second: u32) -> Outcome<f64> {
        #[repr(C)]
        struct Callbacks([*const c_void; 5]);
        type Instantiate = unsafe extern "C" fn(
            *const c_char,
            c_int,
            *const c_char,
            *const c_char,
            *const Callbacks,
            c_int,
            c_int,
        ) -> Instance;
        const CO_SIMULATION: c_int = 1;
        let instantiate: Symbol<'_, Instantiate> = self.function(c"fmi2Instantiate")?;
        let enter: Symbol<'_, unsafe extern "C" fn(Instance) -> c_int> =
            self.function(c"fmi2EnterInitializationMode")?;
        let exit: Symbol<'_, unsafe extern "C" fn(Instance) -> c_int> = self.function(c"fmi2ExitInitializationMode")?;
        let step: Symbol<'_, unsafe extern "C" fn(Instance, f64, f64, c_int) -> c_int> =
            self.function(c"fmi2DoStep")?;
        let get: Symbol<'_, unsafe extern "C" fn(Instance, *const u32, usize, *mut f64) -> c_int> =
            self.function(c"fmi2GetReal")?;
        let free: Symbol<'_, unsafe extern "C" fn(Instance)> = self.function(c"fmi2FreeInstance")?;
        let (mut value, h) = (f64::NAN, 1.0 / f64::from(per_second));
        let callbacks = Callbacks([null(); 5]);
        // SAFETY: as above; there are no functions for messages and memory, which the unit does without.
        let status = unsafe {
            let token = self.token.as_ptr();
            let unit = instantiate(c"one".as_ptr(), CO_SIMULATION, token, null(), &callbacks, 0, 0);
            let mut status = enter(unit) | exit(unit);
            for k in 0..steps(per_second) {
                status |= step(unit, f64::from(k) * h, h, 1) | get(unit, &self.output, 1, &mut value);
            }
            free(unit);
            status
        };
        if status == 0 { Ok(value) } else { Err("a call has failed".into()) }
    }
}

fn steps(per_second: u32) -> u32 {
    (T_END as u32) * per_second
}
