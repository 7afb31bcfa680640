//! What an integrator asks of a system, and what a run asks of a model.
//!
//! In: nothing. Out: the traits that `bond_graph!` implements and that a hand-written system can implement as well.

use alloc::vec::Vec;

use nalgebra::SVector;

use crate::model::assembly::AssemblyError;
use crate::model::capability::{Absent, Impacts, Joints, Linearised, Reversed, SecondOrder, Series, Storages};
use crate::model::delay::States;
use crate::model::description::Description;
use crate::model::holding::Redundancy;
use crate::model::origin::Origin;
use crate::model::scalar::Scalar;
use crate::model::slices::Dynamics;

/// A system of ordinary differential equations dx/dt = f(t, x) with `N` states and `G` switches.
///
/// A switch chooses between two branches of a law by the sign of its guard, a real function of time and state.
/// Inside a step the branches stay as the integrator hands them over, so that f is smooth there; the integrator
/// locates the guard's sign change and then changes the branch.
///
/// A hand-written system needs its rate only. What else it knows of itself it implements as a capability and hands
/// over as `Some(self)`; what it does not know is [`Absent`].
pub trait System<S: Scalar, const N: usize, const G: usize> {
    /// Writes dx/dt at time `t` (s) and state `x` into `dx`. `negative[k]` says that switch `k` is in the branch of its
    /// negative guard. Allocates nothing.
    fn rate(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>);

    /// As [`System::rate`], inlined where it is compiled for the vectors of the machine, which methods call, but for
    /// rates that are too long. By default there is no difference.
    #[inline(always)]
    fn inlined_rate(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>) {
        self.rate(t, x, negative, dx);
    }

    /// As [`System::rate`], inlined whatever its length: where numbers are vectors of a machine that not every build is
    /// for, its operations are calls elsewhere. By default as [`System::inlined_rate`].
    #[inline(always)]
    fn always_inlined_rate(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>) {
        self.inlined_rate(t, x, negative, dx);
    }

    /// As [`System::rate`], inlined whatever its length, in pairs of operations where that pays: for the one function
    /// in which a rate that is too long for steps has the machine's vectors. By default as
    /// [`System::always_inlined_rate`].
    #[inline(always)]
    fn paired_rate(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>) {
        self.always_inlined_rate(t, x, negative, dx);
    }

    /// Writes the guard of every switch into `guards`. Guard `k` below zero calls for branch `negative[k] = true`.
    fn guards(&self, _t: S, _x: &SVector<S, N>, _negative: &[S::Switch; G], _guards: &mut SVector<S, G>) {}

    /// The branches from which the search for those at the start of a run begins: each guard's sign under them decides,
    /// again until nothing changes. All positive by default; a switch whose guard depends on its own branch, as that of
    /// dry friction which slides or sticks, may have to begin on the other side.
    fn first_branches(&self) -> [bool; G] {
        [false; G]
    }

    /// The states that [`System::project`] sets to what they follow, by which it moves them far: what memories keep
    /// and samples hold.
    /// None by default.
    fn memories(&self) -> &'static [usize] {
        &[]
    }

    /// The switches of clocks: their guards are 1, and [`System::project`] computes samples in their negative branches,
    /// in which they are at the instants of [`System::instants`] only. None by default.
    fn clocks(&self) -> &'static [usize] {
        &[]
    }

    /// Writes of each clock the time from one instant to the next, s, above 0, and its first instant, s.
    fn instants(&self, _instants: &mut [S]) {}

    /// The delays of signals. Their clocks are among [`System::clocks`], with the time of the delay as the period: in
    /// their negative branches [`System::project`] reads the signals into the first of their states. None by default.
    fn delays(&self) -> &'static [States] {
        &[]
    }

    /// Moves state `x` at time `t` (s) back onto the invariants that rounding and truncation leave: orthogonal
    /// orientations, closed joints, flows that rigid joints keep at zero. Called once after each accepted step, before
    /// the rate at the new state is evaluated, and for each sample inside a step.
    fn project(&self, _t: S, _negative: &[S::Switch; G], _x: &mut SVector<S, N>) {}

    /// As [`System::project`], inlined as [`System::always_inlined_rate`] is. By default there is no difference.
    #[inline(always)]
    fn inlined_project(&self, t: S, negative: &[S::Switch; G], x: &mut SVector<S, N>) {
        self.project(t, negative, x);
    }

    /// The first instant after `t` (s) at which a step must end, because the rate follows another law from there on: a
    /// kink of an input. The rate is continuous there. Infinity, as by default, where there is none.
    fn next_break(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// Whether numbers of several runs side by side give in each place what a run gives by itself, and faster: not
    /// where something is found by iteration, where an input is more than a number, or where the rate is too long to be
    /// inlined.
    fn runs_in_lanes(&self) -> bool {
        true
    }

    /// The name of state `index`, for messages.
    fn state_name(&self, _index: usize) -> &'static str {
        "state"
    }

    /// The comparison of switch `index` and whose it is, such as ``if v < 0` of `valve``, for messages; by default
    /// none.
    fn switch_name(&self, _index: usize) -> Option<&'static str> {
        None
    }

    /// The first input or element, in the order of evaluation, whose value at time `t` (s) and state `x` is not finite;
    /// asked for where a run stops. By default none is known.
    fn not_finite(&self, _t: S, _x: &SVector<S, N>, _negative: &[S::Switch; G]) -> Option<Origin> {
        None
    }

    /// The joints that close loops in closed form for links which might come to a pose where they turn either way:
    /// nothing shows that the pivots of these loops keep away from zero. None by default.
    fn turning(&self) -> &'static [&'static str] {
        &[]
    }

    /// Writes the pivots of the loops of [`System::turning`], m or m^2, into `pivots`. Each keeps the
    /// sign that it has at the start.
    fn pivots(&self, _t: S, _x: &SVector<S, N>, _negative: &[S::Switch; G], _pivots: &mut [S]) {}

    /// The Jacobian; by default none is known, and implicit methods take differences of the rate.
    #[inline]
    fn linearised(&self) -> Option<&impl Linearised<S, N, G>> {
        None::<&Absent>
    }

    /// The states of second order with their second derivatives; by default none are known.
    #[inline]
    fn second_order(&self) -> Option<&impl SecondOrder<S, N, G>> {
        None::<&Absent>
    }

    /// The Taylor series of the states; none by default, nor of a model one of whose inputs changes with time.
    #[inline]
    fn series(&self) -> Option<&impl Series<S, N, G>> {
        None::<&Absent>
    }

    /// What joints hold; nothing by default.
    #[inline]
    fn joints(&self) -> Option<&impl Joints<S, N, G>> {
        None::<&Absent>
    }

    /// What its storages store, from which an error norm knows how large states are; by default nothing is known.
    #[inline]
    fn storages(&self) -> Option<&impl Storages<S, N, G>> {
        None::<&Absent>
    }

    /// What impacts are calculated from: where something hits a stop, the state jumps. By default nothing is hit.
    #[inline]
    fn impacts(&self) -> Option<&impl Impacts<S, N, G>> {
        None::<&Absent>
    }
}

/// The branches that the signs of the guards call for, and the guards under them; `guards` gives their values under
/// some branches.
///
/// Guards may depend on the branches: repeated from `first` on until they agree, at most once for each switch and once
/// more. A guard that is zero counts as positive in the first round; later it leaves its switch the branch that it has.
pub fn branches_by_sign<S: Scalar, const G: usize>(
    first: [bool; G],
    mut guards: impl FnMut(&[bool; G]) -> SVector<S, G>,
) -> ([bool; G], SVector<S, G>) {
    let (mut negative, mut value) = (first, SVector::<S, G>::repeat(S::from_f64(0.0)));
    decide_by_sign(&mut negative, value.as_mut_slice(), |negative, value| {
        value.copy_from_slice(guards(switches(negative)).as_slice());
    });
    (negative, value)
}

/// The same of any number of switches: `negative` are the first branches, and become those that the signs call for;
/// `guards` writes the values, which are left in `value`.
pub(crate) fn decide_by_sign<S: Scalar>(
    negative: &mut [bool],
    value: &mut [S],
    mut guards: impl FnMut(&[bool], &mut [S]),
) {
    for round in 0..=negative.len() {
        guards(negative, value);
        let mut agree = true;
        for (negative, value) in negative.iter_mut().zip(&*value) {
            let value = value.to_f64();
            let stays = round > 0 && *negative && value == 0.0;
            let next = value < 0.0 || stays;
            agree &= core::mem::replace(negative, next) == next;
        }
        if agree {
            break;
        }
    }
}

/// The numbers of all states, or outputs, as a system takes them.
///
/// # Panics
/// They are not `N`.
#[inline(always)]
#[must_use]
pub fn values<const N: usize>(of: &[f64]) -> &SVector<f64, N> {
    bytemuck::from_bytes(bytemuck::cast_slice(of))
}

/// The same to be written.
///
/// # Panics
/// They are not `N`.
#[inline(always)]
#[must_use]
pub fn values_mut<const N: usize>(of: &mut [f64]) -> &mut SVector<f64, N> {
    bytemuck::from_bytes_mut(bytemuck::cast_slice_mut(of))
}

/// The branches of all switches as a system takes them.
///
/// # Panics
/// They are not `G`.
#[inline(always)]
#[must_use]
pub fn switches<const G: usize>(negative: &[bool]) -> &[bool; G] {
    negative.try_into().expect("there is a branch for each switch")
}

/// The branches of the switches at time `t` (s) and state `x`.
pub fn branches<S: Scalar<Switch = bool>, const N: usize, const G: usize>(
    system: &impl System<S, N, G>,
    t: f64,
    x: &SVector<S, N>,
) -> [bool; G] {
    let guards = |negative: &[bool; G]| {
        let mut guards = SVector::repeat(S::from_f64(0.0));
        system.guards(S::from_f64(t), x, negative, &mut guards);
        guards
    };
    branches_by_sign(system.first_branches(), guards).0
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

    /// The rigid joints that hold what others hold already, in all poses: they share reactions of least norm. None
    /// where the start pose does not close.
    fn redundant(&self) -> Vec<Redundancy> {
        Vec::new()
    }

    /// What the start pose decides for all of a run: for each row that closes a loop whether it takes part, 1 or 0; for
    /// each loop that is closed by a root on which side of zero this is, 1 or -1.
    fn decided(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The kinetic energy that the impulses of the rigid joints take at the start, J, not negative: 0 without
    /// `start impulse;`, and where the start velocities fit. The energies of a run count from after the impulses.
    ///
    /// # Errors
    /// As [`Model::start`].
    fn impulse_energy(&self) -> Result<S, AssemblyError> {
        Ok(S::from_f64(0.0))
    }

    /// Writes [`Model::start`] into `x`: that of `system`, which is this model over slices, so that nobody makes it a
    /// second time.
    #[doc(hidden)]
    fn start_over(&self, _system: &dyn Dynamics<S>, x: &mut [S]) -> Result<(), AssemblyError> {
        x.copy_from_slice(self.start()?.as_slice());
        Ok(())
    }

    /// [`Model::impulse_energy`], likewise.
    #[doc(hidden)]
    fn impulse_energy_over(&self, _system: &dyn Dynamics<S>) -> Result<S, AssemblyError> {
        self.impulse_energy()
    }

    /// [`Model::redundant`], likewise.
    #[doc(hidden)]
    fn redundant_over(&self, _system: &dyn Dynamics<S>) -> Vec<Redundancy> {
        self.redundant()
    }

    /// Writes the observed outputs, in the order of `description().outputs`.
    fn outputs(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], y: &mut SVector<S, M>);

    /// The energy in all storage elements, J.
    fn stored_energy(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G]) -> S;

    /// Appends what pictures show to `values`: poses, forces of joints, effort and flow of bonds, at the places that
    /// `description().drawing` names. Nothing by default. Allocates; for pictures, not for steps.
    fn shown(&self, _t: f64, _x: &SVector<f64, N>, _negative: &[bool; G], _values: &mut Vec<f64>) {}

    /// The powers over the model's boundary, W: d(stored)/dt = supplied - dissipated.
    fn powers(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G]) -> Powers<S>;

    /// The reverse sweeps of rate, projection and outputs; by default none are known.
    #[inline]
    fn reversed(&self) -> Option<&impl Reversed<S, N, G, M>> {
        None::<&Absent>
    }
}
