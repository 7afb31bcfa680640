//! What differs between a recorded run and the one that is made now.
//!
//! In: the record, its samples, the run. Out: every difference as a sentence of its own: columns, instants, values,
//! counts.

use bg_model::run::Trajectory;
use bg_model::simulation::Recording;
use thiserror::Error;

use super::counts::Counts;
use super::file::{Record, key};
use super::run::RunFault;
use crate::ask::parameters::number;
use crate::run::compare::{Deviation, deviations};

/// The most columns whose deviations are listed.
const MOST: usize = 5;

/// A difference from what was recorded.
#[derive(Debug, Error)]
pub enum Difference {
    /// There is no run any more.
    #[error("{0}")]
    NoRun(RunFault),
    /// A recorded column that the model lacks.
    #[error("there is no output `{0}` any more")]
    Missing(String),
    /// A column that is not recorded.
    #[error("output `{0}` is new")]
    New(String),
    /// Another number of samples.
    #[error("{now} instants, recorded are {recorded}")]
    Samples {
        /// How many there are now.
        now: usize,
        /// How many are recorded.
        recorded: usize,
    },
    /// A sample at another time.
    #[error("instant {ordinal} is t = {} s, recorded is t = {} s", number(*now), number(*recorded))]
    Instant {
        /// Which, counted from 1.
        ordinal: usize,
        /// Its time now, s.
        now: f64,
        /// Its recorded time, s.
        recorded: f64,
    },
    /// A column that is too far off.
    #[error(
        "`{column}` at t = {} s is {}{unit}, recorded is {}{unit}: \
         {distance:.3e}{unit} apart, tolerance {tolerance:.3e}{unit}",
        number(*time), number(*now), number(*recorded)
    )]
    Value {
        /// The column.
        column: String,
        /// When it is farthest off, s.
        time: f64,
        /// The value now.
        now: f64,
        /// The recorded value.
        recorded: f64,
        /// How far these are apart.
        distance: f64,
        /// How far they may be.
        tolerance: f64,
        /// The unit after a space, or nothing.
        unit: String,
    },
    /// Further columns that are too far off.
    #[error("{0} more outputs are beyond their tolerances")]
    More(usize),
    /// A column of a unit without a tolerance.
    #[error("`{column}` has the unit `{unit}`, for which no tolerance is stated")]
    NoTolerance {
        /// The column.
        column: String,
        /// Its unit.
        unit: String,
    },
    /// A count that is not the recorded one.
    #[error("{now} {what}, recorded are {recorded}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are now.
        now: u64,
        /// How many are recorded.
        recorded: u64,
    },
}

/// The deviation of a column and how far it may be off, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judged {
    pub deviation: Deviation,
    pub tolerance: f64,
}

impl Judged {
    /// The deviation in units of the tolerance: at most 1 where it is as recorded.
    pub fn ratio(&self) -> f64 {
        if self.deviation.largest == 0.0 { 0.0 } else { self.deviation.largest / self.tolerance }
    }

    /// A tolerance of zero lets zero pass; what is no number never does.
    fn is_within(&self) -> bool {
        self.deviation.largest <= self.tolerance
    }
}

/// The deviations of `now` from `samples`, the farthest off first, and all differences.
pub(super) fn differences(record: &Record, samples: &Recording, now: &Trajectory) -> (Vec<Judged>, Vec<Difference>) {
    let mut found = columns(samples, now);
    found.extend(instant(&samples.times, &now.times));
    let (judged, without) = judge(record, samples, now);
    found.extend(without);
    let beyond: Vec<&Judged> = judged.iter().filter(|judged| !judged.is_within()).collect();
    found.extend(beyond.iter().take(MOST).map(|judged| value(judged, samples, now)));
    found.extend((beyond.len() > MOST).then(|| Difference::More(beyond.len() - MOST)));
    found.extend(counts(&record.counts, &Counts::from(&now.statistics)));
    (judged, found)
}

fn columns(recorded: &Recording, now: &Recording) -> Vec<Difference> {
    let missing = recorded.columns.iter().filter(|column| !now.has(&column.name));
    let missing = missing.map(|column| Difference::Missing(column.name.clone()));
    let new = now.columns.iter().filter(|column| !recorded.has(&column.name));
    missing.chain(new.map(|column| Difference::New(column.name.clone()))).collect()
}

/// The first instant that differs; else a difference of their number.
fn instant(recorded: &[f64], now: &[f64]) -> Option<Difference> {
    if let Some(index) = now.iter().zip(recorded).position(|(now, recorded)| now != recorded) {
        return Some(Difference::Instant { ordinal: index + 1, now: now[index], recorded: recorded[index] });
    }
    let is_same = now.len() == recorded.len();
    (!is_same).then_some(Difference::Samples { now: now.len(), recorded: recorded.len() })
}

/// The deviation of each column that both have, the farthest off first; and the columns without tolerance.
fn judge(record: &Record, samples: &Recording, now: &Recording) -> (Vec<Judged>, Vec<Difference>) {
    let all = deviations(now, samples);
    let (mut judged, mut without) = (Vec::new(), Vec::new());
    for deviation in &all {
        let unit = key(&deviation.unit);
        let Some(tolerance) = record.tolerances.get(unit) else {
            without.push(Difference::NoTolerance { column: deviation.name.clone(), unit: unit.to_owned() });
            continue;
        };
        let alike = all.iter().filter(|other| other.unit == deviation.unit);
        let largest = alike.map(|other| other.magnitude).filter(|value| value.is_finite()).fold(0.0, f64::max);
        let tolerance = tolerance.relative * largest + tolerance.absolute;
        judged.push(Judged { deviation: deviation.clone(), tolerance });
    }
    judged.sort_by(|a, b| b.ratio().total_cmp(&a.ratio()));
    (judged, without)
}

fn value(judged: &Judged, samples: &Recording, now: &Recording) -> Difference {
    let Judged { deviation: Deviation { name, unit, largest, time, .. }, tolerance } = judged;
    let of = |run: &Recording| {
        let index = run.times.iter().position(|t| t == time);
        index.and_then(|index| run.column(name)?.get(index).copied()).unwrap_or(f64::NAN)
    };
    Difference::Value {
        column: name.clone(),
        time: *time,
        now: of(now),
        recorded: of(samples),
        distance: *largest,
        tolerance: *tolerance,
        unit: if unit.is_empty() { String::new() } else { format!(" {unit}") },
    }
}

fn counts(recorded: &Counts, now: &Counts) -> Vec<Difference> {
    let pairs = now.named().into_iter().zip(recorded.named());
    let differing = pairs.filter(|(now, recorded)| now != recorded);
    differing.map(|((what, now), (_, recorded))| Difference::Count { what, now, recorded }).collect()
}
