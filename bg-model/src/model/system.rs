//! What an integrator asks of a system, and what a run asks of a model.
//!
//! In: nothing. Out: the traits that `bond_graph!` implements and that a hand-written system can implement as well.

use alloc::vec::Vec;

use nalgebra::SVector;

use crate::model::assembly::AssemblyError;
use crate::model::capability::{
    Absent, Impacts, Inlined, Joints, Linearised, Memories, Named, Reversed, SecondOrder, Series, Storages, Turning,
};
use crate::model::description::Description;
use crate::model::holding::Redundancy;
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

    /// Writes the guard of every switch into `guards`. Guard `k` below zero calls for branch `negative[k] = true`.
    fn guards(&self, _t: S, _x: &SVector<S, N>, _negative: &[S::Switch; G], _guards: &mut SVector<S, G>) {}

    /// The branches from which the search for those at the start of a run begins: each guard's sign under them decides,
    /// again until nothing changes. All positive by default; a switch whose guard depends on its own branch, as that of
    /// dry friction which slides or sticks, may have to begin on the other side.
    fn first_branches(&self) -> [bool; G] {
        [false; G]
    }

    /// Moves state `x` at time `t` (s) back onto the invariants that rounding and truncation leave: orthogonal
    /// orientations, closed joints, flows that rigid joints keep at zero. Called once after each accepted step, before
    /// the rate at the new state is evaluated, and for each sample inside a step.
    fn project(&self, _t: S, _negative: &[S::Switch; G], _x: &mut SVector<S, N>) {}

    /// The first instant after `t` (s) at which a step must end, because the rate follows another law from there on: a
    /// kink of an input. The rate is continuous there. Infinity, as by default, where there is none.
    fn next_break(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// Its names, for messages; by default it has none.
    #[inline]
    fn named(&self) -> Option<&impl Named<S, N, G>> {
        None::<&Absent>
    }

    /// Its rate and projection as they are inlined; by default neither is.
    #[inline]
    fn inlined(&self) -> Option<&impl Inlined<S, N, G>> {
        None::<&Absent>
    }

    /// The states that [`System::project`] sets: memories, samples of clocks, delays; none by default.
    #[inline]
    fn memories(&self) -> Option<&impl Memories<S>> {
        None::<&Absent>
    }

    /// The loops in closed form that may come to a pose where links turn either way; none by default.
    #[inline]
    fn turning(&self) -> Option<&impl Turning<S, N, G>> {
        None::<&Absent>
    }

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
