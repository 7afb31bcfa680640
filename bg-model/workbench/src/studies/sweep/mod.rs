//! Runs of a model for many values of its parameters, into files that grow shard by shard.
//!
//! In: a [`Plan`], a folder. Out: for each shard of some hundred runs a Parquet file with a row for each run, and if
//! wanted one with all trajectories. A shard's bytes depend on the plan alone: not on the number of threads, on who
//! else works on the sweep or on how often it was stopped. A shard that is there is not made again.
//!
//! | module | question |
//! |---|---|
//! | [`plan`] | what is asked for, checked |
//! | [`design`] | which values the parameters have in each run |
//! | [`distribution`] | how values of parameters are spread, and correlated |
//! | [`wanted`] | what is kept of a run |
//! | [`recipe`] | whether two sweeps are the same |
//! | [`runs`] | the runs of a shard, as tables |
//! | [`lanes`] | the same runs side by side |
//! | [`folder`] | which shards there are |
//! | [`shown`] | what a folder has |
//! | [`statistics`] | how a number is spread, and which parameter spreads it |
//! | [`drawn`] | what a sweep looks like: a page |

pub mod campbell;
pub mod design;
pub mod distribution;
pub mod drawn;
pub mod folder;
pub mod lanes;
pub mod plan;
pub mod recipe;
pub mod runs;
pub mod shown;
pub mod statistics;
pub mod wanted;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use thiserror::Error;

use crate::files::FileError;
use crate::program::Program;
use folder::{Folder, FolderError, ShardFile};
use plan::{Plan, PlanError};
use runs::{Done, Job};

/// The columns that every sweep has.
const OWN_COLUMNS: [&str; 6] = ["run", "status", "reason", "reached", "steps", "events"];
/// Runs of each thread until files are written: the last ones of them keep a thread waiting for the others.
const RUNS_OF_A_THREAD: usize = 100;
/// The stack of a thread, as the first one of a program has it: steps of large models have their matrices there.
const STACK: usize = 8 << 20;

/// A sweep that does not come to its end.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The plan cannot be followed.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The folder is another sweep's, or none.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// An unusable share.
    #[error("--shard {0}: give it as i/n, such as 3/8 for the third of eight parts")]
    Share(String),
    /// No threads.
    #[error("the system gives no threads: {0}; try --threads 1")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Every n-th shard, beginning with the i-th: the work of one of n processes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    index: usize,
    of: usize,
}

impl Share {
    /// All shards.
    pub const ALL: Self = Self { index: 0, of: 1 };

    /// Part `i` of `n`, counted from 1.
    #[must_use]
    pub fn new(i: usize, n: usize) -> Option<Self> {
        (1..=n).contains(&i).then(|| Self { index: i - 1, of: n })
    }

    /// Reads `i/n`.
    ///
    /// # Errors
    /// [`SweepError::Share`].
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        numbers.and_then(|(i, n)| Self::new(i, n)).ok_or_else(|| SweepError::Share(text.to_owned()))
    }

    /// Whether `shard` is of this part.
    const fn has(self, shard: usize) -> bool {
        shard % self.of == self.index
    }
}

/// What came of a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// The runs of the whole sweep.
    pub runs: usize,
    /// Its shards.
    pub shards: usize,
    /// The shards of this part.
    pub own: usize,
    /// Those of them that were there before.
    pub found: usize,
    /// Those that were made now.
    pub made: usize,
    /// The runs that were made now.
    pub made_runs: usize,
    /// Those of them that failed.
    pub failed: usize,
    /// Whether the shards of all parts are there now, some of them by this process: it is the last one.
    pub is_last: bool,
}

/// Is told how many runs of how many are done, and says whether to go on.
pub type Told<'a> = &'a (dyn Fn(usize, usize) -> bool + Sync);

/// Makes the runs of `plan` that are of `share` and not in `folder` yet, on so many threads; 0 are as many as there are
/// cores.
///
/// # Errors
/// [`SweepError`]. What was written until then stays, and is not made again.
pub fn sweep(
    program: &Program,
    plan: &Plan<'_>,
    folder: &Folder,
    share: Share,
    threads: usize,
    told: Told<'_>,
) -> Result<Outcome, SweepError> {
    let job = Job::new(program, plan, folder.recipe());
    let (scene, inputs, request) = (plan.scene, &plan.chosen.inputs[..], &plan.request);
    let asked = runs::Asked { models: &program.models, scene, inputs, request };
    if let Some(numbers) = &plan.numbers {
        let make = |runs: &[usize]| job.looked_at(runs, |values| runs::look(asked, numbers, values));
        return all(&job, folder, share, threads, told, (1, &make));
    }
    if lanes::may_gain(plan) {
        let make = |numbers: &[usize]| job.runs_by(numbers, |values| lanes::many(asked, values));
        return all(&job, folder, share, threads, told, (lanes::TOGETHER, &make));
    }
    let begin = &plan.begin;
    let run = |values: &Vec<f64>| runs::run(asked, begin, values);
    let make = |numbers: &[usize]| job.runs_by(numbers, |values| values.iter().map(run).collect());
    all(&job, folder, share, threads, told, (1, &make))
}

/// Makes the runs of these numbers.
type Make<'a> = &'a (dyn Fn(&[usize]) -> Vec<Done> + Sync);

/// The same, for models of which a thread makes so many runs at once.
fn all(
    job: &Job<'_>,
    folder: &Folder,
    share: Share,
    threads: usize,
    told: Told<'_>,
    (together, make): (usize, Make<'_>),
) -> Result<Outcome, SweepError> {
    let own: Vec<usize> = (0..job.shards()).filter(|&shard| share.has(shard)).collect();
    let left: Vec<usize> = own.iter().copied().filter(|&shard| !folder.has(shard, job.has_trajectories())).collect();
    let count = |shards: &[usize]| shards.iter().map(|&shard| job.runs_of(shard).len()).sum::<usize>();
    let runs = job.runs_of(0).end.max(1);
    let mut outcome = Outcome { runs: job.runs(), shards: job.shards(), own: own.len(), ..Outcome::default() };
    outcome.found = own.len() - left.len();
    let (found, total) = (count(&own) - count(&left), count(&own));
    told(found, total);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build()?;
    let finished = AtomicUsize::new(found);
    let some = |numbers: &[usize]| {
        let done = told(finished.load(Ordering::Relaxed), total).then(|| make(numbers))?;
        let count = numbers.len();
        told(count + finished.fetch_add(count, Ordering::Relaxed), total).then_some(done)
    };
    for shards in left.chunks((RUNS_OF_A_THREAD * pool.current_num_threads()).div_ceil(runs)) {
        let numbers: Vec<usize> = shards.iter().flat_map(|&shard| job.runs_of(shard)).collect();
        let parts = || numbers.par_chunks(together).with_max_len(1).map(some).collect::<Option<Vec<Vec<Done>>>>();
        let Some(parts) = pool.install(parts) else { return Ok(outcome) };
        let done: Vec<Done> = parts.into_iter().flatten().collect();
        outcome.failed += done.iter().filter(|done| done.has_failed()).count();
        outcome.made_runs += done.len();
        let mut rest = done.into_iter();
        let of_shards: Vec<(usize, Vec<Done>)> =
            shards.iter().map(|&shard| (shard, rest.by_ref().take(job.runs_of(shard).len()).collect())).collect();
        pool.install(|| of_shards.into_par_iter().try_for_each(|(shard, done)| written(job, folder, shard, &done)))?;
        outcome.made += shards.len();
    }
    // Who has made nothing does not ask: of thousands of processes that are started again each would ask for all files.
    outcome.is_last = (outcome.made > 0 || share == Share::ALL) && folder.is_complete(outcome.shards);
    if outcome.is_last {
        folder.clear(outcome.shards);
    }
    Ok(outcome)
}

/// Writes the files of a shard; the one that says that it is there is the last.
fn written(job: &Job<'_>, folder: &Folder, shard: usize, done: &[Done]) -> Result<(), SweepError> {
    let first = job.runs_of(shard).start;
    if job.has_trajectories() {
        folder.write(ShardFile::Trajectories, shard, &job.trajectories(first, done))?;
    }
    Ok(folder.write(ShardFile::Runs, shard, &job.table(first, done))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_together_are_all_shards_once() {
        let parts: Vec<Share> = (1..=3).map(|i| Share::parse(&format!("{i}/3")).unwrap()).collect();
        assert!((0..20).all(|shard| parts.iter().filter(|part| part.has(shard)).count() == 1));
        for bad in ["0/3", "4/3", "3", "a/b", "1/0", ""] {
            assert!(Share::parse(bad).unwrap_err().to_string().starts_with(&format!("--shard {bad}: ")));
        }
    }
}
