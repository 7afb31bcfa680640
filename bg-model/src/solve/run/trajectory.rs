//! What a run gives: its samples as columns by name, what it took, and the state from which it can go on.

use std::io::{self, Write};
use std::ops::{Deref, Index};
use std::time::Duration;

use thiserror::Error;

use super::{Request, RunError, Simulation, State};
use crate::model::holding::Redundancy;
use crate::model::mechanism::Mechanism;
use crate::solve::failure::Cause;
use crate::solve::finish::Ended;
use crate::solve::integrator::{Change, Integrator};
use crate::solve::simulation::{Column, Recording, Samples};
use crate::solve::statistics::Statistics;

/// A run: its samples (it can be used as its [`Recording`]) and what it took.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// The samples.
    pub recording: Recording,
    /// Why it ended.
    pub ended: Ended,
    /// Steps, evaluations, factorisations, events.
    pub statistics: Statistics,
    /// The states whose errors were never controlled: smaller than their absolute tolerance all the time, and no
    /// rounding.
    pub uncontrolled: Vec<&'static str>,
    /// The methods that made the steps, from when (s) on; the first from the start.
    pub methods: Vec<Change>,
    /// Time on the wall clock; zero in WebAssembly, which has none.
    pub wall: Duration,
    /// The rigid joints that hold what others hold already: they share reactions of least norm.
    pub redundant: Vec<Redundancy>,
    /// The kinetic energy that impulses of rigid joints took at the start, J.
    pub impulse_energy: f64,
    /// Where the run has come to.
    pub last: State,
    /// What was asked for.
    pub request: Request,
}

/// A run that stopped before its end.
#[derive(Debug, Error)]
#[error("{cause}")]
pub struct Stopped {
    /// Why.
    pub cause: Cause,
    /// What was reached.
    pub trajectory: Trajectory,
}

impl Deref for Trajectory {
    type Target = Recording;

    fn deref(&self) -> &Recording {
        &self.recording
    }
}

impl Index<&str> for Trajectory {
    type Output = [f64];

    /// The values of the column called `name`, one for each of `times`.
    ///
    /// # Panics
    /// There is no such column; [`Recording::column`] says so by `None`.
    fn index(&self, name: &str) -> &[f64] {
        let names = || self.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ");
        self.column(name).unwrap_or_else(|| panic!("the run has no column `{name}`; it has {}", names()))
    }
}

impl Trajectory {
    /// Goes on to `t_end` (s) from where the run has come to, and appends what is sampled. `model` may have other
    /// parameters: what stays are the states (momenta, not velocities), and what sticks or rests as far as it can.
    ///
    /// # Errors
    /// As [`Simulation::run`]; what was reached is appended then as well.
    pub fn continue_until<Me: Mechanism>(&mut self, model: &Me, t_end: f64) -> Result<(), RunError> {
        let mut request = Request { t_end, ..self.request.clone() };
        if let Samples::At(instants) = &mut request.samples {
            // Those before have been sampled.
            instants.retain(|instant| *instant >= self.last.t);
        }
        match Simulation::of(model, request).from(&self.last).run() {
            Ok(more) => self.append(more),
            Err(RunError::Stopped(stopped)) => {
                let Stopped { cause, trajectory } = *stopped;
                self.append(trajectory);
                return Err(RunError::Stopped(Box::new(Stopped { cause, trajectory: self.clone() })));
            }
            Err(fault) => return Err(fault),
        }
        Ok(())
    }

    /// The method by which `auto` made the longest part of the run: what a run of the like may begin with
    /// ([`Request::hint`]). None where another integrator was asked for.
    #[must_use]
    pub fn hint(&self) -> Option<Integrator> {
        let ends = self.methods.iter().skip(1).map(|change| change.t).chain([self.last.t]);
        let parts: Vec<(&str, f64)> =
            self.methods.iter().zip(ends).map(|(change, end)| (change.method, end - change.t)).collect();
        let whole = |method: &str| parts.iter().filter(|(of, _)| *of == method).map(|(_, part)| part).sum::<f64>();
        let longest = parts.iter().map(|(method, _)| *method).max_by(|a, b| whole(a).total_cmp(&whole(b)));
        longest.filter(|_| self.request.method == Integrator::Auto).and_then(Integrator::of_auto)
    }

    /// Appends a run that started where this one has come to.
    fn append(&mut self, more: Self) {
        let known = self.times.last().copied();
        let is_new = |t: f64| known.is_none_or(|known| t > known);
        for (index, &t) in more.times.iter().enumerate().filter(|(_, t)| is_new(**t)) {
            self.recording.push(t, more.row(index));
        }
        for (column, more) in self.recording.columns.iter_mut().zip(&more.recording.columns) {
            column.peaks = column.peaks.zip(more.peaks).map(|(known, more)| known.and(more));
            column.settled = match (column.settled, more.settled) {
                (Some(known), Some(more)) => Some(known.and(more)),
                (known, more) => known.or(more),
            };
        }
        self.recording.events.extend(&more.recording.events);
        let known = self.methods.last().map(|change| change.method);
        let is_new = |(index, change): &(usize, &Change)| *index > 0 || Some(change.method) != known;
        let changes = more.methods.iter().enumerate().filter(is_new).map(|(_, change)| *change);
        self.methods.extend(changes);
        self.statistics.add(&more.statistics);
        self.uncontrolled.retain(|state| more.uncontrolled.contains(state));
        self.wall += more.wall;
        self.last = more.last;
        self.ended = more.ended;
        self.request.t_end = more.request.t_end;
    }
}

impl Recording {
    /// Writes a CSV file: `t` and all columns, every number in the shortest form that reads back to the same bits.
    ///
    /// # Errors
    /// A failure of `writer`.
    pub fn write_csv(&self, writer: impl Write) -> io::Result<()> {
        write_table("t", self.columns.iter().map(|column| (column.name.as_str(), column)), &self.times, writer)
    }

    /// Writes the same with the unit of each column in its head, as in `t [s],speed [rpm]`. A pure number has none.
    ///
    /// # Errors
    /// A failure of `writer`.
    pub fn write_csv_with_units(&self, writer: impl Write) -> io::Result<()> {
        let head = |column: &Column| match column.unit.as_str() {
            "" => column.name.clone(),
            unit => format!("{} [{unit}]", column.name),
        };
        write_table("t [s]", self.columns.iter().map(|column| (head(column), column)), &self.times, writer)
    }
}

/// Writes the times under the head `t` and the columns under theirs.
fn write_table<'c, H: AsRef<str>>(
    t: &str,
    columns: impl Iterator<Item = (H, &'c Column)>,
    times: &[f64],
    writer: impl Write,
) -> io::Result<()> {
    let (heads, columns): (Vec<H>, Vec<&Column>) = columns.unzip();
    let mut csv = csv::Writer::from_writer(writer);
    csv.write_record(std::iter::once(t).chain(heads.iter().map(AsRef::as_ref)))?;
    for (index, t) in times.iter().enumerate() {
        csv.write_field(shortest(*t))?;
        for column in &columns {
            csv.write_field(shortest(column.values[index]))?;
        }
        csv.write_record(None::<&[u8]>)?;
    }
    csv.flush()
}

/// The shortest decimal form that reads back to the same bits, with an exponent where that is shorter.
fn shortest(value: f64) -> String {
    format!("{value:?}")
}
