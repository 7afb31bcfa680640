//! The best of several searches, and the front of two goals.
//!
//! In: a task, what makes searches, several at once if it can. Out: the best one with the others; for two goals minima
//! of the first one with the second one bounded, each bound a little lower.

use super::{Coordinate, Job, Minimum, OptimizeError, Task};

/// What was found in all.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// The best of all searches for the first goal.
    pub best: Minimum,
    /// All of them from their starts, in the order of the starts; why one did not come about.
    pub searches: Vec<Result<Minimum, OptimizeError>>,
    /// Of two goals the front, from the least first goal to the least second one: minima none of which is better than
    /// another one in both.
    pub front: Vec<Minimum>,
}

/// Makes searches of these jobs, and gives what each has found.
pub type Making<'a> = dyn FnMut(&[Job]) -> Vec<Result<Minimum, OptimizeError>> + 'a;

/// Searches from so many starts, by `make`; of two goals the front in so many points.
///
/// # Errors
/// No search came about: the fault of the first one.
pub fn optimum(task: &Task, starts: u32, points: u32, make: &mut Making<'_>) -> Result<Optimum, OptimizeError> {
    let starts = task.starts(starts.max(1));
    let mut of_goal = |goal: usize| -> Result<(Minimum, Vec<Result<Minimum, OptimizeError>>), OptimizeError> {
        let jobs: Vec<Job> = starts.iter().map(|start| Job { start: start.clone(), goal, limit: None }).collect();
        let searches = make(&jobs);
        let found = searches.iter().flatten();
        let best = found.reduce(|best, other| if is_better(other, best) { other } else { best });
        match best {
            Some(best) => Ok((best.clone(), searches)),
            None => Err(searches.into_iter().find_map(Result::err).unwrap_or(OptimizeError::Stopped)),
        }
    };
    let (best, searches) = of_goal(0)?;
    if task.goals.len() < 2 {
        return Ok(Optimum { best, searches, front: Vec::new() });
    }
    let (other, _) = of_goal(1)?;
    let front = between(task, [&best, &other], points, make);
    Ok(Optimum { best, searches, front })
}

/// Whether a minimum is better: feasible with a lower goal, or nearer to being feasible.
fn is_better(a: &Minimum, b: &Minimum) -> bool {
    match (a.is_feasible(), b.is_feasible()) {
        (true, true) => a.goal() < b.goal(),
        (false, false) => a.best.missed < b.best.missed,
        (is_feasible, _) => is_feasible,
    }
}

/// The front between the minima of both goals.
fn between(task: &Task, [first, last]: [&Minimum; 2], points: u32, make: &mut Making<'_>) -> Vec<Minimum> {
    let second = |of: &Minimum| of.best.goals.as_ref().map_or(f64::NAN, |goals| goals[1]);
    let (from, to) = (second(first), second(last));
    let inner = points.saturating_sub(2);
    let part = |k: u32| f64::from(k) / f64::from(inner + 1);
    let jobs: Vec<Job> = (1..=inner)
        .map(|k| {
            let values = task.variables.iter().zip(first.best.values.iter().zip(&last.best.values));
            let start = values.map(|(variable, (&a, &b))| {
                let coordinate = Coordinate::of(variable);
                let [a, b] = [a, b].map(|value| coordinate.inner(value));
                coordinate.outer(a + part(k) * (b - a))
            });
            Job { start: start.collect(), goal: 0, limit: Some((1, from + part(k) * (to - from))) }
        })
        .collect();
    let found = if jobs.is_empty() { Vec::new() } else { make(&jobs) };
    let all = std::iter::once(first.clone()).chain(found.into_iter().flatten()).chain([last.clone()]);
    let all: Vec<Minimum> = all.filter(Minimum::is_feasible).collect();
    let goals = |of: &Minimum| of.best.goals.clone().unwrap_or_default();
    let beats = |a: &[f64], b: &[f64]| a != b && a.iter().zip(b).all(|(a, b)| a <= b);
    let is_kept = |of: &&Minimum| !all.iter().any(|other| beats(&goals(other), &goals(of)));
    all.iter().filter(is_kept).cloned().collect()
}
