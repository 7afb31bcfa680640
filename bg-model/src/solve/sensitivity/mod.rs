//! Derivatives of a run by parameters and start values, exact to the accuracy of the run, through events.
//!
//! In: a [`Mechanism`], what is asked of a run, directions. Out: the run, with the derivative of each output at each
//! sample along each direction. Method: the model calculates with numbers that have slopes
//! ([`Gradient`](crate::scalar::Gradient)), beside the run itself, whose steps, events and bytes are those without
//! derivatives. The start pose, the rates, projections, guards, impacts and outputs are all differentiated; at events
//! the slopes jump (`jump`).
//!
//! ```
//! use bg_model::bond_graph;
//! use bg_model::run::Request;
//! use bg_model::sensitivity::{Direction, sensitivities};
//! use bg_model::simulation::Samples;
//!
//! bond_graph! {
//!     pub graph Oscillator {
//!         param mass: kg = 2, above 0;
//!         param stiffness: N/m = 50, at least 0;
//!         1 slide: translation;
//!         I body = mass; C spring = stiffness start 0.1;
//!         slide -> body; slide -> spring;
//!         observe { x: m = spring.q }
//!     }
//! }
//!
//! let model = Oscillator::new(OscillatorParameters::default())?;
//! let request = Request { t_end: 1.0, samples: Samples::Every(0.5), rtol: 1e-10, ..Request::default() };
//! let found = sensitivities(&model, &request, &[Direction::parameter::<Oscillator>("stiffness")?])?;
//! // x = 0.1 cos(w t) with w = sqrt(k / m): dx/dk = -0.1 sin(w t) t / (2 m w).
//! let expected = -0.1 * 5.0_f64.sin() / (2.0 * 2.0 * 5.0);
//! assert!((found.of(0, 0)[2] - expected).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adjoint;
mod differences;
mod follow;
mod jump;
mod step;

use thiserror::Error;

use crate::model::assembly::AssemblyError;
use crate::model::dynamics::shared;
use crate::model::mechanism::{LiftedVisitor, Mechanism};
use crate::model::parameters::{ParameterError, Parameters};
use crate::model::scalar::Gradient;
use crate::model::scalar::gradient::GradientIn;
#[cfg(target_arch = "x86_64")]
use crate::model::scalar::lanes::{Avx2, Avx512};
#[cfg(not(target_arch = "x86_64"))]
use crate::model::scalar::slopes::Eight;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::system::Model;
use crate::solve::integrator::{Integrator, Point, Scale};
use crate::solve::run::{Request, RunError, Trajectory, observed};
use crate::solve::simulation::{Observer, Switching};
pub use adjoint::{Gradients, Measured, Objective, gradient, gradient_within};
pub use differences::{DifferencesError, differences};
use follow::Follower;
use step::{Stepper, Steps, joined as joined_slopes};

/// The part of a parameter's value by which it is thought to change. Of more the error estimates would divide the run's
/// own steps, and the slopes would no longer be the derivatives of these.
const PART: f64 = 1.0 / 1024.0;

/// What a run is differentiated by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The parameter of this index in the table, per its unit.
    Parameter(usize),
    /// The start of the state of this index, per its unit; what joints hold then follows by their projection.
    Start(usize),
}

impl Direction {
    /// The parameter called `name`.
    ///
    /// # Errors
    /// There is none of that name.
    pub fn parameter<Me: Mechanism>(name: &str) -> Result<Self, ParameterError> {
        let index = Me::Parameters::table().iter().position(|parameter| parameter.name == name);
        index.map(Self::Parameter).ok_or_else(|| ParameterError::Unknown { name: name.to_owned() })
    }

    /// All parameters, in the order of their table.
    #[must_use]
    pub fn parameters<Me: Mechanism>() -> Vec<Self> {
        (0..Me::Parameters::table().len()).map(Self::Parameter).collect()
    }
}

/// A run with its derivatives.
#[derive(Clone, Debug)]
pub struct Sensitivities {
    /// The run; its time is that of both.
    pub trajectory: Trajectory,
    /// The directions, as they were asked for.
    pub directions: Vec<Direction>,
    /// The derivatives of the states at the end, for each direction; in the state's unit per the direction's.
    pub states: Vec<Vec<f64>>,
    slopes: Vec<Vec<Vec<f64>>>,
}

impl Sensitivities {
    /// The derivative of an output along a direction at each sample, if it was asked for, in the output's unit per the
    /// direction's.
    ///
    /// # Panics
    /// There is no such direction or output.
    #[must_use]
    pub fn of(&self, direction: usize, output: usize) -> &[f64] {
        &self.slopes[direction][output]
    }
}

/// Derivatives that could not be had.
#[derive(Debug, Error)]
pub enum SensitivityError {
    /// The model cannot be made.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// It cannot be assembled.
    #[error(transparent)]
    Start(#[from] AssemblyError),
    /// The run cannot start, or stopped before its end.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Something lies on a stop at the start.
    #[error(
        "something hits a stop at the start of the run, where its derivatives do not exist; start a little beside the stop"
    )]
    ImpactAtStart,
    /// A guard touches zero and turns back: how the instant depends on parameters is not defined.
    #[error("{switch} touches zero at t = {t:?} s without passing it: the run has no derivatives from there on")]
    Grazes {
        /// The switch.
        switch: &'static str,
        /// Time, s.
        t: f64,
    },
    /// An objective asks for an instant at which there is no run.
    #[error("the objective asks for t = {t:?} s, and the run is from 0 to {t_end:?} s; ask for an instant in it")]
    OutsideOfRun {
        /// The instant, s.
        t: f64,
        /// The end of the run, s.
        t_end: f64,
    },
    /// There is no reverse sweep of the model.
    #[error(
        "there is no reverse sweep of `{model}`, whose rate has more than 400 operations; ask for its derivatives along each direction"
    )]
    NoReverseSweep {
        /// The model.
        model: &'static str,
    },
    /// The derivatives change so fast that too many steps would be needed.
    #[error(
        "the derivatives change too fast from t = {t:?} s on: the model is too stiff for them, or they are not finite"
    )]
    Inexact {
        /// Time, s.
        t: f64,
    },
}

/// Makes a run of `model` from its own start, as it is asked for, with the derivatives of its outputs along
/// `directions`.
///
/// # Errors
/// [`SensitivityError`].
pub fn sensitivities<Me: Mechanism>(
    model: &Me,
    request: &Request,
    directions: &[Direction],
) -> Result<Sensitivities, SensitivityError> {
    let all: Vec<usize> = (0..Me::describe().outputs.len()).collect();
    sensitivities_of(model, request, directions, &all)
}

/// As [`sensitivities`], with the derivatives of these outputs alone, by their places in the model's description: of
/// the others [`Sensitivities::of`] is empty.
///
/// # Errors
/// [`SensitivityError`].
///
/// # Panics
/// There is no such output.
pub fn sensitivities_of<Me: Mechanism>(
    model: &Me,
    request: &Request,
    directions: &[Direction],
    outputs: &[usize],
) -> Result<Sensitivities, SensitivityError> {
    let values = model.parameters().values();
    let following = Following { request, directions, outputs, values };
    // What has no more directions than fit into a vector of AVX2 gains nothing by wider ones.
    #[cfg(target_arch = "x86_64")]
    if directions.len() > Avx2::LANES && Avx512::is_at_hand() {
        return model.visit_lifted::<Gradient, GradientIn<Avx512>, _>(following);
    } else if Avx2::is_at_hand() {
        return model.visit_lifted::<Gradient, GradientIn<Avx2>, _>(following);
    }
    #[cfg(target_arch = "x86_64")]
    return model.visit_lifted::<Gradient, Gradient, _>(following);
    #[cfg(not(target_arch = "x86_64"))]
    model.visit_lifted::<Gradient, GradientIn<Eight>, _>(following)
}

/// What is done with the model.
struct Following<'a> {
    request: &'a Request,
    directions: &'a [Direction],
    outputs: &'a [usize],
    values: Vec<f64>,
}

impl Following<'_> {
    /// The size of a direction: the change of it by which a slope may move a state as far from the truth as a step may.
    fn size(&self, direction: Direction, start: &[f64]) -> f64 {
        let value = match direction {
            Direction::Parameter(index) => self.values[index],
            Direction::Start(state) => start[state],
        };
        if value == 0.0 { PART } else { PART * value.abs() }
    }
}

/// The values of parameters with their slopes along these directions.
fn sloped(values: &[f64], directions: &[Direction]) -> Vec<Gradient> {
    let slope = |index: usize| {
        std::array::from_fn(|l| f64::from(u8::from(directions.get(l) == Some(&Direction::Parameter(index)))))
    };
    values.iter().enumerate().map(|(index, &value)| Gradient::new(value, slope(index))).collect()
}

/// The steps are in the vectors `V`.
impl<V: Slopes> LiftedVisitor<Gradient, GradientIn<V>> for Following<'_> {
    type Output = Result<Sensitivities, SensitivityError>;

    fn visit<Mo, Li, Fa, const N: usize, const G: usize, const M: usize>(
        self,
        model: &Mo,
        _: impl Fn(&[f64]) -> Result<Mo, ParameterError>,
        lifted: impl Fn(&[Gradient]) -> Result<Li, ParameterError>,
        joined: impl Fn(&[&Li], fn(&[Gradient]) -> GradientIn<V>) -> Fa,
    ) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
        Li: Model<Gradient, N, G, M> + 'static,
        Fa: Model<GradientIn<V>, N, G, M> + 'static,
    {
        self.followed(V::LANES, model, &lifted, &|models, scale, sizes| {
            let is_estimated = self.request.method != Integrator::Dop853;
            Box::new(Stepper::<V, Fa, N>::new(Box::new(joined(models, joined_slopes)), is_estimated, (scale, sizes)))
        })
    }
}

impl Following<'_> {
    /// Makes the run, followed along `lanes` directions at a time by what `steps` makes. Compiled once for each model,
    /// whatever the vectors.
    fn followed<Mo, Li, const N: usize, const G: usize, const M: usize>(
        &self,
        lanes: usize,
        model: &Mo,
        lifted: &dyn Fn(&[Gradient]) -> Result<Li, ParameterError>,
        steps: &MakesSteps<'_, Li, N, G>,
    ) -> Result<Sensitivities, SensitivityError>
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
        Li: Model<Gradient, N, G, M>,
    {
        let start = model.start()?;
        let scale = Scale::new(&self.request.tolerances(), N);
        let system = |directions: &[Direction]| lifted(&sloped(&self.values, directions)).map(Box::new);
        let follower = |directions: &[Direction]| -> Result<Follower<Li, N, G, M>, SensitivityError> {
            let systems = directions.chunks(WIDTH).map(system).collect::<Result<Vec<_>, _>>()?;
            let sizes: Vec<f64> = directions.iter().map(|&of| self.size(of, start.as_slice())).collect();
            let models: Vec<&Li> = systems.iter().map(|system| &**system).collect();
            let steps = steps(&models, scale.clone(), &sizes);
            Ok(Follower::new(systems, system(&[])?, steps, (directions, self.outputs), 0.0)?)
        };
        let followers = self.directions.chunks(lanes).map(follower).collect::<Result<Vec<_>, _>>()?;
        let mut followers = Followers(followers);
        let outcome = observed(&*shared(model.clone()), self.request, &mut followers);
        let Followers(mut followers) = followers;
        followers.iter_mut().try_for_each(Follower::check)?;
        let trajectory = outcome?;
        let states = followers.iter().flat_map(Follower::states).collect();
        let slopes = followers.into_iter().flat_map(Follower::slopes).collect();
        Ok(Sensitivities { trajectory, directions: self.directions.to_vec(), states, slopes })
    }
}

/// Makes steps of the systems that have a few directions each, measured by the scale of the states and the size of each
/// direction.
type MakesSteps<'a, Li, const N: usize, const G: usize> = dyn Fn(&[&Li], Scale, &[f64]) -> Box<dyn Steps<N, G>> + 'a;

/// Several observers of one kind.
struct Followers<O>(Vec<O>);

impl<O: Observer> Observer for Followers<O> {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        self.0.iter_mut().for_each(|each| each.sample(t, x, negative));
    }

    fn measured(&mut self, scale: &Scale) {
        self.0.iter_mut().for_each(|each| each.measured(scale));
    }

    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        self.0.iter_mut().for_each(|each| each.passed(start, end, negative));
    }

    fn switched(&mut self, switching: &Switching) {
        self.0.iter_mut().for_each(|each| each.switched(switching));
    }

    fn is_done(&self) -> bool {
        self.0.iter().any(Observer::is_done)
    }
}
