//! Integration methods: how one step is made.
//!
//! In: a flow dx/dt = f(t, x) with its switches frozen, the step's start and its size. Out: the state at the end of the
//! step with an error estimate, and on request the states in between. What steps are tried, accepted and recorded is
//! the driver's business ([`crate::simulation`]).
//!
//! All methods calculate in `f64`. A method's coefficients are rounded to `f64`, so a wider number type would gain
//! nothing. Every sum has a fixed order and nothing is fused: debug and release builds give the same bytes.

mod any;
mod auto;
mod choice;
mod collocation;
mod compensated;
mod dense;
mod explicit;
mod flow;
mod gauss;
mod hand_on;
mod hermite;
#[cfg(feature = "std")]
mod lanes;
mod linear;
#[cfg(test)]
mod no_number;
mod nystrom;
mod partitioned;
mod radau;
pub(crate) mod rk4;
mod rosenbrock;
pub(crate) mod side_by_side;
mod steps;
mod taylor;
mod tolerances;
mod vectors;

use nalgebra::DVector;

pub(crate) use crate::model::scalar::double::first_not_finite;
pub use any::AnyMethod;
pub use auto::{Auto, Change, Reason};
pub use choice::{Integrator, UnknownIntegrator};
pub use explicit::{
    BogackiShampine, Bs5, CalvoFrancoMontijanoRandez, Cfmr7, Dop853, DormandPrince, Explicit, Row, Tableau,
};
#[cfg(feature = "std")]
pub(crate) use explicit::{Transposed, both};
pub use flow::Flow;
pub use gauss::Gauss6;
pub(crate) use hermite::{between, hermite};
#[cfg(feature = "std")]
pub(crate) use lanes::{AnyInLanes, OfOne, Side};
pub use nystrom::Nystrom;
pub use partitioned::Ark5;
pub use radau::{Radau, Radau5, Radau9};
pub use rk4::Rk4;
pub use rosenbrock::{Rodas5p, Ros2};
#[cfg(feature = "std")]
pub(crate) use steps::{Begin, Rates};
pub use taylor::Taylor;
pub use tolerances::{Absolute, Scale, Tolerances};
pub(crate) use tolerances::{displaced, rounding, smaller};
pub(crate) use vectors::Arch;

/// A point of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Time, s.
    pub t: f64,
    /// State.
    pub x: DVector<f64>,
    /// dx/dt at `t` and `x`.
    pub rate: DVector<f64>,
}

impl Point {
    /// The point at time `t` (s) and state `x`, its rate not yet known: zero.
    #[must_use]
    pub fn at(t: f64, x: DVector<f64>) -> Self {
        let rate = DVector::zeros(x.len());
        Self { t, x, rate }
    }

    /// The same for a method.
    #[inline(always)]
    #[must_use]
    pub fn borrowed(&self) -> PointRef<'_> {
        PointRef { t: self.t, x: self.x.as_slice(), rate: self.rate.as_slice() }
    }

    /// Becomes another one of as many states; allocates nothing.
    pub(crate) fn become_that(&mut self, other: PointRef<'_>) {
        self.t = other.t;
        self.x.as_mut_slice().copy_from_slice(other.x);
        self.rate.as_mut_slice().copy_from_slice(other.rate);
    }
}

/// A point of a trajectory, its state and rate being those of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointRef<'a> {
    /// Time, s.
    pub t: f64,
    /// State.
    pub x: &'a [f64],
    /// dx/dt at `t` and `x`.
    pub rate: &'a [f64],
}

/// How a method's steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// Steps of a fixed size.
    Fixed {
        /// The step, s.
        step: f64,
    },
    /// Steps by the error estimate.
    Adaptive {
        /// The power of the step with which the error norm of a small step falls.
        order: f64,
    },
    /// Steps by the error estimates of this step and the one before, which keeps them from swinging where stability
    /// limits them.
    Stabilised {
        /// As above.
        order: f64,
    },
    /// Steps by the error estimates of this step and the one before, kept where they would grow by less than a fifth,
    /// so that one factorisation serves several of them.
    Predictive {
        /// As above.
        order: f64,
    },
}

impl StepControl {
    /// The power of the step with which the error norm of a small step falls; none where steps are fixed.
    #[must_use]
    pub fn order(&self) -> Option<f64> {
        match self {
            Self::Fixed { .. } => None,
            Self::Adaptive { order } | Self::Stabilised { order } | Self::Predictive { order } => Some(*order),
        }
    }
}

/// A one-step method with its work space. It holds the stages of the last attempt; a step allocates nothing.
pub trait Method {
    /// The method's name.
    fn name(&self) -> &'static str;

    /// How its steps are to be chosen.
    fn control(&self) -> StepControl;

    /// Whether its steps are measured by a scale: those of a fixed size have no tolerances, unless they solve
    /// equations.
    fn measures(&self) -> bool {
        self.control().order().is_some()
    }

    /// Whether it needs the Taylor series of the system ([`System::series`](crate::system::System::series)).
    fn needs_series(&self) -> bool {
        false
    }

    /// Makes room for so many states. To be called before the first attempt; changes nothing where there is room
    /// already. Of another number of states nothing is known any more.
    fn fit(&mut self, states: usize);

    /// Tries a step of size `h` (s) from `start`, whose rate is known, and writes the state reached into `end`.
    ///
    /// Gives the norm of the error estimate: up to 1 the step satisfies the tolerances. A fixed-step method gives 0.
    /// Not a number where a stage is not; infinity where an iteration does not converge, which calls for half the step.
    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64;

    /// The norm of the last attempt's error by one estimate alone, of a method that makes a smaller norm of two; else
    /// 0. How two fall together is right where the terms of their orders are there. At a start they may not be: from
    /// rest positions are even functions of the time, momenta odd ones, and of each every other term vanishes.
    fn error_alone(&self) -> f64 {
        0.0
    }

    /// The norm of what `project` leaves of the last attempt's error estimate; none where the method does not say.
    /// Joints that hold a motion take away what a step errs in it.
    fn error_after(
        &mut self,
        _flow: &Flow<'_>,
        _start: PointRef<'_>,
        _h: f64,
        _scale: &Scale,
        _end: &[f64],
        _project: &dyn Fn(&mut [f64]),
    ) -> Option<f64> {
        None
    }

    /// The last attempt was accepted: its end, perhaps projected, is the start of the next.
    fn advance(&mut self) {}

    /// What was known of the flow no longer holds: a run begins, or a switch has changed its branch.
    fn restart(&mut self) {}

    /// The method itself where it is one that was chosen at run time: for runs side by side.
    #[doc(hidden)]
    fn chosen(&mut self) -> Option<&mut AnyMethod> {
        None
    }

    /// When another method took over, of a method that chooses between several.
    fn changes(&self) -> &[Change] {
        &[]
    }

    /// The state with the largest error in the last attempt; the first one where there is no estimate.
    fn largest_error(&self, _start: PointRef<'_>, _scale: &Scale, _end: &[f64]) -> usize {
        0
    }

    /// The first state whose rate was not finite in a stage of the last attempt, and that rate.
    fn faulty_rate(&self) -> Option<(usize, f64)>;

    /// Makes the dense output of the last attempt, of size `h` (s) from `start`, ready for [`Method::dense`]. The rate
    /// at `end` is known. Further rates may be evaluated. Changes nothing in the steps that follow. There may be
    /// nothing to prepare.
    fn prepare_dense(&mut self, _flow: &Flow<'_>, _start: PointRef<'_>, _h: f64, _end: PointRef<'_>) {}

    /// Makes what is prepared for [`Method::dense`] as exact as `scale` asks, for [`Method::sample`]: inside of a step
    /// that output may err by more than at the ends. As above.
    fn prepare_samples(&mut self, _flow: &Flow<'_>, _start: PointRef<'_>, _h: f64, _end: PointRef<'_>, _scale: &Scale) {
    }

    /// The state that [`Method::dense`] writes, made more exact where [`Method::prepare_samples`] has done so.
    fn sample(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        self.dense(start, h, end, theta, x);
    }

    /// Writes the state at `start` plus the part `theta` (0 to 1) of the step into `x`.
    fn dense(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]);
}

/// Whether all numbers are finite.
#[inline(always)]
pub(crate) fn is_finite(numbers: &[f64]) -> bool {
    // What is finite times 0 is 0, all of whose bits are 0; anything else times 0 is no number. Vectors do this side by
    // side.
    numbers.iter().fold(0, |bits, value| bits | (value.abs() * 0.0).to_bits()) == 0
}
