//! Derivatives of a run by parameters and start values, exact to the accuracy of the run, through events.
//!
//! In: a model, a [`Mechanism`] for one, what is asked of a run, directions. Out: the run, with the derivative of each
//! output at each sample along each direction. Method: the model calculates with numbers that have slopes
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

use std::rc::Rc;

use thiserror::Error;

use crate::model::assembly::AssemblyError;
use crate::model::description::Description;
use crate::model::dynamics::Machine;
use crate::model::mechanism::{Followed, Mechanism, SideBySide};
use crate::model::parameters::{ParameterError, Parameters};
use crate::model::scalar::Gradient;
#[cfg(target_arch = "x86_64")]
use crate::model::scalar::lanes::{Avx2, Avx512};
#[cfg(not(target_arch = "x86_64"))]
use crate::model::scalar::slopes::Eight;
#[cfg(target_arch = "x86_64")]
use crate::model::scalar::slopes::Everywhere;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::solve::integrator::{Integrator, Point, Scale};
use crate::solve::run::{Request, RunError, Trajectory, observed};
use crate::solve::simulation::{Observer, Switching};
pub use adjoint::{Gradients, Measured, Objective, gradient, gradient_within};
pub use differences::{DifferencesError, differences};
use follow::Follower;
use step::Stepper;

/// What is to be done where a model delays signals.
const DELAYS: &str = "what a run depends on then has a past of its own, which derivatives along a run do not have; \
                      take differences of runs, or delay samples in a block `every`";

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
        Self::of(Me::describe(), name)
    }

    /// The parameter called `name` of the model that this describes.
    ///
    /// # Errors
    /// There is none of that name.
    pub fn of(model: &Description, name: &str) -> Result<Self, ParameterError> {
        let index = model.parameters.iter().position(|parameter| parameter.name == name);
        index.map(Self::Parameter).ok_or_else(|| ParameterError::Unknown { name: name.to_owned() })
    }

    /// All parameters, in the order of their table.
    #[must_use]
    pub fn parameters<Me: Mechanism>() -> Vec<Self> {
        (0..Me::Parameters::table().len()).map(Self::Parameter).collect()
    }
}

/// The parameters of these names, of the model that this describes, as directions.
///
/// # Errors
/// There is none of a name.
pub fn directions(model: &Description, names: &[&str]) -> Result<Vec<Direction>, ParameterError> {
    names.iter().map(|name| Direction::of(model, name)).collect()
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
    /// The outputs at each event, in the order of time.
    pub events: Vec<AtEvent>,
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

/// The outputs on both sides of an event, with the derivatives that they have there wherever the event moves to: those
/// of a value that is largest where branches change.
#[derive(Clone, Debug, PartialEq)]
pub struct AtEvent {
    /// The instant, s.
    pub t: f64,
    /// The values of the outputs before and after it, each in its unit.
    pub values: [Vec<f64>; 2],
    /// The derivatives along each direction.
    pub slopes: Vec<AlongEvent>,
}

/// What an event is along one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongEvent {
    /// The derivative of the instant, s per the direction's unit.
    pub instant: f64,
    /// The derivatives of the outputs before and after it, in the output's unit per the direction's.
    pub outputs: [Vec<f64>; 2],
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
        "something hits a stop at the start of the run, where its derivatives do not exist; \
        start a little beside the stop"
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
    /// The model delays a signal.
    #[error("`{model}` delays a signal: {}", DELAYS)]
    Delays {
        /// The model.
        model: &'static str,
    },
    /// An objective asks for an instant at which there is no run.
    #[error("the objective asks for t = {t:?} s, and the run is from 0 to {t_end:?} s; ask for an instant in it")]
    OutsideOfRun {
        /// The instant, s.
        t: f64,
        /// The end of the run, s.
        t_end: f64,
    },
    /// An output has no derivative where one is asked for, as a root at zero.
    #[error("`{output}` has no derivative by `{by}` at t = {t:?} s, where it was measured; leave this value out")]
    NoDerivative {
        /// The output.
        output: &'static str,
        /// The parameter.
        by: &'static str,
        /// Time, s.
        t: f64,
    },
    /// There is no reverse sweep of the model.
    #[error(
        "there is no reverse sweep of `{model}`, whose rate has more than 400 operations; \
        ask for its derivatives along each direction"
    )]
    NoReverseSweep {
        /// The model.
        model: &'static str,
    },
    /// It was told to end ([`Request::interrupt`]) while it followed the run backwards.
    #[error("interrupted where the run was followed back to t = {t:?} s")]
    Interrupted {
        /// When, s.
        t: f64,
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
pub fn sensitivities(
    model: &dyn Followed,
    request: &Request,
    directions: &[Direction],
) -> Result<Sensitivities, SensitivityError> {
    let all: Vec<usize> = (0..model.description().outputs.len()).collect();
    sensitivities_of(model, &model.values(), request, directions, &all)
}

/// As [`sensitivities`], of the model with these values of its parameters, in the order of its description, with the
/// derivatives of these outputs alone, by their places there: of the others [`Sensitivities::of`] is empty.
///
/// # Errors
/// [`SensitivityError`].
///
/// # Panics
/// There is no value for a parameter, no such output.
pub fn sensitivities_of(
    model: &dyn Followed,
    values: &[f64],
    request: &Request,
    directions: &[Direction],
    outputs: &[usize],
) -> Result<Sensitivities, SensitivityError> {
    let plain = model.tuned(values)?;
    if !plain.delays().is_empty() {
        return Err(SensitivityError::Delays { model: model.description().name });
    }
    let following = Following { request, directions, outputs, values, plain };
    // What has no more directions than fit into a vector of AVX2 gains nothing by wider ones.
    #[cfg(target_arch = "x86_64")]
    if directions.len() > Avx2::LANES && Avx512::is_at_hand() {
        return following.followed::<Avx512>(model, |values| model.side_by_side(values));
    } else if Avx2::is_at_hand() {
        return following.followed::<Avx2>(model, |values| model.side_by_side(values));
    }
    #[cfg(target_arch = "x86_64")]
    return following.followed::<Everywhere>(model, |_| None);
    #[cfg(not(target_arch = "x86_64"))]
    following.followed::<Eight>(model, |values| model.side_by_side(values))
}

/// What is done with the model.
struct Following<'a> {
    request: &'a Request,
    directions: &'a [Direction],
    outputs: &'a [usize],
    values: &'a [f64],
    /// The model without slopes.
    plain: Rc<dyn Machine>,
}

impl Following<'_> {
    /// Makes the run, followed along as many directions at a time as the vectors `V` have places.
    fn followed<V: Slopes>(
        &self,
        model: &dyn Followed,
        side_by_side: impl Fn(&[Vec<Gradient>]) -> Option<Result<SideBySide<V>, ParameterError>>,
    ) -> Result<Sensitivities, SensitivityError> {
        let start = self.plain.start()?;
        let scale = Scale::new(&self.request.tolerances(), start.len());
        let follower = |directions: &[Direction]| -> Result<Follower, SensitivityError> {
            let values: Vec<_> = directions.chunks(WIDTH).map(|few| sloped(self.values, few)).collect();
            let SideBySide { each, all } =
                side_by_side(&values).unwrap_or_else(|| SideBySide::apart(model, &values))?;
            let sizes: Vec<f64> = directions.iter().map(|&of| self.size(of, &start)).collect();
            let steps = Stepper::<V>::new(all, start.len(), is_own(self.request), (scale.clone(), &sizes));
            let plain = model.lifted(&sloped(self.values, &[]))?;
            Ok(Follower::new(each, plain, Box::new(steps), (directions, self.outputs), 0.0)?)
        };
        let followers = self.directions.chunks(V::LANES).map(follower).collect::<Result<Vec<_>, _>>()?;
        self.run(Followers(followers))
    }

    /// Makes the run that these follow.
    fn run(&self, mut followers: Followers<Follower>) -> Result<Sensitivities, SensitivityError> {
        let outcome = observed(&*self.plain, self.request, &mut followers);
        let Followers(mut followers) = followers;
        followers.iter_mut().try_for_each(Follower::check)?;
        let trajectory = outcome?;
        let states = followers.iter().flat_map(Follower::states).collect();
        let mut events: Vec<AtEvent> = Vec::new();
        for more in followers.iter().map(Follower::events) {
            if events.is_empty() {
                events = more;
            } else {
                events.iter_mut().zip(more).for_each(|(at, other)| at.slopes.extend(other.slopes));
            }
        }
        let slopes = followers.into_iter().flat_map(Follower::slopes).collect();
        Ok(Sensitivities { trajectory, directions: self.directions.to_vec(), states, events, slopes })
    }

    /// The size of a direction: the change of it by which a slope may move a state as far from the truth as a step may.
    /// Its value, one where that is zero.
    fn size(&self, direction: Direction, start: &[f64]) -> f64 {
        let value = match direction {
            Direction::Parameter(index) => self.values[index],
            Direction::Start(state) => start[state],
        };
        if value == 0.0 { 1.0 } else { value.abs() }
    }
}

/// Whether the steps of a run are those of derivatives, which are then exact for them.
fn is_own(request: &Request) -> bool {
    request.method == Integrator::Dop853
}

/// The values of parameters with their slopes along these directions.
fn sloped(values: &[f64], directions: &[Direction]) -> Vec<Gradient> {
    let slope = |index: usize| {
        std::array::from_fn(|l| f64::from(u8::from(directions.get(l) == Some(&Direction::Parameter(index)))))
    };
    values.iter().enumerate().map(|(index, &value)| Gradient::new(value, slope(index))).collect()
}

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
