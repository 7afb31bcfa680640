//! Runs of a sweep side by side, in the vectors of the machine: for programs that ask for it by
//! [`Program::lanes`](crate::Program::lanes), since it is compiled for each of their models.
//!
//! In: the values of all parameters in each of some runs. Out: what each run gives, the same to the bit as by itself.

use std::marker::PhantomData;

use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::Parameters;
use bg_model::run::{LaneError, Request, RunError, Stopped, Trajectory, in_lanes};

use super::plan::Plan;
use crate::running::{Begin, Outcome};
use crate::scenes::{Scene, own_parameters};

/// Runs that are handed to a thread at once: on the last ones of them places are free.
pub const TOGETHER: usize = 48;

/// What runs have in common.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// The model.
    pub scene: &'a Scene,
    /// The models of its mechanism.
    pub scenes: &'a [Scene],
    /// The inputs.
    pub inputs: &'a [Input],
    /// What is asked of each run.
    pub request: &'a Request,
}

/// Makes a run with each of these values of all parameters.
pub type Many = fn(Asked<'_>, &[Vec<f64>]) -> Vec<Result<Outcome, String>>;

/// Whether the runs of a plan may gain by it. Which can be made side by side, only the model tells.
pub fn may_gain<P>(plan: &Plan<'_, P>) -> bool {
    plan.request.method.is_for_lanes() && plan.begin == Begin::Model
}

/// [`Many`] for a mechanism.
pub fn many<Me: Scenes>(asked: Asked<'_>, values: &[Vec<f64>]) -> Vec<Result<Outcome, String>> {
    Me::model(asked.scene.index, Together::<Me::Parameters> { asked, values, all: PhantomData })
}

struct Together<'a, P> {
    asked: Asked<'a>,
    values: &'a [Vec<f64>],
    all: PhantomData<P>,
}

impl<P: Parameters> MechanismVisitor for Together<'_, P> {
    type Output = Vec<Result<Outcome, String>>;

    fn visit<Sc: Mechanism>(self) -> Self::Output {
        let Self { asked: Asked { scene, scenes, inputs, request }, values, .. } = self;
        let own = |values: &Vec<f64>| -> Result<Sc::Parameters, String> {
            let mut all = P::default();
            values.iter().enumerate().for_each(|(index, value)| all.set_value(index, *value));
            own_parameters(scene, scenes, &all).map_err(|fault| fault.to_string())
        };
        let own: Vec<_> = values.iter().map(own).collect();
        let count = Sc::Parameters::table().len();
        let made = own.iter().flatten();
        let each: Vec<Vec<f64>> = made.clone().map(|own| (0..count).map(|index| own.value(index)).collect()).collect();
        // Any model that can be made knows the inputs of all.
        let model = made.clone().find_map(|own| Sc::make(own.clone(), inputs).ok());
        let mut runs = model.map(|model| in_lanes(&model, request, &each)).into_iter().flatten();
        let outcome = |own: Result<Sc::Parameters, String>| {
            let own = own?;
            match runs.next() {
                Some(run) => outcome(run),
                None => Err(Sc::make(own, inputs).err().map_or_else(String::new, |fault| fault.to_string())),
            }
        };
        own.into_iter().map(outcome).collect()
    }
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
