//! Steps of one size and a known greatest cost, for controllers and other clocks.
//!
//! In: a system, its state, the step. Out: the state one step later. Method: the classical Runge-Kutta method of order
//! 4, as [`Rk4`](crate::integrator::Rk4), in any scalar. Branches change where a step ends, not where a guard passes
//! through zero, and no step is shortened: an event is late by up to a step, which costs accuracy, and the cost of a
//! step stays the same. So are the samples of clocks, unless the step divides their times.

use nalgebra::SVector;
use thiserror::Error;

use crate::model::capability::Memories;
use crate::model::clock::{self, Clock};
use crate::model::description::{Description, OperationCount};
use crate::model::sampled;
use crate::model::scalar::Scalar;
use crate::model::system::{System, branches_by_sign, switches};
use crate::solve::integrator::rk4;

/// A run that moves on by one step at a time.
///
/// Nothing is allocated, neither here nor in a generated model's rate. Between two steps the system may change: a new
/// value of an input counts from the next step on. In `f64` without switches the states are to the bit those of
/// [`integrate`](crate::simulation::integrate) with [`Rk4`](crate::integrator::Rk4) where both divide the time alike.
///
/// ```
/// use bg_model::bond_graph;
/// use bg_model::fixed_step::FixedStep;
/// use bg_model::input::Input;
/// use bg_model::system::Model;
///
/// bond_graph! {
///     graph Tank {
///         param capacity: m^3/Pa = 1e-6, above 0;
///         input inflow: m^3/s;
///         Sf pump = inflow; 0 base: hydraulic; C tank = capacity; R drain = 1e7;
///         pump -> base; base -> tank; base -> drain;
///         observe { pressure: Pa = base.effort; }
///     }
/// }
///
/// let mut tank = Tank::new(TankParameters::default(), TankInputs::default())?;
/// let mut run = FixedStep::<f64, { Tank::STATES }, { Tank::SWITCHES }>::new(&tank, &tank.start()?, 0.0, 0.01)?;
/// for sample in 0..100 {
///     tank.inputs_mut().inflow = Input::constant(if sample < 50 { 1e-4 } else { 0.0 });
///     run.advance(&tank)?;
/// }
/// assert_eq!(run.time(), 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FixedStep<S, const N: usize, const G: usize> {
    /// Where the first step starts, s.
    t0: f64,
    /// The size of a step, s.
    step: f64,
    /// The steps that are made.
    steps: u64,
    x: SVector<S, N>,
    negative: [bool; G],
}

/// Why a system cannot be moved on in such steps.
#[derive(Clone, Copy, PartialEq, Error)]
pub enum Unfit {
    /// The size of the steps or the start time cannot be.
    #[error("steps of {step} s from t = {t0} s cannot be: both must be finite, the step above 0")]
    Clock {
        /// The size of a step, s.
        step: f64,
        /// Where the first one starts, s.
        t0: f64,
    },
    /// Stops give back speed: what an impact takes is known only when it happens.
    #[error(
        "a stop with a restitution makes the state jump, at a cost that is not the same in every step; \
         make it a spring with a damper"
    )]
    Impacts,
    /// Something sticks, or rests against a stop: its motion is zero from the very instant on at which it ends.
    #[error(
        "dry friction that sticks, or a stop that holds, needs the instant at which the motion ends, and no step is \
         cut short here; give it a smooth law, such as f * tanh(v / v0)"
    )]
    Sticking,
    /// A signal is delayed at any time: its past takes room that is not known before the run.
    #[error(
        "a delay of a signal at any time keeps the past, which has no room of a fixed size here; \
         delay a sample in a block `every` in its place"
    )]
    Delays,
}

debug_is_display!(Unfit);

/// A state that is not finite. The run stays where it was before the step.
#[derive(Clone, Copy, PartialEq, Error)]
#[error("state {state} is not finite after the step from t = {t} s; make the step shorter, or look at the inputs")]
pub struct NotFinite {
    /// Its index.
    pub state: usize,
    /// Where the step started, s.
    pub t: f64,
}

debug_is_display!(NotFinite);

impl<S: Scalar<Switch = bool>, const N: usize, const G: usize> FixedStep<S, N, G> {
    /// A run of `system` from `start` at time `t0` (s), in steps of `step` (s). The branches are those that the signs
    /// of the guards call for.
    ///
    /// # Errors
    /// [`Unfit`] says why not.
    pub fn new(system: &impl System<S, N, G>, start: &SVector<S, N>, t0: f64, step: f64) -> Result<Self, Unfit> {
        if !(step > 0.0 && step.is_finite() && t0.is_finite()) {
            return Err(Unfit::Clock { step, t0 });
        }
        if system.impacts().is_some() {
            return Err(Unfit::Impacts);
        }
        if system.first_branches().contains(&true) {
            return Err(Unfit::Sticking);
        }
        if system.memories().is_some_and(|memories| !memories.delays().is_empty()) {
            return Err(Unfit::Delays);
        }
        let mut run = Self { t0, step, steps: 0, x: *start, negative: [false; G] };
        run.negative = run.branches(system, &run.x);
        Ok(run)
    }

    /// Moves on by one step; rates, guards and projections are those of `system` as it is now.
    ///
    /// # Errors
    /// [`NotFinite`]: the run stays where it is.
    pub fn advance(&mut self, system: &impl System<S, N, G>) -> Result<(), NotFinite> {
        let zero = SVector::repeat(S::from_f64(0.0));
        let (t, negative) = (S::from_f64(self.time()), self.negative);
        let mut rates = [zero; rk4::RATES];
        let rate = |t, x: &SVector<S, N>, dx: &mut SVector<S, N>| system.rate(t, x, &negative, dx);
        rate(t, &self.x, &mut rates[0]);
        let mut x = zero;
        rk4::step(rate, t, &self.x, S::from_f64(self.step), &mut rates, &mut x);
        if let Some(state) = x.iter().position(|value| !value.to_f64().is_finite()) {
            return Err(NotFinite { state, t: self.time() });
        }
        let before = self.time();
        self.steps += 1;
        system.project(S::from_f64(self.time()), &negative, &mut x);
        self.compute_samples(system, before, &mut x);
        self.negative = self.branches(system, &x);
        self.x = x;
        Ok(())
    }

    /// The time that it has reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.t0 + self.steps as f64 * self.step
    }

    /// The state there.
    #[must_use]
    pub const fn state(&self) -> &SVector<S, N> {
        &self.x
    }

    /// The branches from there on.
    #[must_use]
    pub const fn negative(&self) -> &[bool; G] {
        &self.negative
    }

    /// Computes the samples of clocks that have had an instant after `before` (s), at the end of the step.
    fn compute_samples(&self, system: &impl System<S, N, G>, before: f64, x: &mut SVector<S, N>) {
        let Some(memories) = system.memories() else { return };
        let clocks = memories.clocks();
        if clocks.is_empty() {
            return;
        }
        let zero = S::from_f64(0.0);
        let mut times = [[zero; 2]; G];
        memories.instants(times[..clocks.len()].as_flattened_mut());
        let (now, mut negative) = (self.time(), self.negative);
        let t = S::from_f64(now);
        let mut room = [SVector::<S, G>::repeat(zero); 2];
        system.guards(t, x, &negative, &mut room[0]);
        for (&switch, [period, first]) in clocks.iter().zip(times) {
            negative[switch] = Clock { switch, period, first }.next(before) <= now + clock::rounding(now);
        }
        let [before, value] = room.each_mut().map(|guards| guards.as_mut_slice());
        sampled::decide(
            &mut negative,
            |k| clocks.contains(&k),
            [before, value],
            |negative, value| {
                let mut guards = SVector::repeat(zero);
                system.guards(t, x, switches(negative), &mut guards);
                value.copy_from_slice(guards.as_slice());
            },
        );
        let mut projected = *x;
        system.project(t, &negative, &mut projected);
        memories.states().iter().for_each(|&held| x[held] = projected[held]);
    }

    /// The branches that the signs of the guards call for at state `x`, where those of the last step were so.
    fn branches(&self, system: &impl System<S, N, G>, x: &SVector<S, N>) -> [bool; G] {
        let t = S::from_f64(self.time());
        let guards = |negative: &[bool; G]| {
            let mut guards = SVector::repeat(S::from_f64(0.0));
            system.guards(t, x, negative, &mut guards);
            guards
        };
        if G == 0 { self.negative } else { branches_by_sign(self.negative, guards).0 }
    }
}

/// The operations of one step of a model at most: four rates, its guards once for each switch and once more, its
/// projection, and the sums of the method. None where an algebraic loop is solved by iteration, whose number of
/// rounds is not known.
///
/// It is a sum of what the model's description says of its functions. What a step takes besides are copies, and one
/// comparison with zero for each guard.
#[must_use]
pub fn operations(of: &Description) -> Option<OperationCount> {
    let cost = |name: &str| {
        let found = of.operations.iter().find(|(function, _)| *function == name);
        found.map_or(OperationCount::default(), |&(_, count)| count)
    };
    if of.operations.iter().any(|&(function, _)| function == "loops") {
        return None;
    }
    let rounds = if of.switches.is_empty() { 0 } else { of.switches.len() + 1 };
    let rates_and_guards = cost("rate").times(rk4::RATES).plus(cost("guards").times(rounds));
    Some(rates_and_guards.plus(cost("project")).plus(cost("settle")).plus(rk4::sums(of.states.len())))
}
