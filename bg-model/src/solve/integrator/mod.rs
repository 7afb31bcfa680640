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
mod gauss;
mod hand_on;
mod hermite;
#[cfg(feature = "std")]
mod lanes;
mod linear;
mod nystrom;
mod partitioned;
mod radau;
pub(crate) mod rk4;
mod rosenbrock;
mod side_by_side;
mod steps;
mod taylor;
mod tolerances;
mod vectors;

use alloc::vec;
use core::ops::Range;

use nalgebra::{Complex, DVector};

pub use crate::model::capability::SeriesSize;
use crate::model::linear::{Sparsity, differences};
pub use any::AnyMethod;
pub use auto::{Auto, Change, Reason};
pub use choice::{Integrator, UnknownIntegrator};
#[cfg(feature = "std")]
pub(crate) use explicit::both;
pub use explicit::{
    BogackiShampine, Bs5, CalvoFrancoMontijanoRandez, Cfmr7, Dop853, DormandPrince, Explicit, Row, Tableau,
};
pub use gauss::Gauss6;
#[cfg(feature = "std")]
pub(crate) use hermite::between;
pub(crate) use hermite::hermite;
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

/// A smooth flow: a system with its switches frozen. Only the number of its states and the rate have to be written;
/// what else it knows of itself it may say. States, and all that there is one of for each of them, are slices: methods
/// are compiled once, in this crate, for any flow.
pub trait Flow {
    /// The number of states.
    fn states(&self) -> usize;

    /// Writes dx/dt at time `t` (s) and state `x` into `dx`.
    fn rate(&self, t: f64, x: &[f64], dx: &mut [f64]);

    /// Where the Jacobian df/dx can differ from zero.
    fn sparsity(&self) -> Sparsity {
        Sparsity::Full
    }

    /// Writes df/dx in the order of the sparsity into `entries` and df/dt, per s, into `slope`; by default by
    /// differences, for which room is allocated.
    fn jacobian(&self, t: f64, x: &[f64], entries: &mut [f64], slope: &mut [f64]) {
        differences(|t, x, dx| self.rate(t, x, dx), t, x, entries, slope, &mut vec![0.0; x.len()]);
    }

    /// Where [`Flow::damping`] can differ from zero.
    fn damping_sparsity(&self) -> Sparsity {
        self.sparsity()
    }

    /// Writes at least the entries of df/dx among states that are not of second order, in the order of
    /// [`Flow::damping_sparsity`], into `entries`; by default all, with room for what [`Flow::jacobian`] gives beside.
    fn damping(&self, t: f64, x: &[f64], entries: &mut [f64]) {
        self.jacobian(t, x, entries, &mut vec![0.0; x.len()]);
    }

    /// How many numbers the factors of I - c J are, along an elimination made for the sparsity; none where there is no
    /// such one.
    fn factors(&self) -> Option<usize> {
        None
    }

    /// Writes the factors of I - `c` J into `factors`; `entries` is J in the order of its sparsity. Gives whether it
    /// did: not where a pivot is too small, and by default.
    fn eliminate(&self, _c: f64, _entries: &[f64], _factors: &mut [f64]) -> bool {
        false
    }

    /// The same with a complex `c`.
    fn eliminate_complex(&self, _c: Complex<f64>, _entries: &[f64], _factors: &mut [Complex<f64>]) -> bool {
        false
    }

    /// Replaces `b` by the solution y of (I - c J) y = b, with the `factors` of I - c J.
    fn substitute(&self, _factors: &[f64], _b: &mut [f64]) {}

    /// The same with a complex c.
    fn substitute_complex(&self, _factors: &[Complex<f64>], _b: &mut [Complex<f64>]) {}

    /// The states of second order, side by side; an empty range where there are none.
    fn second(&self) -> Range<usize> {
        0..0
    }

    /// Replaces the rates `dx` of the states of second order at state `x` by their second derivatives with respect to
    /// time, per s^2.
    fn second_derivatives(&self, _x: &[f64], _dx: &mut [f64]) {}

    /// Writes the rates at time `t` (s) and state `x` into `dx`, in the places of the states of second order their
    /// second derivatives.
    #[inline(always)]
    fn forces(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        self.rate(t, x, dx);
        self.second_derivatives(x, dx);
    }

    /// The operations of a rate and of [`Flow::forces`], where they have been counted.
    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        None
    }

    /// What a Taylor series of the states takes; none where there is no series.
    fn series(&self) -> Option<SeriesSize> {
        None
    }

    /// Writes the Taylor series of the states from time `t` (s) on: order by order, of each all states. Those of order
    /// 0 are the state there; those of order k become the coefficients of the k-th power of the time passed in parts of
    /// `h` (s). `rows` is work space, of as many numbers for each order but the first as the series is wide.
    fn expand(&self, _t: f64, _h: f64, _rows: &mut [f64], _series: &mut [f64]) {}

    /// Whether joints hold motions, so that the end of each step is moved back onto them.
    fn is_held(&self) -> bool {
        false
    }

    /// Counts a factorisation of I - c J; `is_fallback` where a dense one stands in for a sparse one with a small
    /// pivot.
    fn count_factorisation(&self, _is_fallback: bool) {}
}

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
    fn attempt(&mut self, flow: &dyn Flow, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64;

    /// The norm of what `project` leaves of the last attempt's error estimate; none where the method does not say.
    /// Joints that hold a motion take away what a step errs in it.
    fn error_after(
        &mut self,
        _flow: &dyn Flow,
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
    fn prepare_dense(&mut self, _flow: &dyn Flow, _start: PointRef<'_>, _h: f64, _end: PointRef<'_>) {}

    /// Writes the state at `start` plus the part `theta` (0 to 1) of the step into `x`.
    fn dense(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]);
}

/// The first number that is not finite, with its place.
#[inline(never)]
pub(crate) fn first_not_finite(numbers: &[f64]) -> Option<(usize, f64)> {
    numbers.iter().copied().enumerate().find(|(_, value)| !value.is_finite())
}

/// Whether all numbers are finite.
#[inline(always)]
pub(crate) fn is_finite(numbers: &[f64]) -> bool {
    // What is finite times 0 is 0, all of whose bits are 0; anything else times 0 is no number. Vectors do this side by
    // side.
    numbers.iter().fold(0, |bits, value| bits | (value.abs() * 0.0).to_bits()) == 0
}
