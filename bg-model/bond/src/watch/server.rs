//! The page, and what it asks for.
//!
//! | address | answer |
//! |---|---|
//! | `/` | the page |
//! | `/state?after=N` | what there is to show, as JSON; after some seconds, or as soon as it is no longer the state `N` |
//! | `/report` | the newest report |
//! | `/report.css`, `/beside.js`, `/report.js` | its style and scripts |

use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bg_workbench::page::BESIDE;
use bond_graph::serve::{ServeFault, answering, header, kind};
use serde::Serialize;
use tiny_http::{Request, Response};

/// The page around the report.
const PAGE: &str = include_str!("page.html");
/// The longest that a question for the state waits.
const WAIT: Duration = Duration::from_secs(20);

/// What there is to show.
#[derive(Debug, Default, Serialize)]
struct State {
    /// Counts its changes.
    number: u64,
    file: String,
    /// Counts the reports; 0 before the first one.
    report: u64,
    is_making: bool,
    /// What is wrong with the file as it is.
    fault: Option<String>,
    #[serde(skip)]
    page: String,
}

/// The state, for what makes it and what shows it.
#[derive(Debug)]
pub struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

impl Shared {
    /// Nothing yet of this file.
    pub fn of(file: &Path) -> Self {
        let state = State { file: file.display().to_string(), ..State::default() };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    /// A report is being made.
    pub fn begin(&self) {
        self.change(|state| state.is_making = true);
    }

    /// It is there.
    pub fn show(&self, page: String) {
        self.change(|state| {
            *state = State { page, report: state.report + 1, is_making: false, fault: None, ..std::mem::take(state) };
        });
    }

    /// There is none of the file as it is; the one before stays.
    pub fn fail(&self, told: String) {
        self.change(|state| (state.is_making, state.fault) = (false, Some(told)));
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.now();
        change(&mut state);
        state.number += 1;
        self.changed.notify_all();
    }

    fn now(&self) -> MutexGuard<'_, State> {
        // A state is written whole or not at all.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state as JSON, as soon as it is another one than `after`.
    fn after(&self, after: Option<u64>) -> String {
        let is_known = |state: &mut State| Some(state.number) == after;
        let waited = self.changed.wait_timeout_while(self.now(), WAIT, is_known);
        let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        serde_json::to_string(&*state).expect("texts and numbers")
    }
}

/// Starts to answer, by [`answering`]; gives the address of the page.
///
/// # Errors
/// The port cannot be had.
pub fn start(port: u16, shared: Arc<Shared>) -> Result<String, ServeFault> {
    answering(port, move |request| answer(request, &shared))
}

fn answer(request: Request, shared: &Shared) {
    let (path, query) = request.url().split_once('?').unwrap_or((request.url(), ""));
    let (text, kind) = match path {
        "/" => (PAGE.to_owned(), "text/html; charset=utf-8"),
        "/state" => {
            let after = query.strip_prefix("after=").and_then(|number| number.parse().ok());
            (shared.after(after), "application/json")
        }
        "/report" => (shared.now().page.clone(), "text/html; charset=utf-8"),
        path => match BESIDE.iter().find(|(name, _)| path.strip_prefix('/') == Some(name)) {
            Some((name, text)) => ((*text).to_owned(), kind(name)),
            None => return drop(request.respond(Response::empty(404))),
        },
    };
    let response = Response::from_string(text).with_header(header("Content-Type", kind));
    // A browser that has gone away is no fault.
    let _ = request.respond(response.with_header(header("Cache-Control", "no-store")));
}
