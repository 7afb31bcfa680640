//! Runs of a sweep side by side, in the vectors of the machine.
//!
//! In: the values of all parameters in each of some runs. Out: what each run gives, the same to the bit as by itself.

use bg_model::run::{LaneError, RunError, Stopped, Trajectory};

use super::plan::Plan;
use super::runs::{self, Asked};
use crate::ask::parameters::Values;
use crate::ask::scenes::own_values;
use crate::run::running::{Begin, Outcome};

/// Runs that are handed to a thread at once: on the last ones of them places are free.
pub const TOGETHER: usize = 48;

/// Whether the runs of a plan may gain by it. Which can be made side by side, only the model tells.
pub fn may_gain(plan: &Plan<'_>) -> bool {
    plan.request.method.is_for_lanes() && plan.begin == Begin::Model
}

/// Makes a run with each of these values of all parameters.
pub fn many(asked: Asked<'_>, values: &[Vec<f64>]) -> Vec<Result<Outcome, String>> {
    let Asked { models, scene, inputs, request } = asked;
    let own =
        |values: &Vec<f64>| own_values(scene, &models.scenes, &asked.all(values)).map_err(|fault| fault.to_string());
    let own: Vec<Result<Values, String>> = values.iter().map(own).collect();
    let each: Vec<Vec<f64>> = own.iter().flatten().map(|own| own.values().to_vec()).collect();
    let made = |own: &[f64]| models.maker().make(scene.index, own, inputs);
    // Any model that can be made knows the inputs of all.
    let model = each.iter().find_map(|own| made(own).ok());
    let runs = model.map(|model| model.in_lanes(request, &each));
    if let Some(None) = runs {
        return values.iter().map(|values| runs::run(asked, &Begin::Model, values)).collect();
    }
    let mut runs = runs.into_iter().flatten().flatten();
    let outcome = |own: Result<Values, String>| {
        let own = own?;
        match runs.next() {
            Some(run) => outcome(run),
            None => Err(made(own.values()).err().map_or_else(String::new, |fault| fault.to_string())),
        }
    };
    own.into_iter().map(outcome).collect()
}

/// As of a run by itself: one that stops before its end has begun.
fn outcome(run: Result<Trajectory, LaneError>) -> Result<Outcome, String> {
    match run {
        Ok(run) => Ok(Outcome { run, failure: None }),
        Err(LaneError::Run(RunError::Stopped(stopped))) => {
            let Stopped { cause, trajectory } = *stopped;
            Ok(Outcome { run: trajectory, failure: Some(cause.to_string()) })
        }
        Err(fault) => Err(fault.to_string()),
    }
}
