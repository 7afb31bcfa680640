//! Optima: the parameters with which a number of a run is least, subject to others.
//!
//! In: goals, requirements, variables with bounds, a model. Out: the best values that were found, from one start or
//! several; of two goals the front, where none of them gets better without the other one getting worse. Method: a
//! search on exact derivatives (`search`), which go through events ([`Look::slopes`]); a largest value in time is the
//! largest of those of parts of the time, each of which is smooth where the largest one changes. A variable that is
//! positive is changed by its logarithm. A front is found by bounds on one goal that the other one is subject to (Y. Y.
//! Haimes, L. S. Lasdon, D. A. Wismer, IEEE Trans. Syst. Man Cybern. 1 (1971) 296).

mod front;
mod search;

use std::ops::ControlFlow;

use bg_model::mechanism::Followed;
use bg_model::parameters::ParameterError;
use bg_model::run::Request;
use bg_model::sensitivity::{Direction, directions};
use thiserror::Error;

use crate::criterion::of_run::{Found, Look, Slopes};
use crate::criterion::{Criterion, Relation, Requirement};
pub use crate::identify::Variable;
use crate::identify::search::halton;
pub use front::{Optimum, optimum};
pub use search::End;
use search::{Evaluated, Numbers, Rows, search};

/// What is sought.
#[derive(Clone, Debug)]
pub struct Task {
    /// What is looked at of each run, for all criteria.
    pub look: Look,
    /// What is to be least: one number, or two of which the front is sought.
    pub goals: Vec<Criterion>,
    /// What has to be fulfilled.
    pub subjects: Vec<Requirement>,
    /// What may change.
    pub variables: Vec<Variable>,
    /// How runs are integrated.
    pub request: Request,
    /// The most steps of a search.
    pub steps: u64,
    /// The accuracy of goals and requirements, in parts of their sizes at the start.
    pub accuracy: f64,
}

/// One search.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Where the variables start, in their units.
    pub start: Vec<f64>,
    /// Which goal is to be least.
    pub goal: usize,
    /// A goal that is to be this at most, in coherent SI.
    pub limit: Option<(usize, f64)>,
}

/// A run that was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The variables, in their units.
    pub values: Vec<f64>,
    /// All goals, in coherent SI; none where the run failed.
    pub goals: Option<Vec<f64>>,
    /// By how much the requirements are missed, the worst one in parts of its size; infinity where the run failed.
    pub missed: f64,
}

/// What one search has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// What was sought.
    pub job: Job,
    /// The best run: of those that fulfil all requirements the one with the least goal, else the one that misses least.
    pub best: Trial,
    /// Both sides of each requirement there, in coherent SI.
    pub sides: Vec<[f64; 2]>,
    /// How the search has ended, the last one where it went on elsewhere.
    pub end: End,
    /// How often a run farther away was better than where the search had ended, and it went on from there.
    pub hops: usize,
    /// Why there were no runs or no derivatives last, if so.
    pub fault: Option<String>,
    /// All runs, in their order.
    pub trials: Vec<Trial>,
    /// How many more runs were made with derivatives.
    pub sloped: usize,
}

impl Minimum {
    /// Whether it fulfils all requirements.
    #[must_use]
    pub fn is_feasible(&self) -> bool {
        self.best.missed <= FEASIBLE
    }

    /// The goal that was sought, in coherent SI; infinity where requirements are missed.
    #[must_use]
    pub fn goal(&self) -> f64 {
        let goal = self.best.goals.as_ref().map(|goals| goals[self.job.goal]);
        goal.filter(|_| self.is_feasible()).unwrap_or(f64::INFINITY)
    }
}

/// A search that did not come about.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OptimizeError {
    /// The run with the start values has failed.
    #[error("with {start}: {fault}")]
    Start {
        /// The values.
        start: String,
        /// Why.
        fault: String,
    },
    /// A parameter cannot have a value.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A goal has no derivatives.
    #[error("`{text}` cannot be searched by: {measure}(..) jumps or has no derivative; ask for a value")]
    NoDerivatives {
        /// The criterion.
        text: String,
        /// The measure.
        measure: &'static str,
    },
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
}

/// What a requirement may be missed by, in parts of its size.
pub const FEASIBLE: f64 = 1e-6;
/// How far starts are away from a given one that has no bounds, in parts of a variable's size.
const FAR: f64 = std::f64::consts::LN_2;
/// How far runs around a minimum are away from it, in parts of the way between a variable's bounds: ripples of a goal
/// are narrower. And how often a search goes on from a better one of them.
const AROUND: [f64; 2] = [0.2, 0.05];
const HOPS: usize = 3;
/// How much better a run farther away has to be, in parts of the goal's size.
const BETTER: f64 = 1e-4;
/// The bases of the starts' digits.
const BASES: [u32; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

impl Task {
    /// Whether all criteria have derivatives.
    ///
    /// # Errors
    /// The first one that has none.
    pub fn check(&self) -> Result<(), OptimizeError> {
        let sides = self.subjects.iter().flat_map(|subject| [&subject.left, &subject.right]);
        for criterion in self.goals.iter().chain(sides) {
            if let Some(measure) = self.look.criteria().without_derivatives(criterion) {
                return Err(OptimizeError::NoDerivatives { text: criterion.text.clone(), measure });
            }
        }
        Ok(())
    }

    /// So many starts: the given one, others spread evenly between the bounds, or around it where there are none (J. H.
    /// Halton, Numer. Math. 2 (1960) 84-90).
    #[must_use]
    pub fn starts(&self, count: u32) -> Vec<Vec<f64>> {
        let start = |number: u32| {
            let of = |(k, variable): (usize, &Variable)| {
                let coordinate = Coordinate::of(variable);
                let (way, at) = (halton(number, BASES[k % BASES.len()]), coordinate.inner(variable.start));
                if number == 0 {
                    return variable.start;
                }
                let [lower, upper] = coordinate.bounds();
                let inner = if lower.is_finite() && upper.is_finite() {
                    0.5 * (lower + upper) + 0.5 * way * (upper - lower)
                } else {
                    (at + FAR * way).clamp(lower, upper)
                };
                coordinate.outer(inner)
            };
            self.variables.iter().enumerate().map(of).collect()
        };
        // The first number of the sequence is the middle.
        (0..count).map(start).collect()
    }
}

/// A variable as the search sees it: between its bounds from 0 to 1, its logarithm, or in parts of its size.
struct Coordinate<'a> {
    variable: &'a Variable,
    size: f64,
}

impl<'a> Coordinate<'a> {
    fn of(variable: &'a Variable) -> Self {
        let width = variable.upper - variable.lower;
        let is_plain = !variable.is_logarithmic();
        Self { variable, size: if is_plain && width.is_finite() { width } else { variable.size() } }
    }

    fn inner(&self, value: f64) -> f64 {
        self.variable.inner(value) / self.size
    }

    fn outer(&self, inner: f64) -> f64 {
        self.variable.outer(inner * self.size).clamp(self.variable.lower, self.variable.upper)
    }

    fn bounds(&self) -> [f64; 2] {
        [self.variable.lower, self.variable.upper].map(|bound| self.inner(bound))
    }

    /// The derivative of the parameter by the coordinate.
    fn slope(&self, value: f64) -> f64 {
        self.variable.slope(value) * self.size
    }
}

/// A number that a search is told: a criterion with its size.
struct Sized {
    pieces: Vec<Criterion>,
    size: f64,
}

/// Searches for what `job` asks for. `told` is told of each run, and says whether the search goes on.
///
/// # Errors
/// The run with the start values has failed, or it was told to stop.
pub fn minimum(
    model: &dyn Followed,
    task: &Task,
    job: &Job,
    told: &mut dyn FnMut(&Trial) -> ControlFlow<()>,
) -> Result<Minimum, OptimizeError> {
    task.check()?;
    let names: Vec<&str> = task.variables.iter().map(|of| of.info.name).collect();
    let coordinates: Vec<Coordinate<'_>> = task.variables.iter().map(Coordinate::of).collect();
    let mut runs = Runs {
        model,
        task,
        job,
        own: model.values(),
        directions: directions(model.description(), &names)?,
        coordinates,
        goal: Sized { pieces: Vec::new(), size: 1.0 },
        zero: Vec::new(),
        at_most_zero: Vec::new(),
        latest: None,
        told,
        trials: Vec::new(),
        best: None,
        sloped: 0,
        fault: None,
    };
    let start: Vec<f64> = runs.coordinates.iter().zip(&job.start).map(|(of, &value)| of.inner(value)).collect();
    runs.begin(&start)?;
    let numbers = match runs.numbers(&start) {
        ControlFlow::Continue(Some(numbers)) => numbers,
        ControlFlow::Continue(None) => return Err(runs.no_start()),
        ControlFlow::Break(()) => return Err(OptimizeError::Stopped),
    };
    let bounds: Vec<[f64; 2]> = runs.coordinates.iter().map(Coordinate::bounds).collect();
    let [lower, upper] = [0, 1].map(|end| bounds.iter().map(|of| of[end]).collect::<Vec<f64>>());
    let mut end = search(&mut runs, (&start, &numbers), [&lower, &upper], (task.steps, task.accuracy));
    let mut hops = 0;
    // What ended for want of steps has not come to a minimum yet.
    while hops < HOPS && matches!(end, End::Converged | End::NoStep) {
        match runs.better_around(&bounds) {
            ControlFlow::Continue(None) => break,
            ControlFlow::Continue(Some((from, numbers))) => {
                hops += 1;
                end = search(&mut runs, (&from, &numbers), [&lower, &upper], (task.steps, task.accuracy));
            }
            ControlFlow::Break(()) => end = End::Stopped,
        }
    }
    if end == End::Stopped {
        return Err(OptimizeError::Stopped);
    }
    let Runs { best, trials, sloped, fault, .. } = runs;
    let (best, sides) = best.ok_or(OptimizeError::Stopped)?;
    let fault = fault.filter(|_| matches!(end, End::NoStep | End::NoDerivatives));
    Ok(Minimum { job: job.clone(), best, sides, end, hops, fault, trials, sloped })
}

/// What makes runs of the variables' values.
struct Runs<'a> {
    model: &'a dyn Followed,
    task: &'a Task,
    job: &'a Job,
    /// The values of all of the model's parameters.
    own: Vec<f64>,
    /// The variables, in their order.
    directions: Vec<Direction>,
    coordinates: Vec<Coordinate<'a>>,
    goal: Sized,
    zero: Vec<Sized>,
    at_most_zero: Vec<Sized>,
    /// The last run, of these values.
    latest: Option<(Vec<f64>, Found)>,
    told: &'a mut dyn FnMut(&Trial) -> ControlFlow<()>,
    trials: Vec<Trial>,
    /// The best run, with both sides of each requirement.
    best: Option<(Trial, Vec<[f64; 2]>)>,
    sloped: usize,
    /// Why there was no run, or there were no derivatives, the last time.
    fault: Option<String>,
}

impl Runs<'_> {
    fn values(&self, x: &[f64]) -> Vec<f64> {
        self.coordinates.iter().zip(x).map(|(of, &inner)| of.outer(inner)).collect()
    }

    /// The values of all parameters.
    fn all(&self, values: &[f64]) -> Vec<f64> {
        let mut all = self.own.clone();
        for (direction, &value) in self.directions.iter().zip(values) {
            if let Direction::Parameter(place) = *direction {
                all[place] = value;
            }
        }
        all
    }

    fn run(&self, values: &[f64]) -> Result<Found, String> {
        let all = self.all(values);
        let machine = self.model.tuned(&all).map_err(|fault| fault.to_string())?;
        let found = self.task.look.run(&*machine, &all, &self.task.request).map_err(|fault| fault.to_string())?;
        let criteria = self.task.look.criteria();
        let sides = self.task.subjects.iter().flat_map(|subject| [&subject.left, &subject.right]);
        for criterion in self.task.goals.iter().chain(sides) {
            let value = criteria.value(criterion, &found.known);
            if !value.is_finite() {
                return Err(format!("`{}` is no finite number", criterion.text));
            }
        }
        Ok(found)
    }

    fn no_start(&self) -> OptimizeError {
        let variables = self.task.variables.iter().zip(&self.job.start);
        let start = variables.map(|(of, value)| format!("{} = {value}", of.info.name)).collect::<Vec<_>>().join(", ");
        OptimizeError::Start { start, fault: self.fault.clone().unwrap_or_default() }
    }

    /// Sets what the search is told, with the sizes at the start `x`.
    fn begin(&mut self, x: &[f64]) -> Result<(), OptimizeError> {
        let criteria = self.task.look.criteria();
        let values = self.values(x);
        let found = self.run(&values).map_err(|fault| {
            self.fault = Some(fault);
            self.no_start()
        })?;
        let value = |criterion: &Criterion| criteria.value(criterion, &found.known);
        let size = |values: &[f64]| values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let positive = |size: f64| if size > 0.0 { size } else { 1.0 };
        let goal = &self.task.goals[self.job.goal];
        self.goal = Sized { pieces: criteria.pieces(goal), size: positive(value(goal).abs()) };
        let limit = self.job.limit.map(|(goal, limit)| (&self.task.goals[goal], limit));
        for subject in &self.task.subjects {
            let excess = criteria.excess(subject);
            let size = positive(size(&[value(&subject.left), value(&subject.right)]));
            if subject.relation == Relation::Equal {
                self.zero.push(Sized { pieces: vec![excess], size });
            } else {
                self.at_most_zero.push(Sized { pieces: criteria.pieces(&excess), size });
            }
        }
        if let Some((goal, limit)) = limit {
            let excess = criteria.less(goal, limit);
            let size = positive(size(&[value(goal), limit]));
            self.at_most_zero.push(Sized { pieces: criteria.pieces(&excess), size });
        }
        self.latest = Some((values, found));
        Ok(())
    }

    /// The numbers that the search is told of a run.
    fn numbers_of(&self, found: &Found) -> Numbers {
        let criteria = self.task.look.criteria();
        let of = |sized: &Sized| -> Vec<f64> {
            sized.pieces.iter().map(|piece| criteria.value(piece, &found.known) / sized.size).collect()
        };
        Numbers {
            goal: of(&self.goal),
            zero: self.zero.iter().flat_map(of).collect(),
            at_most_zero: self.at_most_zero.iter().flat_map(of).collect(),
        }
    }

    /// Looks at runs around the best one so far, each with one variable changed; gives the first better one with its
    /// numbers. A search on derivatives ends in the next ripple of a goal that has many, as the peaks of what rings
    /// have (a poll of pattern search: V. Torczon, SIAM J. Optim. 7 (1997) 1-25).
    fn better_around(&mut self, bounds: &[[f64; 2]]) -> ControlFlow<(), Option<(Vec<f64>, Numbers)>> {
        let Some((best, _)) = self.best.clone() else { return ControlFlow::Continue(None) };
        let goal = |trial: &Trial| trial.goals.as_ref().map_or(f64::INFINITY, |goals| goals[self.job.goal]);
        let least = goal(&best) - BETTER * self.goal.size;
        let middle: Vec<f64> = self.coordinates.iter().zip(&best.values).map(|(of, &value)| of.inner(value)).collect();
        for part in AROUND {
            for (k, &[lower, upper]) in bounds.iter().enumerate() {
                let way = if (upper - lower).is_finite() { upper - lower } else { 1.0 };
                for sign in [1.0, -1.0] {
                    let mut x = middle.clone();
                    x[k] = (x[k] + sign * part * way).clamp(lower, upper);
                    if x[k] == middle[k] {
                        continue;
                    }
                    let numbers = self.numbers(&x)?;
                    let found = self.trials.last().filter(|trial| trial.values == self.values(&x));
                    let is_better = found.is_some_and(|trial| {
                        let is_feasible = trial.missed <= FEASIBLE && best.missed <= FEASIBLE;
                        if is_feasible { goal(trial) < least } else { trial.missed < 0.99 * best.missed - FEASIBLE }
                    });
                    if let Some(numbers) = numbers.filter(|_| is_better) {
                        return ControlFlow::Continue(Some((x, numbers)));
                    }
                }
            }
        }
        ControlFlow::Continue(None)
    }

    /// Keeps a run if it is the best one so far.
    fn keep(&mut self, trial: &Trial, found: &Found) {
        let goal = |trial: &Trial| trial.goals.as_ref().map_or(f64::INFINITY, |goals| goals[self.job.goal]);
        let is_better = self.best.as_ref().is_none_or(|(best, _)| {
            if trial.missed <= FEASIBLE && best.missed <= FEASIBLE {
                goal(trial) < goal(best)
            } else {
                trial.missed < best.missed
            }
        });
        if is_better {
            let criteria = self.task.look.criteria();
            let side = |side: &Criterion| criteria.value(side, &found.known);
            let sides = self.task.subjects.iter().map(|subject| [side(&subject.left), side(&subject.right)]);
            self.best = Some((trial.clone(), sides.collect()));
        }
    }
}

impl Evaluated for Runs<'_> {
    fn numbers(&mut self, x: &[f64]) -> ControlFlow<(), Option<Numbers>> {
        let values = self.values(x);
        let known = self.latest.take().filter(|(known, _)| *known == values);
        let is_told = known.is_some() && self.trials.last().is_some_and(|last| last.values == values);
        let found = known.map_or_else(|| self.run(&values), |(_, found)| Ok(found));
        let numbers = found.as_ref().ok().map(|found| self.numbers_of(found));
        let criteria = self.task.look.criteria();
        let trial = Trial {
            values: values.clone(),
            goals: found
                .as_ref()
                .ok()
                .map(|found| self.task.goals.iter().map(|goal| criteria.value(goal, &found.known)).collect()),
            missed: numbers.as_ref().map_or(f64::INFINITY, |numbers| {
                let zero = numbers.zero.iter().map(|off| off.abs());
                numbers.at_most_zero.iter().copied().chain(zero).fold(0.0, f64::max)
            }),
        };
        match found {
            Ok(found) => {
                self.keep(&trial, &found);
                self.latest = Some((values, found));
            }
            Err(fault) => (self.fault, self.latest) = (Some(fault), None),
        }
        if !is_told {
            let goes_on = (self.told)(&trial);
            self.trials.push(trial);
            goes_on?;
        }
        ControlFlow::Continue(numbers)
    }

    fn rows(&mut self, x: &[f64]) -> Option<Rows> {
        let values = self.values(x);
        let (known, found) = self.latest.as_ref()?;
        debug_assert_eq!(known, &values, "derivatives are asked for where the last run was");
        let (look, request) = (&self.task.look, &self.task.request);
        self.sloped += 1;
        let slopes = look.slopes(self.model, &self.all(&values), request, &self.directions, found);
        let slopes: Slopes = match slopes {
            Ok(slopes) => slopes,
            Err(fault) => {
                self.fault = Some(fault.to_string());
                return None;
            }
        };
        let inner: Vec<f64> = self.coordinates.iter().zip(&values).map(|(of, &value)| of.slope(value)).collect();
        let row = |piece: &Criterion, size: f64| -> Vec<f64> {
            let by = slopes.of(look.criteria(), piece);
            by.iter().zip(&inner).map(|(slope, inner)| slope * inner / size).collect()
        };
        let of = |sized: &Sized| sized.pieces.iter().map(|piece| row(piece, sized.size)).collect::<Vec<_>>();
        let rows = Rows {
            goal: of(&self.goal),
            zero: self.zero.iter().flat_map(of).collect(),
            at_most_zero: self.at_most_zero.iter().flat_map(of).collect(),
        };
        let all = rows.goal.iter().chain(&rows.zero).chain(&rows.at_most_zero);
        if all.flatten().all(|slope| slope.is_finite()) {
            Some(rows)
        } else {
            self.fault = Some("a criterion has no derivative there, as the root of zero has none".to_owned());
            None
        }
    }
}
