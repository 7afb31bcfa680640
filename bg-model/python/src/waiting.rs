//! How Ctrl-C reaches what runs without Python.
//!
//! In: something to do that asks from time to time whether to go on. Out: what it gives, or Python's
//! `KeyboardInterrupt`.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// Does `work` in another thread, without Python's lock; `work` is handed whether to go on.
///
/// # Errors
/// What Python's signal handlers raise meanwhile; `work` has ended then as well.
///
/// # Panics
/// `work` panics.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> T + Send,
) -> PyResult<T> {
    /// How often Python is asked.
    const PAUSE: Duration = Duration::from_millis(50);
    let goes_on = AtomicBool::new(true);
    py.detach(|| {
        thread::scope(|scope| {
            let (waiting, asked) = (thread::current(), &goes_on);
            let worker = thread::Builder::new().stack_size(8 << 20).spawn_scoped(scope, move || {
                let given = work(&|| asked.load(Ordering::Relaxed));
                waiting.unpark();
                given
            })?;
            let mut interrupted = Ok(());
            while !worker.is_finished() {
                thread::park_timeout(PAUSE);
                if interrupted.is_ok() {
                    interrupted = Python::attach(|py| py.check_signals());
                    goes_on.store(interrupted.is_ok(), Ordering::Relaxed);
                }
            }
            let given = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            interrupted.map(|()| given)
        })
    })
}
