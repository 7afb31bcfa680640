//! How Ctrl-C reaches what runs without Python, and how far it is.
//!
//! In: something to do that says from time to time how far it is, and asks whether to go on. Out: what it gives, or
//! Python's `KeyboardInterrupt`.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// How often Python is asked.
const PAUSE: Duration = Duration::from_millis(50);
/// What takes less has no bar.
const SHORT: Duration = Duration::from_secs(1);
/// The parts of a bar.
const PARTS: f64 = 1000.0;

/// Something to do, as it sees who waits for it.
pub struct Seen {
    goes_on: AtomicBool,
    /// In parts of a thousand.
    done: AtomicU32,
}

impl Seen {
    /// Whether to go on.
    pub fn goes_on(&self) -> bool {
        self.goes_on.load(Ordering::Relaxed)
    }

    /// Says which part is done, 0 to 1. Whether to go on.
    pub fn done(&self, part: f64) -> bool {
        self.done.store((PARTS * part) as u32, Ordering::Relaxed);
        self.goes_on()
    }
}

/// A bar of tqdm, where that is there: in a notebook or on a terminal.
#[derive(Default)]
struct Bar(Option<Py<PyAny>>);

impl Bar {
    fn shown(py: Python<'_>) -> PyResult<Self> {
        let Ok(tqdm) = py.import("tqdm.auto") else { return Ok(Self(None)) };
        let options = PyDict::new(py);
        options.set_item("total", PARTS)?;
        options.set_item("leave", false)?;
        options.set_item("bar_format", "{percentage:3.0f}%|{bar}| {elapsed}<{remaining}")?;
        // Without a terminal there is none, but for a notebook.
        let is_notebook = py.import("sys")?.getattr("modules")?.contains("ipykernel")?;
        options.set_item("disable", is_notebook.then_some(false))?;
        Ok(Self(Some(tqdm.call_method("tqdm", (), Some(&options))?.unbind())))
    }

    fn set(&self, py: Python<'_>, done: u32) -> PyResult<()> {
        let Some(bar) = self.0.as_ref().map(|bar| bar.bind(py)) else { return Ok(()) };
        bar.call_method1("update", (f64::from(done) - bar.getattr("n")?.extract::<f64>()?,)).map(drop)
    }

    fn close(self, py: Python<'_>) -> PyResult<()> {
        self.0.map_or(Ok(()), |bar| bar.bind(py).call_method0("close").map(drop))
    }
}

/// Does `work` in another thread, without Python's lock; `work` is handed who waits. What takes long has a bar, if it says
/// how far it is.
///
/// # Errors
/// What Python's signal handlers raise meanwhile; `work` has ended then as well.
///
/// # Panics
/// `work` panics.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(&Seen) -> T + Send) -> PyResult<T> {
    let seen = Seen { goes_on: AtomicBool::new(true), done: AtomicU32::new(0) };
    py.detach(|| {
        thread::scope(|scope| {
            let (waiting, seen) = (thread::current(), &seen);
            let worker = thread::Builder::new().stack_size(8 << 20).spawn_scoped(scope, move || {
                let given = work(seen);
                waiting.unpark();
                given
            })?;
            let (mut interrupted, mut bar, start) = (Ok(()), None, Instant::now());
            while !worker.is_finished() {
                thread::park_timeout(PAUSE);
                if interrupted.is_err() {
                    continue;
                }
                let done = seen.done.load(Ordering::Relaxed);
                interrupted = Python::attach(|py| {
                    py.check_signals()?;
                    if bar.is_none() && done > 0 && start.elapsed() > SHORT {
                        bar = Some(Bar::shown(py)?);
                    }
                    bar.as_ref().map_or(Ok(()), |bar| bar.set(py, done))
                });
                seen.goes_on.store(interrupted.is_ok(), Ordering::Relaxed);
            }
            let given = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            Python::attach(|py| bar.unwrap_or_default().close(py))?;
            interrupted.map(|()| given)
        })
    })
}
