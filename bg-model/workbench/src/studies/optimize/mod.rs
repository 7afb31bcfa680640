//! Optima: which parameters make a number of a run least, subject to others.
//!
//! In: texts of goals, requirements and variables, a scene with its values. Out: a [`Sought`], and what several
//! searches on all cores have found. The searches are those of `bg-analysis`.

pub mod report;

use std::ops::ControlFlow;
use std::sync::Mutex;

use bg_analysis::criterion::of_run::{Look, Outside};
use bg_analysis::criterion::{Criteria, CriterionError};
pub use bg_analysis::optimize::{End, Job, Minimum, OptimizeError, Optimum, Task, Trial, Variable};
use bg_model::description::ParameterInfo;
use bg_model::input::Input;
use bg_model::integrator::Integrator;
use bg_model::run::Request;
use rayon::prelude::*;
use thiserror::Error;

use crate::ask::machine::{Absent, MachineError};
use crate::ask::parameters::{Values, bounds, nearest};
use crate::ask::scenes::{Models, Scene};

/// What is asked for, as a person writes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// What is to be least.
    pub minimize: Vec<String>,
    /// What is to be largest.
    pub maximize: Vec<String>,
    /// What has to be fulfilled, such as `mean(speed) > 30`.
    pub subject: Vec<String>,
    /// What may change, such as `length=0.5..0.9` or `stiffness`.
    pub by: Vec<String>,
    /// From how many starts; 0 is one.
    pub starts: u32,
    /// In how many points the front of two goals; 0 is 9.
    pub points: u32,
    /// The most steps of a search; 0 is 50.
    pub steps: u64,
    /// Threads; 0 are as many as there are cores.
    pub threads: usize,
}

/// The points of a front, and the steps of a search, unless others are asked for.
pub const POINTS: u32 = 9;
/// As above.
pub const STEPS: u64 = 50;
/// The accuracy of goals and requirements, in parts of their sizes.
const ACCURACY: f64 = 1e-7;
/// The least number of samples that means and integrals are made from: fewer would be noise to the search.
const SAMPLES: f64 = 2000.0;
/// The stack of a thread, as the first one of a program has it.
const STACK: usize = 8 << 20;

/// What cannot be sought.
#[derive(Debug, Error)]
pub enum AskedError {
    /// A goal or a requirement cannot be read.
    #[error("--{option} \"{text}\": {fault}")]
    Criterion {
        /// The option.
        option: &'static str,
        /// What was given.
        text: String,
        /// Why not.
        fault: CriterionError,
    },
    /// A variable cannot be one.
    #[error("--by \"{text}\": {fault}")]
    Variable {
        /// What was given.
        text: String,
        /// Why not.
        fault: String,
    },
    /// There is no goal, or there are more than two.
    #[error("{0} goals: give one with --minimize or --maximize, or two for their front")]
    Goals(usize),
    /// There is nothing to change.
    #[error("nothing may change: give parameters with --by, as in --by length=0.5..0.9")]
    NoVariable,
    /// A time outside of the run.
    #[error(transparent)]
    Outside(#[from] Outside),
    /// No search.
    #[error(transparent)]
    Optimize(#[from] OptimizeError),
    /// There is no such model.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The model has no derivatives.
    #[error(transparent)]
    Absent(#[from] Absent),
    /// No threads.
    #[error("the system gives no threads: {0}; try --threads 1")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// What is sought.
#[derive(Clone, Debug)]
pub struct Sought {
    /// The task: every goal is to be least.
    pub task: Task,
    /// Of each goal as it was written whether it is to be largest, and so the task's with its sign turned.
    pub is_largest: Vec<bool>,
    /// The goals as they were written.
    pub texts: Vec<String>,
    starts: u32,
    points: u32,
    threads: usize,
}

/// What `asked` asks of a scene with these values; `step` is the interval of the samples, s.
///
/// # Errors
/// [`AskedError`].
pub fn sought(
    scene: &Scene,
    values: &Values,
    asked: &Asked,
    request: &Request,
    step: f64,
) -> Result<Sought, AskedError> {
    let mut criteria = Criteria::new(scene.description);
    let fault = |option: &'static str, text: &str| {
        let text = text.trim().to_owned();
        move |fault| AskedError::Criterion { option, text, fault }
    };
    let mut goals = Vec::new();
    for (option, texts, is_largest) in [("minimize", &asked.minimize, false), ("maximize", &asked.maximize, true)] {
        for text in texts {
            let goal = criteria.criterion(text).map_err(fault(option, text))?;
            goals.push((if is_largest { criteria.negative(&goal) } else { goal }, is_largest));
        }
    }
    if !(1..=2).contains(&goals.len()) {
        return Err(AskedError::Goals(goals.len()));
    }
    let subjects = asked.subject.iter().map(|text| criteria.requirement(text).map_err(fault("subject", text)));
    let subjects = subjects.collect::<Result<Vec<_>, _>>()?;
    if asked.by.is_empty() {
        return Err(AskedError::NoVariable);
    }
    let variables = asked
        .by
        .iter()
        .map(|text| variable(scene, values, text).map_err(|fault| AskedError::Variable { text: text.clone(), fault }));
    let variables = variables.collect::<Result<Vec<_>, _>>()?;
    let look = Look::new(criteria, step.min(request.t_end / SAMPLES), request.t_end)?;
    let or = |given: u32, otherwise: u32| if given == 0 { otherwise } else { given };
    let task = Task {
        look,
        goals: goals.iter().map(|(goal, _)| goal.clone()).collect(),
        subjects,
        variables,
        request: followed_cheaply(request),
        steps: if asked.steps == 0 { STEPS } else { asked.steps },
        accuracy: ACCURACY,
    };
    task.check()?;
    Ok(Sought {
        task,
        texts: goals.iter().map(|(goal, _)| goal.text.clone()).collect(),
        is_largest: goals.into_iter().map(|(_, is_largest)| is_largest).collect(),
        starts: or(asked.starts, 1),
        points: or(asked.points, POINTS),
        threads: asked.threads,
    })
}

/// The same, by DOP853 where `auto` may choose: slopes follow its steps, and would divide those of other methods.
fn followed_cheaply(request: &Request) -> Request {
    let method = if request.method == Integrator::default() { Integrator::Dop853 } else { request.method };
    Request { method, ..request.clone() }
}

/// The variable that `NAME` or `NAME=LOWER..UPPER` gives; it starts at its value, or where that is outside of its
/// bounds in their middle.
fn variable(scene: &Scene, values: &Values, text: &str) -> Result<Variable, String> {
    let (name, range) = text.split_once('=').map_or((text, None), |(name, range)| (name, Some(range)));
    let name = name.trim();
    let own = scene.description.parameters;
    let info: &'static ParameterInfo = own.iter().find(|info| info.name == name).ok_or_else(|| {
        let near = nearest(name, own.iter().map(|info| info.name));
        let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        format!("scene `{}` has no parameter `{name}` that may change{near}", scene.name)
    })?;
    let start = values.get(name).unwrap_or(info.default);
    let Some(range) = range else {
        return Ok(Variable { info, start, lower: info.range.lower, upper: info.range.upper });
    };
    let [lower, upper] = bounds(info, range)?;
    let is_inside = (lower..=upper).contains(&start);
    let middle = if lower > 0.0 { (lower * upper).sqrt() } else { 0.5 * (lower + upper) };
    Ok(Variable { info, start: if is_inside { start } else { middle }, lower, upper })
}

/// Is told of each run the number of runs and the run, and says whether to go on.
pub type Told<'a> = &'a (dyn Fn(usize, &Trial) -> bool + Sync);

/// Searches, on several threads where there are several searches.
///
/// # Errors
/// [`AskedError`].
pub fn optimum(
    models: &Models,
    scene: &Scene,
    values: &Values,
    inputs: &[Input],
    sought: &Sought,
    told: Told<'_>,
) -> Result<Optimum, AskedError> {
    // Whether there is such a model, with derivatives.
    models.made(scene, values, inputs)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(sought.threads).stack_size(STACK).build()?;
    let runs = Mutex::new(0_usize);
    let absent: Mutex<Option<Absent>> = Mutex::new(None);
    let one = |job: &Job| -> Result<Minimum, OptimizeError> {
        let machine = models.made(scene, values, inputs).map_err(|_| OptimizeError::Stopped)?;
        let mut each = |trial: &Trial| {
            let number = {
                let mut runs = runs.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                *runs += 1;
                *runs
            };
            if told(number, trial) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        machine.known("derivatives by parameters", machine.minimum(&sought.task, job, &mut each)).unwrap_or_else(
            |fault| {
                *absent.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(fault);
                Err(OptimizeError::Stopped)
            },
        )
    };
    let mut make = |jobs: &[Job]| -> Vec<Result<Minimum, OptimizeError>> {
        pool.install(|| jobs.par_iter().with_max_len(1).map(one).collect())
    };
    let found = bg_analysis::optimize::optimum(&sought.task, sought.starts, sought.points, &mut make);
    if let Some(fault) = absent.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        return Err(fault.into());
    }
    Ok(found?)
}
