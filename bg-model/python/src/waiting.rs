//! How Ctrl-C reaches what runs without Python, and how far it is.
//!
//! In: something to do that says from time to time how far it is, and asks whether to go on. Out: what it gives, or
//! Python's `KeyboardInterrupt`.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use bg_model::run::{Interrupt, Progress};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// How often Python is asked.
const PAUSE: Duration = Duration::from_millis(50);
/// What takes less has no bar.
const SHORT: Duration = Duration::from_secs(1);
/// How long an end is waited for.
const PATIENCE: Duration = Duration::from_millis(300);
/// The parts of a bar.
const PARTS: f64 = 1000.0;

/// Something to do, as it sees who waits for it.
#[derive(Default)]
pub struct Seen {
    interrupt: Interrupt,
    /// Of what knows how much it is.
    progress: Progress,
    /// Runs that have been made, of what does not know how many it needs.
    runs: AtomicU32,
}

impl Seen {
    /// Whether to go on.
    pub fn goes_on(&self) -> bool {
        !self.interrupt.is_set()
    }

    /// What ends the runs that are made meanwhile.
    pub fn interrupt(&self) -> Interrupt {
        self.interrupt.clone()
    }

    /// What tells how far it is.
    pub fn progress(&self) -> Progress {
        self.progress.clone()
    }

    /// Says which part is done, 0 to 1. Whether to go on.
    pub fn done(&self, part: f64) -> bool {
        self.progress.tell(part);
        self.goes_on()
    }

    /// Says that one run more has been made. Whether to go on.
    pub fn counted(&self) -> bool {
        self.runs.fetch_add(1, Ordering::Relaxed);
        self.goes_on()
    }

    /// How far it is; none where it has not said anything.
    fn reached(&self) -> Option<Reached> {
        let (part, runs) = (self.progress.done(), self.runs.load(Ordering::Relaxed));
        if part > 0.0 { Some(Reached::Part(part)) } else { (runs > 0).then_some(Reached::Runs(runs)) }
    }
}

/// How far something is.
#[derive(Clone, Copy)]
enum Reached {
    /// The part of it, 0 to 1.
    Part(f64),
    /// So many runs, of any number.
    Runs(u32),
}

impl Reached {
    /// In a bar's steps.
    fn steps(self) -> f64 {
        match self {
            Self::Part(part) => (PARTS * part).floor(),
            Self::Runs(runs) => f64::from(runs),
        }
    }
}

/// A bar of tqdm, where that is there: in a notebook or on a terminal.
#[derive(Default)]
struct Bar(Option<Py<PyAny>>);

impl Bar {
    fn shown(py: Python<'_>, reached: Reached) -> PyResult<Self> {
        let Ok(tqdm) = py.import("tqdm.auto") else { return Ok(Self(None)) };
        let (total, format) = match reached {
            Reached::Part(_) => (Some(PARTS), "{percentage:3.0f}%|{bar}| {elapsed}<{remaining}"),
            Reached::Runs(_) => (None, "{n_fmt} runs, {elapsed}"),
        };
        let options = PyDict::new(py);
        options.set_item("total", total)?;
        options.set_item("leave", false)?;
        options.set_item("bar_format", format)?;
        // Without a terminal there is none, but for a notebook.
        let is_notebook = py.import("sys")?.getattr("modules")?.contains("ipykernel")?;
        options.set_item("disable", is_notebook.then_some(false))?;
        Ok(Self(Some(tqdm.call_method("tqdm", (), Some(&options))?.unbind())))
    }

    fn set(&self, py: Python<'_>, reached: Reached) -> PyResult<()> {
        let Some(bar) = self.0.as_ref().map(|bar| bar.bind(py)) else { return Ok(()) };
        bar.call_method1("update", (reached.steps() - bar.getattr("n")?.extract::<f64>()?,)).map(drop)
    }

    fn close(self, py: Python<'_>) -> PyResult<()> {
        self.0.map_or(Ok(()), |bar| bar.bind(py).call_method0("close").map(drop))
    }
}

/// Does `work` in another thread, without Python's lock; `work` is handed who waits. What takes long has a bar, if it
/// says how far it is. After Ctrl-C runs end with their step; what does not ask for so long as [`PATIENCE`] is left to
/// itself: a text being compiled, eigenvalues. It comes to its end unseen, and what it gives is dropped.
///
/// # Errors
/// What Python's signal handlers raise meanwhile.
///
/// # Panics
/// `work` panics.
pub fn interruptible<T: Send + 'static>(py: Python<'_>, work: impl FnOnce(&Seen) -> T + Send + 'static) -> PyResult<T> {
    let seen = Arc::new(Seen::default());
    py.detach(|| {
        let (waiting, seen_by_work) = (thread::current(), Arc::clone(&seen));
        let worker = thread::Builder::new().stack_size(8 << 20).spawn(move || {
            let given = work(&seen_by_work);
            waiting.unpark();
            given
        })?;
        let (mut bar, start) = (None, Instant::now());
        let interrupted = loop {
            if worker.is_finished() {
                break Ok(());
            }
            thread::park_timeout(PAUSE);
            let told = Python::attach(|py| {
                py.check_signals()?;
                let Some(reached) = seen.reached().filter(|_| start.elapsed() > SHORT) else { return Ok(()) };
                if bar.is_none() {
                    bar = Some(Bar::shown(py, reached)?);
                }
                bar.as_ref().map_or(Ok(()), |bar| bar.set(py, reached))
            });
            if told.is_err() {
                break told;
            }
        };
        seen.interrupt.interrupt();
        let end = Instant::now();
        while !worker.is_finished() && end.elapsed() < PATIENCE {
            thread::park_timeout(PAUSE);
        }
        Python::attach(|py| bar.unwrap_or_default().close(py))?;
        interrupted.map(|()| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}
