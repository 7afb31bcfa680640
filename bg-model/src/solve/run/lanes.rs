//! Many runs of a mechanism, each with its own parameters, side by side in the vectors of the machine.
//!
//! In: a mechanism, the values of its parameters in each run. Out: the trajectory of each run, the same to the bit as
//! if it were made by itself.

use std::ops::ControlFlow;
use std::rc::Rc;

use thiserror::Error;

use super::stopwatch::Stopwatch;
use super::{Made, Reason, Request, RunError, Simulation, Trajectory, observer, recorded};
use crate::model::dynamics::{Abreast, Machine, RunByRun};
use crate::model::mechanism::Accompanied;
use crate::model::parameters::ParameterError;
#[cfg(target_arch = "x86_64")]
use crate::model::scalar::lanes::{Avx2, Avx512};
use crate::model::scalar::lanes::{Lanes, Vector, at};
#[cfg(target_arch = "x86_64")]
use crate::model::scalar::slopes::Slopes;
use crate::solve::integrator::{AnyInLanes, AnyMethod, Change, Method};
use crate::solve::simulation::{Span, lanes};

/// A run that was not made, or not to its end.
#[derive(Debug, Error)]
pub enum LaneError {
    /// There is no model of these parameters.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// It cannot start, or stopped.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Makes a run of `model` with each of these values of its parameters (in the order of their table), as it is asked
/// for: eight at a time on a machine with AVX-512, four with AVX2. Each gives the bits that it gives by itself, but for
/// the wall clock, of which each has an equal share.
///
/// They are made one after the other where that is not possible: on other machines, by another method than those of
/// [`Integrator::is_for_lanes`](crate::integrator::Integrator::is_for_lanes), with a sample at each step, at relative
/// tolerances up to 1e-10, of models with an input that changes, with an iteration in their rate, or of more than some
/// 400 operations; and those that close a loop on another side than the first, or whose joints hold another motion
/// twice.
pub fn in_lanes(model: &dyn Accompanied, request: &Request, values: &[Vec<f64>]) -> Vec<Result<Trajectory, LaneError>> {
    let many = Many { model, request, values };
    #[cfg(target_arch = "x86_64")]
    if request.method.is_for_lanes() {
        if Avx512::is_at_hand() {
            return many.together::<Avx512>(|values| model.in_lanes(values));
        }
        if Avx2::is_at_hand() {
            return many.together::<Avx2>(|values| model.in_lanes(values));
        }
    }
    many.all_alone()
}

/// What a run has of its own.
struct Own {
    model: Rc<dyn Machine>,
    start: Vec<f64>,
    method: AnyMethod,
}

/// What is to be made.
struct Many<'a> {
    model: &'a dyn Accompanied,
    request: &'a Request,
    values: &'a [Vec<f64>],
}

impl Many<'_> {
    /// The run with these values by itself.
    fn alone(&self, values: &[f64]) -> Result<Trajectory, LaneError> {
        Ok(Simulation::over(self.model.tuned(values)?, self.request.clone()).run()?)
    }

    fn all_alone(&self) -> Vec<Result<Trajectory, LaneError>> {
        self.values.iter().map(|values| self.alone(values)).collect()
    }

    /// The runs side by side, as far as that is possible, in vectors in which `lifted` makes the model.
    fn together<V: Vector>(
        &self,
        lifted: impl Fn(&[Lanes<V>]) -> Option<Result<Box<dyn Abreast<V>>, ParameterError>>,
    ) -> Vec<Result<Trajectory, LaneError>> {
        let settings = self.request.settings(0.0);
        let method: AnyMethod = self.request.method();
        let span = Span { t0: 0.0, t_end: self.request.t_end };
        let model = self.model.machine();
        let sizes = [model.states(), model.switches()];
        let Some(together) = AnyInLanes::of(&method, sizes[0]).filter(|_| lanes::fits(&*model, span, &settings)) else {
            return self.all_alone();
        };
        let stopwatch = Stopwatch::started();
        // What each run has of its own: its model, its start, its method.
        let made = |values: &Vec<f64>| -> Option<Own> {
            let model = self.model.tuned(values).ok()?;
            let start = model.start().ok()?;
            Some(Own { model, start, method: method.clone() })
        };
        let mut own: Vec<Option<Own>> = self.values.iter().map(made).collect();
        // What a start pose decides is one number for all lanes.
        let decided = own.iter().flatten().next().map(|own| own.model.decided());
        for own in &mut own {
            *own = own.take().filter(|own| Some(own.model.decided()) == decided);
        }
        let jobs = own.iter_mut().zip(self.values).enumerate().filter_map(|(number, (own, values))| {
            let Own { model, start, method } = own.as_mut()?;
            let model = &**model;
            let observer = observer(model, (0.0, self.request), Box::new(|_| ControlFlow::Continue(())), None);
            Some(lanes::Job { number, model, values, method, start, observer })
        });
        let mut finished: Vec<_> = self.values.iter().map(|_| None).collect();
        let apart = |values: &[Lanes<V>]| -> Result<Box<dyn Abreast<V>>, ParameterError> {
            let models = (0..V::LANES).map(|place| self.model.tuned(&at(place, values)));
            Ok(Box::new(RunByRun(models.collect::<Result<_, _>>()?)))
        };
        let pack = |values: &[Lanes<V>]| {
            lifted(values).unwrap_or_else(|| apart(values)).expect("models were made of these parameters")
        };
        lanes::integrate(jobs, together, pack, span, &settings, sizes, &mut |number, observers, finish| {
            finished[number] = finish.map(|finish| (recorded(observers), finish));
        });
        let method = method.name();
        let wall = stopwatch.elapsed() / u32::try_from(self.values.len().max(1)).unwrap_or(u32::MAX);
        let results = finished.into_iter().zip(self.values).map(|(finished, values)| {
            let Some((recorder, finish)) = finished else { return self.alone(values) };
            let first = Change { t: 0.0, method, reason: Reason::First };
            let made = Made { finish, cause: None, methods: vec![first], wall };
            let model = recorder.model();
            Ok(made.concluded(model, recorder, self.request.clone())?)
        });
        results.collect()
    }
}
