//! The runs of a sweep: each with its own parameters, its numbers as a row.
//!
//! In: a plan, the number of a run. Out: its row, be it one of a run that failed, and its trajectory if wanted; rows as
//! tables.

use std::ops::ControlFlow;
use std::ops::Range;

use bg_model::description::{Description, ParameterInfo};
use bg_model::input::Input;
use bg_model::run::{Request, RunError, Stopped};
use bg_model::simulation::Recording;

use super::OWN_COLUMNS;
use super::design::Design;
use super::plan::Plan;
use super::recipe::OF_SIZES;
use super::wanted::{Numbers, Wanted};
use crate::ask::parameters::Values as Parameters;
use crate::ask::scenes::{Models, Scene, own_values};
use crate::files::parquet::{Column, Table, Values};
use crate::program::Program;
use crate::run::running::{Begin, Outcome, follow};

/// What runs have in common.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// The models of the graph.
    pub models: &'a Models,
    /// The one that is run.
    pub scene: &'a Scene,
    /// The inputs.
    pub inputs: &'a [Input],
    /// What is asked of each run.
    pub request: &'a Request,
}

impl Asked<'_> {
    /// These values of all parameters.
    pub fn all(&self, values: &[f64]) -> Parameters {
        let mut all = self.models.defaults();
        values.iter().enumerate().for_each(|(index, value)| all.set_value(index, *value));
        all
    }
}

/// Makes a run that begins there with these values of all parameters, or says why there is none.
pub fn run(asked: Asked<'_>, begin: &Begin, values: &[f64]) -> Result<Outcome, String> {
    let Asked { models, scene, inputs, request } = asked;
    let machine = models.made(scene, &asked.all(values), inputs).map_err(|fault| fault.to_string())?;
    let from = begin.state(&*machine).map_err(|fault| fault.to_string())?;
    follow(&*machine, request.clone(), from.as_ref(), |_| ControlFlow::Continue(())).map_err(|fault| fault.to_string())
}

/// The same with numbers of it: none of a run that has not come to its end.
pub fn look(asked: Asked<'_>, numbers: &Numbers, values: &[f64]) -> (Result<Outcome, String>, Vec<f64>) {
    let Asked { models, scene, inputs, request } = asked;
    let made = || -> Result<_, String> {
        let all = asked.all(values);
        let own = own_values(scene, &models.scenes, &all).map_err(|fault| fault.to_string())?;
        let machine = models.made(scene, &all, inputs).map_err(|fault| fault.to_string())?;
        Ok((own, machine))
    };
    let (own, machine) = match made() {
        Ok(made) => made,
        Err(fault) => return (Err(fault), Vec::new()),
    };
    match numbers.look.run(&*machine.model(), own.values(), request) {
        Ok(found) => {
            let values = numbers.of(&found);
            (Ok(Outcome { run: found.run, failure: None }), values)
        }
        Err(RunError::Stopped(stopped)) => {
            let Stopped { cause, trajectory } = *stopped;
            (Ok(Outcome { run: trajectory, failure: Some(cause.to_string()) }), Vec::new())
        }
        Err(fault) => (Err(fault.to_string()), Vec::new()),
    }
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Status {
    /// To its end.
    Done,
    /// It stopped before its end.
    Stopped,
    /// There is no such model, or it cannot start.
    Refused,
}

impl Status {
    /// Its name in a table.
    const fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Stopped => "stopped",
            Self::Refused => "refused",
        }
    }
}

/// What is kept of a run.
#[derive(Debug)]
pub struct Done {
    status: Status,
    /// Why there is no result; empty where there is one.
    reason: String,
    reached: f64,
    steps: u64,
    events: usize,
    numbers: Vec<f64>,
    samples: Option<Recording>,
}

impl Done {
    /// Whether there is no result.
    pub fn has_failed(&self) -> bool {
        self.status != Status::Done
    }
}

/// All that the rows of a sweep depend on.
#[derive(Debug)]
pub struct Job<'a> {
    design: &'a Design,
    wanted: &'a Wanted,
    numbers: Option<&'a Numbers>,
    model: &'static Description,
    parameters: &'static [ParameterInfo],
    /// The values of all parameters, the swept ones as they would be without a sweep.
    base: Vec<f64>,
    /// The swept parameters by their indices in the table of all.
    swept: Vec<usize>,
    shard: usize,
    texts: Vec<(String, String)>,
}

impl<'a> Job<'a> {
    /// The job of `plan`; every file says `recipe`.
    pub fn new(program: &Program, plan: &'a Plan<'_>, recipe: &str) -> Self {
        let Plan { design, wanted, numbers, scene, chosen, shard, .. } = plan;
        let parameters = chosen.values.table();
        let place = |name: &String| parameters.iter().position(|info| info.name == name).expect("a plan was checked");
        let base = chosen.values.values().to_vec();
        let swept: Vec<usize> = design.names.iter().map(place).collect();
        let all = parameters.iter().zip(&base).enumerate().filter(|(index, _)| !swept.contains(index));
        let all =
            all.map(|(_, (info, value))| serde_json::json!({ "name": info.name, "unit": info.unit, "value": value }));
        let texts = [
            ("program", format!("{} {}", program.texts.name, program.texts.version)),
            ("model", scene.description.name.to_owned()),
            ("scene", scene.name.clone()),
            ("method", plan.integration.method.name().to_owned()),
            ("rtol", format!("{:?}", plan.request.rtol)),
            ("atol", plan.request.atol.map_or_else(|| OF_SIZES.to_owned(), |atol| format!("{atol:?}"))),
            ("parameters", serde_json::Value::from(all.collect::<Vec<_>>()).to_string()),
            ("sweep", recipe.to_owned()),
        ];
        let texts = texts.map(|(name, text)| (name.to_owned(), text)).to_vec();
        let (numbers, model, shard) = (numbers.as_ref(), scene.description, *shard);
        Self { design, wanted, numbers, model, parameters, base, swept, shard, texts }
    }

    /// How many runs.
    pub const fn runs(&self) -> usize {
        self.design.runs
    }

    /// How many shards.
    pub const fn shards(&self) -> usize {
        self.design.runs.div_ceil(self.shard)
    }

    /// The runs of a shard.
    pub fn runs_of(&self, shard: usize) -> Range<usize> {
        let first = shard * self.shard;
        first..(first + self.shard).min(self.design.runs)
    }

    /// Whether all samples of some outputs are kept.
    pub const fn has_trajectories(&self) -> bool {
        !self.wanted.trajectories.is_empty()
    }

    /// Makes the runs of these numbers by `many`, which is handed the values of all parameters in each.
    pub fn runs_by(&self, numbers: &[usize], many: impl Fn(&[Vec<f64>]) -> Vec<Result<Outcome, String>>) -> Vec<Done> {
        let values: Vec<Vec<f64>> = numbers.iter().map(|&number| self.values(number)).collect();
        many(&values).into_iter().map(|outcome| self.done(outcome, Vec::new())).collect()
    }

    /// Makes the runs of these numbers by `one`, which is handed the values of all parameters in it and gives numbers
    /// of it as well.
    pub fn looked_at(&self, runs: &[usize], one: impl Fn(&[f64]) -> (Result<Outcome, String>, Vec<f64>)) -> Vec<Done> {
        let of = |&run: &usize| {
            let (outcome, numbers) = one(&self.values(run));
            self.done(outcome, numbers)
        };
        runs.iter().map(of).collect()
    }

    /// Names and units of the columns that a run fills.
    fn columns(&self) -> impl Iterator<Item = (String, String)> + use<'_> {
        self.wanted.columns(self.model).into_iter().chain(self.numbers.into_iter().flat_map(Numbers::columns))
    }

    /// The values of all parameters in run `number`.
    fn values(&self, number: usize) -> Vec<f64> {
        let mut values = self.base.clone();
        self.swept.iter().zip(self.design.values(number)).for_each(|(&index, value)| values[index] = value);
        values
    }

    /// What is kept of a run, beside `numbers` of it.
    fn done(&self, outcome: Result<Outcome, String>, mut numbers: Vec<f64>) -> Done {
        let width = self.columns().count();
        let Outcome { run, failure } = match outcome {
            Ok(outcome) => outcome,
            Err(reason) => {
                let numbers = vec![f64::NAN; width];
                let (status, reached) = (Status::Refused, f64::NAN);
                return Done { status, reason, reached, steps: 0, events: 0, numbers, samples: None };
            }
        };
        let numbers = match &failure {
            Some(_) => vec![f64::NAN; width],
            None => {
                let mut all = self.wanted.numbers(&run);
                all.append(&mut numbers);
                all
            }
        };
        Done {
            status: if failure.is_some() { Status::Stopped } else { Status::Done },
            reason: failure.unwrap_or_default(),
            reached: run.last.t,
            steps: run.statistics.steps,
            events: run.events.len(),
            numbers,
            samples: self.has_trajectories().then_some(run.recording),
        }
    }

    /// A row for each of the runs from `first` on.
    pub fn table(&self, first: usize, done: &[Done]) -> Table {
        let [run, status, reason, reached, steps, events] = OWN_COLUMNS;
        let numbers: Vec<i64> = (first..first + done.len()).map(|run| run as i64).collect();
        let values: Vec<Vec<f64>> = (first..first + done.len()).map(|run| self.design.values(run)).collect();
        let mut columns = vec![(run.to_owned(), String::new(), Values::Whole(numbers))];
        for (place, &index) in self.swept.iter().enumerate() {
            let info = &self.parameters[index];
            let values = values.iter().map(|values| values[place]).collect();
            columns.push((info.name.to_owned(), info.unit.to_owned(), Values::Real(values)));
        }
        let text = |of: fn(&Done) -> String| Values::Text(done.iter().map(of).collect());
        columns.push((status.to_owned(), String::new(), text(|done| done.status.name().to_owned())));
        columns.push((reason.to_owned(), String::new(), text(|done| done.reason.clone())));
        let real = |of: &dyn Fn(&Done) -> f64| Values::Real(done.iter().map(of).collect());
        let whole = |of: fn(&Done) -> i64| Values::Whole(done.iter().map(of).collect());
        columns.push((reached.to_owned(), "s".to_owned(), real(&|done| done.reached)));
        columns.push((steps.to_owned(), String::new(), whole(|done| done.steps as i64)));
        columns.push((events.to_owned(), String::new(), whole(|done| done.events as i64)));
        for (place, (name, unit)) in self.columns().enumerate() {
            columns.push((name, unit, real(&|done| done.numbers[place])));
        }
        self.with_texts(columns)
    }

    /// A row for each sample of the runs from `first` on.
    pub fn trajectories(&self, first: usize, done: &[Done]) -> Table {
        let [run, ..] = OWN_COLUMNS;
        let sampled = || (first..).zip(done).filter_map(|(run, done)| Some((run, done.samples.as_ref()?)));
        let numbers = sampled().flat_map(|(run, samples)| std::iter::repeat_n(run as i64, samples.times.len()));
        let times = sampled().flat_map(|(_, samples)| samples.times.iter().copied());
        let mut columns = vec![
            (run.to_owned(), String::new(), Values::Whole(numbers.collect())),
            ("t".to_owned(), "s".to_owned(), Values::Real(times.collect())),
        ];
        for &output in &self.wanted.trajectories {
            let info = &self.model.outputs[output];
            let values = sampled().flat_map(|(_, samples)| samples.columns[output].values.iter().copied());
            columns.push((info.name.to_owned(), info.unit.to_owned(), Values::Real(values.collect())));
        }
        self.with_texts(columns)
    }

    fn with_texts(&self, columns: Vec<(String, String, Values)>) -> Table {
        let units = columns.iter().map(|(name, unit, _)| (name.clone(), serde_json::Value::from(unit.clone())));
        let units = serde_json::Value::Object(units.collect()).to_string();
        let texts = self.texts.iter().cloned().chain([("units".to_owned(), units)]).collect();
        let columns = columns.into_iter().map(|(name, _, values)| Column { name, values }).collect();
        Table { columns, texts }
    }
}
