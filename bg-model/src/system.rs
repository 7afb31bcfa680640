//! What an integrator asks of a system, and what a run asks of a model.
//!
//! In: nothing. Out: the traits that `bond_graph!` implements and that a hand-written system can implement as well.

use std::ops::Range;

use nalgebra::SVector;

use crate::assembly::AssemblyError;
use crate::description::Description;
use crate::failure::Origin;
use crate::holding::Held;
use crate::linear::{Field, Sparsity, differences};
use crate::scalar::Scalar;

/// A system of ordinary differential equations dx/dt = f(t, x) with `N` states and `G` switches.
///
/// A switch chooses between two branches of a law by the sign of its guard, a real function of time and state.
/// Inside a step the branches stay as the integrator hands them over, so that f is smooth there; the integrator
/// locates the guard's sign change and then changes the branch.
pub trait System<S: Scalar, const N: usize, const G: usize> {
    /// Writes dx/dt at time `t` (s) and state `x` into `dx`. `negative[k]` says that switch `k` is in the branch of its
    /// negative guard. Allocates nothing.
    fn rate(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], dx: &mut SVector<S, N>);

    /// Writes the guard of every switch into `guards`. Guard `k` below zero calls for branch `negative[k] = true`.
    fn guards(&self, _t: S, _x: &SVector<S, N>, _negative: &[bool; G], _guards: &mut SVector<S, G>) {}

    /// Moves `x` back onto the invariants that rounding and truncation leave (orthogonal orientations). Called once
    /// after each accepted step, before the rate at the new state is evaluated.
    fn project(&self, _x: &mut SVector<S, N>) {}

    /// The name of state `index`, for messages.
    fn state_name(&self, _index: usize) -> &'static str {
        "state"
    }

    /// The comparison of switch `index` and whose it is, such as ``if v < 0` of `valve``, for messages; by default none.
    fn switch_name(&self, _index: usize) -> Option<&'static str> {
        None
    }

    /// The first input or element, in the order of evaluation, whose value at time `t` (s) and state `x` is not finite; asked for
    /// where a run stops. By default none is known.
    fn not_finite(&self, _t: S, _x: &SVector<S, N>, _negative: &[bool; G]) -> Option<Origin> {
        None
    }

    /// Where the Jacobian df/dx can differ from zero; everywhere by default.
    fn sparsity(&self) -> Sparsity {
        Sparsity::Full
    }

    /// Writes df/dx in the order of [`System::sparsity`] into `entries` and df/dt, per s, into `slope`; by differences by
    /// default, with `N` + 2 rates.
    fn jacobian(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], entries: &mut [S], slope: &mut SVector<S, N>) {
        differences(|t, x: &SVector<S, N>, dx: &mut SVector<S, N>| self.rate(t, x, negative, dx), t, x, entries, slope);
    }

    /// Writes the factors of I - `c` J into `factors`, of the length that the sparsity names; `entries` is J. Gives
    /// whether it did: not where a pivot cancels to below [`SMALLEST_PIVOT`](crate::linear::SMALLEST_PIVOT) of the largest
    /// value its place has had, and by default not at all.
    fn eliminate<F: Field<S>>(&self, _c: F, _entries: &[S], _factors: &mut [F]) -> bool {
        false
    }

    /// Replaces `b` by the solution y of (I - c J) y = b. Only called with factors of [`System::eliminate`].
    fn substitute<F: Field<S>>(&self, _factors: &[F], _b: &mut [F; N]) {
        unreachable!("only what was eliminated is substituted")
    }

    /// The states of second order, side by side: displacements and orientations, whose rates are smooth functions of states
    /// alone; none by default.
    fn second_order(&self) -> Range<usize> {
        0..0
    }

    /// Replaces the rates `dx` at state `x` by second derivatives with respect to time, per s^2, where
    /// [`System::second_order`] says so.
    fn second_derivatives(&self, _x: &SVector<S, N>, _dx: &mut SVector<S, N>) {}

    /// Writes the rates at time `t` (s) and state `x` into `dx`, in the places of the states of second order their second
    /// derivatives; what [`System::rate`] and then [`System::second_derivatives`] give, to rounding.
    fn forces(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], dx: &mut SVector<S, N>) {
        self.rate(t, x, negative, dx);
        self.second_derivatives(x, dx);
    }

    /// What joints hold; nothing by default.
    fn held(&self) -> Held {
        Held::NOTHING
    }

    /// Writes the relative flows of the motions that joints hold, and what the reactions of rigid joints change, into
    /// `entries`: in the order and of the length of [`Held`]. Only called where something is held.
    fn hold(&self, _t: S, _x: &SVector<S, N>, _negative: &[bool; G], _entries: &mut [S]) {}

    /// How many numbers each order of the Taylor series of the states needs as work space; none where there is no series:
    /// of a system written by hand, by default, and where an input changes with time.
    fn series_width(&self) -> Option<usize> {
        None
    }

    /// Writes the Taylor series of the states from time `t` (s) on: `series[0]` is the state there, `series[k]` becomes the
    /// coefficient of the k-th power of (time - `t`) / `h`, which has the state's unit. `rows` has at least
    /// [`System::series_width`] numbers for each `k` but the last. Only called where there is a series.
    fn series(&self, _t: S, _h: S, _negative: &[bool; G], _rows: &mut [S], _series: &mut [SVector<S, N>]) {
        unreachable!("only asked for where there is one")
    }
}

/// Power that crosses the boundary of a model, W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Powers<S> {
    /// Power that the sources (efforts, flows, modulated laws) give to the model, W; positive into the model.
    pub supplied: S,
    /// Power that the resistors take out of the model, W; not negative for passive laws.
    pub dissipated: S,
}

/// A model that `bond_graph!` generated: a [`System`] that knows its start, its outputs and its energy.
///
/// `M` is the number of scalar outputs.
pub trait Model<S: Scalar, const N: usize, const G: usize, const M: usize>: System<S, N, G> {
    /// Elements, bonds, strokes, states, outputs and equations, as text and tables.
    fn description(&self) -> &'static Description;

    /// The start state at t = 0: loops closed, guessed velocities such that they fit the joints.
    ///
    /// # Errors
    /// [`AssemblyError`] names the joint that stays open and its gap, that is torn apart and its speed, or that holds
    /// what others hold already.
    fn start(&self) -> Result<SVector<S, N>, AssemblyError>;

    /// The kinetic energy that the impulses of the rigid joints take at the start, J, not negative: 0 without
    /// `start impulse;`, and where the start velocities fit. The energies of a run count from after the impulses.
    ///
    /// # Errors
    /// As [`Model::start`].
    fn impulse_energy(&self) -> Result<S, AssemblyError> {
        Ok(S::from_f64(0.0))
    }

    /// Writes the observed outputs, in the order of `description().outputs`.
    fn outputs(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], y: &mut SVector<S, M>);

    /// The energy in all storage elements, J.
    fn stored_energy(&self, t: S, x: &SVector<S, N>, negative: &[bool; G]) -> S;

    /// The powers over the model's boundary, W: d(stored)/dt = supplied - dissipated.
    fn powers(&self, t: S, x: &SVector<S, N>, negative: &[bool; G]) -> Powers<S>;
}
